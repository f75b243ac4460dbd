//! The experiment file (TOML): the sensor's datasheet, the motion or the holds, the columns of recordings,
//! and the options of each command.
//!
//! [`ExperimentFile`] is its form: one tree of types, a file here for each section, which serde reads and writes.
//! The types of numbers carry their ranges and units. Of it the [`Experiment`] is made, whose plans are in the
//! units of the library.
//!
//! Unknown keys, wrong types and values out of range are errors that point at line and column. The error for
//! an unknown key names the nearest known one. [`presets`](super::preset()) are commented examples of every
//! key.

mod accept;
mod calibrate;
mod campaign;
mod campaign_block;
mod campaign_cycles;
mod campaign_problem;
mod columns;
pub(crate) mod datasheets;
mod design;
mod direction;
mod document;
mod fault;
mod file;
mod gravity;
mod gyroscope;
mod holds;
mod known_keys;
mod limits;
mod machine;
mod machine_design;
mod machine_design_plan;
#[cfg(test)]
mod machine_design_tests;
mod machine_limits;
mod machine_mount;
mod machine_sensors;
mod machine_simulation;
mod machine_source;
mod machine_world;
mod motion;
mod motion_gravity;
mod noise_density;
mod number;
mod plan;
mod pose_problem;
mod poses;
pub(crate) mod presets;
mod problem;
pub mod ranges;
mod read;
mod refused_key;
mod remedies;
mod sensor;
mod spreads;
mod study;
mod temperature;
mod toml_value;
mod widened_limits;

pub use calibrate::{CalibrateOptions, Prior};
pub use design::{CriterionLetter, DesignOptions, ScaleBy};
pub use file::ExperimentFile;
pub use gyroscope::ImuPlan;
pub use holds::HoldsPlan;
pub use known_keys::sections as experiment_keys;
pub use machine::MachinePlan;
pub use machine_design::Dwells;
pub use machine_design_plan::MachineDesignPlan;
pub use machine_limits::MachineLimits;
pub use machine_simulation::MachineSimulation;
pub use machine_source::UrdfSource;
pub use machine_world::{LinksKnown, MachineWorld};
pub use motion::MotionPlan;
pub use plan::Plan;
pub use read::{Experiment, read_acceptance, read_columns};
pub use study::{NoisyVariant, StudyOptions, UnknownVariant};

/// The sections of an [`ExperimentFile`], and the types of their values.
pub mod sections {
    pub use super::accept::{AcceptEntry, AcceptSection};
    pub use super::campaign::{
        CampaignDirections, CampaignLetter, CampaignSection, ChannelSection, GoalsSection,
    };
    pub use super::campaign_block::{CampaignBlock, CampaignPoses};
    pub use super::campaign_cycles::Cycles;
    pub use super::columns::ColumnsSection;
    pub use super::direction::{Direction, WrittenDirection};
    pub use super::gyroscope::{GyroscopeSection, GyroscopeUnit, KnownPrior, KnownSection, TurnSection};
    pub use super::limits::LimitsSection;
    pub use super::machine::{ClockSection, GeometrySection, LogSection, NoiseFrom};
    pub use super::machine_design::MachineDesignSection;
    pub use super::machine_limits::{ByJoint, JointRanges, MachineLimitsSection};
    pub use super::machine_mount::{MountSection, UnknownRotation};
    pub use super::machine_world::{BoxSection, CapsuleSection, Capsules, SensorBodySection, WorldSection};
    pub use super::motion::{InputNoiseSection, Intervals, MotionSection, MotionTrust};
    pub use super::number::{Bounds, Count, Either, PerAxis, Range, Within};
    pub use super::poses::{AllowedDirections, CubeDirections, DirectionsAre};
    pub use super::ranges;
    pub use super::sensor::{AccelerometerUnit, SensorSection, SensorsKind};
    pub use super::study::{NoisySection, SurfaceSection, UnknownSection};
    pub use super::temperature::TemperatureSection;
}
