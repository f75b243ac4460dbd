//! Reads the IMU of an autopilot's log: which of its readings are taken, and the recording of them.
//!
//! | log | topics, the best ones first | what they hold |
//! |---|---|---|
//! | PX4 | `sensor_accel_fifo`, `sensor_gyro_fifo` | every sample of the sensor |
//! | | `sensor_accel`, `sensor_gyro` | raw readings, each sensor with its own clock |
//! | | `sensor_combined` | corrected on board |
//! | ArduPilot | `ACC`, `GYR` | every sample, corrected on board |
//! | | `IMU` | corrected and filtered on board |
//!
//! All are in m/s² and rad/s. Topics that hardly hold a sample in a tenth of a second are passed over where others do: PX4 logs the raw ones at 1 Hz.

use super::autopilot_source::{ARDUPILOT, Chosen, PX4, PX4_CORRECTS, chosen, distinct};
use super::column::{ColumnMeaning, ImuColumn};
use super::column_values::{SLOTS, Samples, TEMPERATURE, TIME, slots_of};
use super::file_layout::Draft;
use super::format::FileFormat;
use super::options::ImuReadOptions;
use super::unit::{ColumnUnit, ImuUnit};
use crate::recording::autopilot::log::AutopilotLog;
use crate::recording::autopilot::stream::Stream;
use crate::recording::autopilot::{dataflash, ulog};
use crate::recording::time_unit::TimeUnit;
use crate::text::decoding::Checked;
use calibrant_core::diagnostic::reader::{CorrectedOnBoard, LogPassedOver, MessagesChosen};
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::number_format::plain;
use calibrant_core::sensor::{Axis, SensorKind, interpolated};

/// The first version of PX4 whose `sensor_accel` and `sensor_gyro` are raw: earlier drivers corrected their readings.
const RAW_FROM: (u8, u8) = (1, 12);
/// Columns and values of the log's IMU, and what there is to say of the log.
pub(super) fn read(
    format: FileFormat,
    bytes: &[u8],
    options: &ImuReadOptions,
) -> Checked<(Draft, Samples, Vec<Diagnostic>)> {
    let (log, sources) = match format {
        FileFormat::Ulog => (ulog::read(bytes)?, PX4),
        _ => (dataflash::read(bytes), ARDUPILOT),
    };
    let AutopilotLog { streams, version, passed_over } = log;
    let Chosen { source, streams, others } = chosen(sources, streams, options)?;
    let mut findings = vec![
        MessagesChosen { taken: named(&streams), others: distinct(others.iter().map(with_rate)) }.into(),
    ];
    let is_early = format == FileFormat::Ulog && version.is_none_or(|version| version < RAW_FROM);
    if let Some(how) = source.corrected.or(is_early.then_some(PX4_CORRECTS)) {
        let topics = source.topics.join(" and ");
        findings.push(CorrectedOnBoard { topics, how: Phrase(how.to_owned()) }.into());
    }
    if passed_over.bytes > 0 {
        findings.push(LogPassedOver { bytes: passed_over.bytes, places: passed_over.places }.into());
    }
    let (draft, samples) = recording(format, &streams, &others)?;
    Ok((draft, samples, findings))
}

/// The streams in words: "`sensor_accel` and `sensor_gyro`, instance 0, at 200 Hz".
fn named(streams: &[Stream]) -> String {
    let topics = distinct(streams.iter().map(|stream| format!("`{}`", stream.topic)));
    let rates = distinct(streams.iter().map(|stream| plain(stream.rate_hz(), 4)));
    let instance = streams.first().map_or(0, |stream| stream.instance);
    format!("{}, instance {instance}, at {} Hz", topics.join(" and "), rates.join(" and "))
}

fn with_rate(stream: &Stream) -> String {
    format!("`{}` {} at {} Hz", stream.topic, stream.instance, plain(stream.rate_hz(), 4))
}

/// The recording of one IMU. Sensors that share their times share rows, and others have rows of their own.
fn recording(format: FileFormat, streams: &[Stream], others: &[Stream]) -> Checked<(Draft, Samples)> {
    let origin =
        streams.iter().filter_map(|stream| stream.times_us.first()).copied().fold(f64::INFINITY, f64::min);
    let share = streams.windows(2).all(|pair| pair[0].times_us == pair[1].times_us);
    let mut rows: Vec<(usize, usize)> = match share {
        true => (0..streams.first().map_or(0, |stream| stream.times_us.len())).map(|k| (0, k)).collect(),
        false => {
            (0..streams.len()).flat_map(|s| (0..streams[s].times_us.len()).map(move |k| (s, k))).collect()
        }
    };
    let time = |&(s, k): &(usize, usize)| streams[s].times_us[k];
    if !share {
        rows.sort_by(|one, other| time(one).total_cmp(&time(other)));
    }
    let mut columns: [Vec<f64>; SLOTS] = Default::default();
    columns[TIME] = rows.iter().map(|row| time(row) - origin).collect();
    let clocks = distinct(streams.iter().map(|stream| stream.clock)).join(", ");
    let time_unit = Some(ColumnUnit::Time(TimeUnit::Microsecond));
    let mut described = vec![ImuColumn::new(&clocks, ColumnMeaning::Time, time_unit)];
    for (s, stream) in streams.iter().enumerate() {
        let unit = match stream.sensor_kind {
            SensorKind::Accelerometer => ImuUnit::MetrePerSecondSquared,
            SensorKind::Gyroscope => ImuUnit::RadianPerSecond,
        };
        for axis in Axis::ALL {
            let name = format!("{}.{}", stream.topic, stream.axes[axis.index()]);
            let meaning = ColumnMeaning::Reading(stream.sensor_kind, axis);
            described.push(ImuColumn::new(&name, meaning, Some(ColumnUnit::Reading(unit))));
            let value = |&(of, k): &(usize, usize)| {
                if share || of == s { stream.readings[k][axis.index()] } else { f64::NAN }
            };
            columns[slots_of(stream.sensor_kind)[axis.index()]] = rows.iter().map(value).collect();
        }
    }
    let instance = streams.first().map(|stream| stream.instance);
    let has = |stream: &&Stream| !stream.temperatures_c.is_empty();
    // `sensor_combined` may be of any of several IMUs
    let is_known = format == FileFormat::DataFlash
        || distinct(others.iter().filter(has).map(|stream| stream.instance)).len() == 1;
    let of_imu = |stream: &&Stream| is_known && has(stream) && Some(stream.instance) == instance;
    if let Some(thermometer) = streams.iter().find(has).or(others.iter().find(of_imu)) {
        let name = format!("{}.temperature", thermometer.topic);
        described.push(ImuColumn::new(&name, ColumnMeaning::Temperature, Some(ColumnUnit::Celsius)));
        let value = |(k, row): (usize, &(usize, usize))| {
            interpolated(&thermometer.times_us, |k| thermometer.temperatures_c[k], time(row), k)
                .unwrap_or(f64::NAN)
        };
        columns[TEMPERATURE] = rows.iter().enumerate().map(value).collect();
    }
    Ok((Draft::new(format, described), Samples::from_columns(columns, origin as i64)?))
}
