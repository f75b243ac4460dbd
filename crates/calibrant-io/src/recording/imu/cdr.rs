//! Reads a message `sensor_msgs/msg/Imu` in CDR, the serialisation of ROS 2.
//!
//! ```text
//! encapsulation  4 bytes: 0, 0 big-endian or 1 little-endian, two of options
//! header         stamp: sec i32, nanosec u32; frame_id: length u32, bytes with a NUL
//! orientation    x y z w f64, covariance 9 f64
//! angular_velocity      x y z f64, covariance 9 f64
//! linear_acceleration   x y z f64, covariance 9 f64
//! ```
//! Every number is aligned to its size, counted from the end of the encapsulation.

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
pub(super) fn imu(bytes: &[u8]) -> Result<ImuMessage, &'static str> {
    let little = match bytes.get(..2) {
        Some([0, 0]) => false,
        Some([0, 1]) => true,
        Some(_) => return Err("its encapsulation is not plain CDR"),
        None => return Err(SHORT),
    };
    let mut reader = Reader { bytes: bytes.get(4..).ok_or(SHORT)?, at: 0, little };
    let sec = reader.u32()? as i32;
    let nanosec = reader.u32()?;
    let length = reader.u32()? as usize;
    reader.skip(length)?;
    reader.numbers::<4>()?;
    reader.numbers::<9>()?;
    let angular_velocity = reader.reading()?;
    let linear_acceleration = reader.reading()?;
    let stamp_ns = i64::from(sec) * 1_000_000_000 + i64::from(nanosec);
    Ok(ImuMessage { stamp_ns, angular_velocity, linear_acceleration })
}

/// The reason for a message that ends too early.
const SHORT: &str = "it is too short";

struct Reader<'b> {
    bytes: &'b [u8],
    at: usize,
    little: bool,
}

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], &'static str> {
        let start = self.at.next_multiple_of(N);
        let bytes = self.bytes.get(start..).and_then(|rest| rest.first_chunk::<N>()).ok_or(SHORT)?;
        self.at = start + N;
        Ok(*bytes)
    }

    fn u32(&mut self) -> Result<u32, &'static str> {
        let bytes = self.take()?;
        Ok(if self.little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) })
    }

    fn f64(&mut self) -> Result<f64, &'static str> {
        let bytes = self.take()?;
        Ok(if self.little { f64::from_le_bytes(bytes) } else { f64::from_be_bytes(bytes) })
    }

    fn skip(&mut self, length: usize) -> Result<(), &'static str> {
        self.at = self.at.checked_add(length).filter(|&at| at <= self.bytes.len()).ok_or(SHORT)?;
        Ok(())
    }

    fn numbers<const N: usize>(&mut self) -> Result<[f64; N], &'static str> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.f64()?;
        }
        Ok(numbers)
    }

    /// A vector and its covariance.
    fn reading(&mut self) -> Result<Option<Vector3<f64>>, &'static str> {
        let reading = self.numbers::<3>()?;
        let covariance = self.numbers::<9>()?;
        Ok((covariance[0] != -1.0).then(|| Vector3::from(reading)))
    }
}
