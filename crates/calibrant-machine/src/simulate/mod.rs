//! Simulates a sensor on a machine: draws what differs from the experiment's file, draws or reads a motion, and records both sensor and machine.
//!
//! The truth is a [`Motion`](crate::reference::Motion) and [`MachineParameters`](crate::estimate::MachineParameters), the same types that a calibration finds.

mod drawn_machine;
mod drawn_motion;
mod motion_of_log;
mod sensor_recording;

pub use crate::estimate::MotionOfLog;
pub use drawn_machine::{DrawnMachine, draw_machine};
pub use drawn_motion::{MotionToDraw, draw_body_motion, draw_joint_motion};
pub use motion_of_log::motion_of_log;
pub use sensor_recording::{LogErrors, SensorErrors, SensorSampling, record_log, record_sensors};
