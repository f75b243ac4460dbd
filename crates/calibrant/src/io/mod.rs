//! Files: the experiment, recordings and motions that come in, results that go out. The only code that touches files.

mod delimited;
mod experiment;
mod motion;
mod output;
mod preset;
mod recording;
mod text;

pub use experiment::{
    CalibrateOptions, CriterionLetter, DesignOptions, Experiment, HoldsPlan, MotionPlan, Plan, Prior,
    ScaleBy, StudyOptions,
};
pub use motion::{parse_motion, read_motion, write_motion};
pub use output::write_atomically;
pub use preset::{PRESETS, preset};
pub use recording::{
    Finding, FindingKind, ReadOptions, RecordingFile, parse_recording, read_recording, write_recording,
};
