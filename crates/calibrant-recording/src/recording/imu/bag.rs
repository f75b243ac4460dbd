//! Reads the IMU of a bag of ROS: messages `sensor_msgs/msg/Imu`.
//!
//! By the message's definition, angular velocity is in rad/s, and linear acceleration is in m/s² with
//! gravity. [`readings`](super::reading_unit) checks that. Times are `header.stamp`, when the sample was
//! taken, and not when the recorder received it. A covariance that begins with −1 marks a sensor as absent.

use super::column::{ColumnMeaning, ImuColumn};
use super::column_values::{SLOTS, Samples, TIME, slots_of};
use super::file_layout::Draft;
use super::format::FileFormat;
use super::imu_message::{self, ImuMessage};
use super::options::ImuReadOptions;
use super::unit::{ColumnUnit, ImuUnit};
use crate::recording::bag::MessageType;
use crate::recording::bag_file;
use crate::recording::mcap_order::by_log_time;
use crate::recording::time_unit::TimeUnit;
use crate::text::decoding::Checked;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::sensor::{Axis, SensorKind};

/// The messages that are read.
const TYPES: &[MessageType<ImuMessage>] =
    &[MessageType { name: "sensor_msgs/msg/Imu", read: imu_message::imu }];

/// Columns and values of the bag's IMU, and what there is to say of the bag: that its messages were sorted, that it has no end, or something behind it.
pub(super) fn read(
    format: FileFormat,
    bytes: &[u8],
    options: &ImuReadOptions,
) -> Checked<(Draft, Samples, Vec<Diagnostic>)> {
    let mut bag = bag_file::read(bytes, TYPES)?;
    let (cut, unread) = (bag.cut("an IMU")?, bag.unread.take());
    let messages = bag.topics().one(options.topic.as_deref(), "IMU", "columns")?;
    let (messages, sorted) = by_log_time(messages, |message| message.stamp_ns);
    let origin = messages.first().map_or(0, |message| message.stamp_ns);
    let mut columns: [Vec<f64>; SLOTS] = Default::default();
    columns[TIME] = messages.iter().map(|message| (message.stamp_ns - origin) as f64).collect();
    let mut described = vec![ImuColumn::new(
        "header.stamp",
        ColumnMeaning::Time,
        Some(ColumnUnit::Time(TimeUnit::Nanosecond)),
    )];
    for (sensor_kind, name, unit) in [
        (SensorKind::Gyroscope, "angular_velocity", ImuUnit::RadianPerSecond),
        (SensorKind::Accelerometer, "linear_acceleration", ImuUnit::MetrePerSecondSquared),
    ] {
        let absent = messages.iter().all(|message| message.sensor(sensor_kind).is_none());
        for axis in Axis::ALL {
            let meaning = ColumnMeaning::Reading(sensor_kind, axis);
            let mut column =
                ImuColumn::new(&format!("{name}.{axis}"), meaning, Some(ColumnUnit::Reading(unit)));
            if absent {
                column.unused = Some("its covariance begins with −1: the IMU does not have it".into());
            } else {
                let value =
                    |message: &ImuMessage| message.sensor(sensor_kind).map_or(f64::NAN, |y| y[axis.index()]);
                columns[slots_of(sensor_kind)[axis.index()]] = messages.iter().map(value).collect();
            }
            described.push(column);
        }
    }
    described.push(ImuColumn::new("orientation", ColumnMeaning::Orientation, None));
    let last_s = messages.last().map_or(0.0, |message| (message.stamp_ns - origin) as f64 / 1e9);
    let cut = cut.map(|cut| cut.finding(messages.len(), last_s));
    let findings = sorted.into_iter().chain(cut).chain(unread).collect();
    Ok((Draft::new(format, described), Samples::from_columns(columns, origin)?, findings))
}
