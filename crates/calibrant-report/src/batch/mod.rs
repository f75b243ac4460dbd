//! The sheet of a batch: many sensors of one type, calibrated one by one.

mod capability;
mod causes;
mod control;
mod page;
mod sensors;
mod summary;
mod tables;

pub(crate) use causes::{Cause, Effect};
pub(crate) use control::Control;
pub use page::batch_sheet;
pub use sensors::{Batch, BatchParameter, BatchSensor};
