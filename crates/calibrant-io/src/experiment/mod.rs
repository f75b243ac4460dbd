//! The experiment file (TOML): the sensor's datasheet, the motion or the holds, the columns of recordings,
//! and the options of each command. One file here reads each section.
//!
//! Unknown keys, wrong types and values out of range are errors that point at line and column. The error for
//! an unknown key names the nearest known one. [`presets`](super::preset()) are commented examples of every
//! key.

mod accept;
mod calibrate;
mod columns;
mod design;
mod direction;
mod gravity;
mod gyroscope;
mod holds;
mod known_keys;
mod limits;
mod machine;
mod machine_mount;
mod machine_sensors;
mod machine_simulation;
mod machine_source;
mod motion;
mod motion_gravity;
mod number_range;
mod plan;
mod pose_problem;
mod poses;
mod problem;
mod read;
mod sensor;
mod spreads;
mod study;
mod temperature;
mod toml_document;

pub use calibrate::{CalibrateOptions, Prior};
pub use design::{CriterionLetter, DesignOptions, ScaleBy};
pub use gyroscope::ImuPlan;
pub use holds::HoldsPlan;
pub use known_keys::nearest;
pub(crate) use known_keys::shorten;
pub use machine::{LogNoise, MachinePlan};
pub use machine_simulation::MachineSimulation;
pub use machine_source::{MachineSource, UrdfSource};
pub use motion::MotionPlan;
pub use plan::Plan;
pub use poses::PoseOptions;
pub use read::{Experiment, read_acceptance, read_columns};
pub use study::{NoisyVariant, StudyOptions, UnknownVariant};
