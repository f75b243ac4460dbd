//! What every command that reads a recording needs: the options that say what its file does not say itself, and its name in errors.

use calibrant::Error;
use calibrant::diagnostic::Diagnostic;
use calibrant::io::{FileFormat, ImuReadOptions, ImuUnit, TimeUnit, read_columns};
use calibrant::sensor::{ImuRecording, Recording, SensorKind, Spikes, WORKING_C};
use std::borrow::Cow;
use std::path::Path;

#[derive(clap::Args, Clone)]
pub(crate) struct RecordingOptions {
    /// The format: mt-manager, movella-dot, euroc, imu-tk, imucal, csv, mcap or parquet (default: by content).
    #[arg(long, value_parser = format)]
    format: Option<FileFormat>,
    /// Unit of the accelerometer where the file does not say: m/s2, g, mg or counts.
    #[arg(long, value_name = "UNIT", value_parser = accelerometer_unit)]
    accelerometer_unit: Option<ImuUnit>,
    /// Unit of the gyroscope where the file does not say: rad/s, deg/s, mdps or counts.
    #[arg(long, value_name = "UNIT", value_parser = gyroscope_unit)]
    gyroscope_unit: Option<ImuUnit>,
    /// Unit of the time column where its name does not say: s, ms, us or ns; samples for a counter.
    #[arg(long, value_name = "UNIT", value_parser = time_unit)]
    time_unit: Option<TimeUnit>,
    /// Sample rate, Hz, for files without sample times.
    #[arg(long, value_name = "HZ")]
    rate_hz: Option<f64>,
    /// Topic of a bag that has more than one IMU.
    #[arg(long)]
    topic: Option<String>,
}

impl RecordingOptions {
    /// As the readers take them.
    pub(crate) fn options(&self) -> ImuReadOptions {
        ImuReadOptions {
            format: self.format,
            time_unit: self.time_unit,
            accelerometer_unit: self.accelerometer_unit,
            gyroscope_unit: self.gyroscope_unit,
            rate_hz: self.rate_hz,
            topic: self.topic.clone(),
            ..ImuReadOptions::default()
        }
    }

    /// The same, and what `[columns]` of an experiment file says where these say nothing.
    pub(crate) fn with_columns(&self, experiment: Option<&Path>) -> calibrant::Result<ImuReadOptions> {
        let given = self.options();
        let Some(experiment) = experiment else { return Ok(given) };
        Ok(given.or(read_columns(experiment)?))
    }
}

fn format(text: &str) -> Result<FileFormat, String> {
    let all = || FileFormat::ALL.map(FileFormat::name).join(", ");
    FileFormat::parse(text).ok_or_else(|| format!("the formats are {}", all()))
}

fn unit(text: &str, sensor_kind: SensorKind) -> Result<ImuUnit, String> {
    let choices = || format!("the {sensor_kind} is in {}", ImuUnit::choices(sensor_kind));
    ImuUnit::parse(text).filter(|unit| unit.suits(sensor_kind)).ok_or_else(choices)
}

fn accelerometer_unit(text: &str) -> Result<ImuUnit, String> {
    unit(text, SensorKind::Accelerometer)
}

fn gyroscope_unit(text: &str) -> Result<ImuUnit, String> {
    unit(text, SensorKind::Gyroscope)
}

/// A unit of readings, whichever sensor's.
pub(crate) fn any_unit(text: &str) -> Result<ImuUnit, String> {
    ImuUnit::parse(text).ok_or_else(|| {
        let [accelerometer, gyroscope] = SensorKind::ALL.map(ImuUnit::choices);
        format!("the accelerometer is in {accelerometer}, the gyroscope in {gyroscope}")
    })
}

fn time_unit(text: &str) -> Result<TimeUnit, String> {
    TimeUnit::parse(text).ok_or_else(|| "times are in s, ms, us or ns, or samples".into())
}

/// A temperature that a sensor can have, °C.
pub(crate) fn celsius(text: &str) -> Result<f64, String> {
    let (low, high) = (WORKING_C.start(), WORKING_C.end());
    let value = text.parse().ok().filter(|value| WORKING_C.contains(value));
    value.ok_or_else(|| format!("a sensor's temperature in °C, from {low} to {high}"))
}

/// Takes spikes and invalid readings out of a recording; a warning for each sensor that has some.
pub(crate) fn take_out_spikes(recording: &mut ImuRecording) -> Vec<Diagnostic> {
    let (clean, spikes) = recording.without_spikes();
    let of_sensor = |(sensor_kind, spikes): &(SensorKind, Spikes)| {
        let unit = recording.sensor(*sensor_kind)?.unit;
        Some(Diagnostic::spikes(spikes, *sensor_kind, unit))
    };
    let stated = spikes.iter().filter_map(of_sensor).collect();
    if let Cow::Owned(clean) = clean {
        *recording = clean;
    }
    stated
}

/// The same of an accelerometer alone.
pub(crate) fn spikes_taken_out(recording: &mut Recording) -> Option<Diagnostic> {
    let (clean, spikes) = recording.without_spikes(SensorKind::Accelerometer);
    let stated = spikes.map(|spikes| Diagnostic::spikes(&spikes, SensorKind::Accelerometer, recording.unit));
    if let Cow::Owned(clean) = clean {
        *recording = clean;
    }
    stated
}

/// Names the recording in an error that does not.
pub(crate) fn in_file(error: Error, path: &Path) -> Error {
    match error {
        Error::Recording(input_error) if input_error.file.is_none() => {
            Error::Recording(Box::new(input_error.in_file(path)))
        }
        other => other,
    }
}

/// Name of a file, without its directory.
pub(crate) fn name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}
