//! The logs of autopilots: PX4's ULog and ArduPilot's DataFlash.
//!
//! Both say in themselves which fields their messages have. [`layout`] finds the fields, [`stream`] collects the readings of each sensor, and
//! [`ulog`] and [`dataflash`] split the bytes into messages.

pub(crate) mod dataflash;
mod layout;
pub(crate) mod log;
pub(crate) mod stream;
pub(crate) mod ulog;
