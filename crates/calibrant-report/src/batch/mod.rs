//! The sheet of a batch: many sensors of one type, calibrated one by one.

mod page;
mod sensors;
mod summary;
mod tables;

pub use page::batch_sheet;
pub use sensors::{Batch, BatchParameter, BatchSensor};
