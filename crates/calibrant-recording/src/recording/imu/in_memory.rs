//! Recordings that are in memory already: a table of named columns is one more format, and a recording is taken as it is.

use super::accelerometer_only::plain_columns;
use super::column_names;
use super::column_values::{SLOTS, Samples};
use super::file::ImuFile;
use super::file_layout::Draft;
use super::format::FileFormat;
use super::options::ImuReadOptions;
use super::read::finish;
use super::two_files::joined;
use crate::files::checksum::hex_of_lists;
use crate::text::decoding::{Checked, refuse};
use calibrant_core::error::{Error, Refusal, Result};
use calibrant_core::sensor::{ImuRecording, SensorKind};

/// Reads a table in memory, whose columns are named as those of a CSV: `t_s`, `ax_mps2`, `gyr_x`, `temp_c`. Missing values are NaN.
///
/// It is one more format: units come from the names or from the options, and everything else goes the way of a file.
///
/// # Errors
/// [`Error::Recording`] as [`read_imu_recording`](crate::read_imu_recording), without a file; and where two columns have different lengths.
///
/// # Examples
/// ```
/// use calibrant_core::sensor::SensorKind;
/// use calibrant_recording::{ImuReadOptions, ImuUnit, imu_from_columns};
///
/// let (t, x, z) = ([0.0, 0.01, 0.02], [0.0; 3], [1.0, 1.01, 0.99]);
/// let table: [(&str, &[f64]); 4] = [("t_s", &t), ("ax", &x), ("ay", &x), ("az", &z)];
/// let question = imu_from_columns(&table, &ImuReadOptions::default()).expect_err("nothing says the unit");
/// assert!(question.to_string().contains("suggest g"));
/// let options = ImuReadOptions { accelerometer_unit: Some(ImuUnit::StandardGravity), ..ImuReadOptions::default() };
/// let recording = imu_from_columns(&table, &options)?.recording;
/// let accelerometer = recording.sensor(SensorKind::Accelerometer).expect("there");
/// assert_eq!(accelerometer.readings()[0].z, 9.806_65);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn imu_from_columns(columns: &[(&str, &[f64])], options: &ImuReadOptions) -> Result<ImuFile> {
    read(columns, options).map_err(Error::Recording)
}

/// Two recordings as one: the accelerometer of the first, the gyroscope of the second. Each has its own sample times, and the clock is one.
#[must_use]
pub fn imu_pair_of(accelerometer: ImuFile, gyroscope: ImuFile) -> ImuFile {
    joined(accelerometer, gyroscope)
}

fn read(columns: &[(&str, &[f64])], options: &ImuReadOptions) -> Checked<ImuFile> {
    if let [(first, one), others @ ..] = columns
        && let Some((name, other)) = others.iter().find(|(_, other)| other.len() != one.len())
    {
        let message = format!("`{first}` has {} values, `{name}` {}", one.len(), other.len());
        let help = "give columns of one length, with NaN where a value is missing";
        return refuse(Refusal::RecordingsUnlike, message, help);
    }
    let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
    let described = || names.iter().map(|name| column_names::column(name)).collect();
    let plain = plain_columns(&names, options);
    let mut draft = plain.unwrap_or_else(|| Draft::new(FileFormat::Columns, described()));
    draft.map(options)?;
    draft.set_time_unit(options)?;
    let mut values: [Vec<f64>; SLOTS] = Default::default();
    for (slot, (_, column)) in draft.slots()?.into_iter().zip(columns) {
        if let Some(slot) = slot {
            values[slot] = column.to_vec();
        }
    }
    let file = finish(draft, Samples::from_columns(values, 0)?, options)?;
    let lists = columns.iter().map(|(name, values)| (*name, values.iter().copied()));
    Ok(ImuFile { sha256: vec![hex_of_lists(lists)], ..file })
}

impl ImuFile {
    /// A recording that was made, or read, elsewhere.
    #[must_use]
    pub fn of_recording(recording: ImuRecording) -> Self {
        let sensors = SensorKind::ALL.into_iter().filter_map(|kind| Some((kind, recording.sensor(kind)?)));
        let lists = sensors.flat_map(|(kind, of)| {
            let numbers = of.readings().iter().flat_map(|reading| [reading.x, reading.y, reading.z]);
            let [times, readings]: [Vec<f64>; 2] = [of.times_s().to_vec(), numbers.collect()];
            [("t_s", times.into_iter()), (kind.name(), readings.into_iter())]
        });
        let sha256 = vec![hex_of_lists(lists)];
        let rows = recording[SensorKind::Accelerometer]
            .as_ref()
            .or(recording[SensorKind::Gyroscope].as_ref())
            .map_or(0, |of| of.len());
        Self {
            format: FileFormat::Columns,
            columns: Vec::new(),
            findings: Vec::new(),
            rows,
            sha256,
            second: None,
            counted_from_ns: None,
            rate_sd_ppm: None,
            recording,
        }
    }
}
