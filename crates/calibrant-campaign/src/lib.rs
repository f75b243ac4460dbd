//! Campaigns over temperature: a sensor is soaked at several temperatures, in a chamber or a freezer, and calibrated at each.
//!
//! [`Channel`] is what follows temperature: a bias or a gain, as a polynomial with its hysteresis and the error of a thermometer that lags.
//! [`Campaign`] is the chamber and the time. [`design`] finds the soaks that determine the polynomials best, with a bound that no campaign can beat.

mod campaign;
mod channel;
mod criterion;
mod design;
pub mod fit;
mod golden_section;
mod planned;
mod rehearsal;
mod timetable;
mod usual;

pub use campaign::{Campaign, Direction, Soak};
pub use channel::Channel;
pub use criterion::CampaignCriterion;
pub use design::{
    CampaignDesign, MOST_TIMES, RelaxedCampaign, RelaxedSoak, design, design_over_cycles, relaxed,
    time_needed_min,
};
pub use planned::{CampaignSweep, PlannedCampaign, SweptCampaign};
pub use rehearsal::{CampaignRehearsal, RehearsedCampaign, RehearsedChannel, rehearse};
pub use timetable::{TimedSoak, timetable};
pub use usual::{UsualCampaign, usual};
