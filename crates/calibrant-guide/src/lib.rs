//! The live guide: from the stream of a sensor at the bench to a calibration that is good enough.
//!
//! ```text
//! serial, UDP, TCP, stdin → lines → rows → recording.csv
//!                                     ↓
//!                                   gate → a hold → calibrate → next pose → page, terminal
//! ```
//!
//! Every row is in the recording before it is used, and what calibrates while it grows is what calibrates it afterwards: a [`Session`](calibrant::session::Session).
//! The gate knows the sensor's own noise and nothing that the calibration is to find; any pose counts, the next one is advice; what ends a session are standard deviations.

mod advice;
mod arrival;
mod arrival_clock;
mod decide;
mod decision;
mod demo;
mod estimate;
mod fields;
mod force;
mod gate;
mod goals;
mod guide;
mod input;
mod intake;
mod kept;
mod layout;
mod lines;
mod options;
mod picture;
mod replay;
mod run;
mod server;
mod session_log;
mod shown;
mod stream;
mod terminal;
mod unfit;
mod window;

pub use guide::guide;
pub use input::Input;
pub use options::GuideOptions;
