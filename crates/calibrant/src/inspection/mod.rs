//! What `inspect` shows of a recording, of a log of a machine's motion, and of a machine: each as one sheet.

mod columns;
mod holds;
mod log;
mod machine;
mod noticed;
mod recording;
mod sampling;

pub use log::log_sheet;
pub use machine::chain_sheet;
pub use recording::recording_sheet;
