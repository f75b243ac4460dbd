//! The message `sensor_msgs/msg/Imu`.
//!
//! ```text
//! header         stamp: sec i32, nanosec u32; frame_id: length u32, bytes with a NUL
//! orientation    x y z w f64, covariance 9 f64
//! angular_velocity      x y z f64, covariance 9 f64
//! linear_acceleration   x y z f64, covariance 9 f64
//! ```

use crate::recording::ros_message::{RosMessage, Unreadable};
use calibrant_core::sensor::SensorKind;
use nalgebra::Vector3;

/// The fields of a message that are used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ImuMessage {
    /// `header.stamp`, ns.
    pub(super) stamp_ns: i64,
    angular_velocity: Option<Vector3<f64>>,
    linear_acceleration: Option<Vector3<f64>>,
}

impl ImuMessage {
    /// The reading of a sensor; `None` where its covariance marks it as absent.
    pub(super) fn sensor(&self, sensor_kind: SensorKind) -> Option<Vector3<f64>> {
        match sensor_kind {
            SensorKind::Accelerometer => self.linear_acceleration,
            SensorKind::Gyroscope => self.angular_velocity,
        }
    }
}

/// Reads a message, or states why it cannot be one.
pub(super) fn imu(reader: &mut RosMessage<'_>) -> Result<ImuMessage, Unreadable> {
    let stamp_ns = reader.stamp_ns()?;
    reader.text()?;
    reader.numbers::<4>()?;
    reader.numbers::<9>()?;
    let angular_velocity = reading(reader)?;
    let linear_acceleration = reading(reader)?;
    Ok(ImuMessage { stamp_ns, angular_velocity, linear_acceleration })
}

/// A vector and its covariance.
fn reading(reader: &mut RosMessage<'_>) -> Result<Option<Vector3<f64>>, Unreadable> {
    let reading = reader.numbers::<3>()?;
    let covariance = reader.numbers::<9>()?;
    Ok((covariance[0] != -1.0).then(|| Vector3::from(reading)))
}
