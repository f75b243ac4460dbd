//! `calibrant apply`: corrects a recording, and writes the standard uncertainty of the correction.

use crate::calibration_file::{Content, in_words};
use crate::diagnostics::{tell, tell_all};
use crate::{Exit, console};
use calibrant::Error;
use calibrant::diagnostic::correction::{SensorAbsent, SensorUncalibrated, SpikesCorrected};
use calibrant::diagnostic::samples::CalibrationExtrapolated;
use calibrant::diagnostic::settings::SettingUnused;
use calibrant::error::{InputError, Refusal};
use calibrant::io::{
    ColumnMeaning, ImuFile, ImuReadOptions, ResultPlaces, check_not_corrected, file_name, imu_tk_files,
    read_imu_pair, read_imu_recording, read_imu_sensor, write_corrected_recording,
};
use calibrant::report::number_format;
use calibrant::sensor::{
    CalibratedImu, CorrectedSensor, ImuCorrection, ImuRecording, ReadingUnit, Recording, SensorKind,
};
use std::path::PathBuf;

/// Correct a recording with a calibration. The result is specific force and angular rate, with their standard uncertainty.
///
/// Writes CSV with the columns t_s,ax_mps2,…,ax_sd_mps2,…,gx_radps,…,gx_sd_radps,…. The uncertainty is that of the calibration. Its error is
/// the same in every sample, and does not average out. It does not include the noise of a sample.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The calibration, in any format that `calibrant convert` reads.
    calibration: PathBuf,
    /// The recording, in any format that `calibrant inspect` knows.
    recording: PathBuf,
    /// The gyroscope's file, if each sensor has its own file (imu_tk).
    #[arg(long, value_name = "FILE")]
    gyroscope: Option<PathBuf>,
    #[command(flatten)]
    file: crate::recording_options::RecordingOptions,
    /// Experiment file whose [columns] name the columns of the recording.
    #[arg(long, value_name = "EXPERIMENT")]
    columns: Option<PathBuf>,
    #[command(flatten)]
    content: Content,
    /// Temperature of the recording, °C, for a calibration with temperature terms. It replaces that of the recording.
    #[arg(long, value_name = "CELSIUS", allow_negative_numbers = true, value_parser = crate::recording_options::celsius)]
    temperature: Option<f64>,
    /// Where to write the corrected recording.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

impl crate::run::Run for Arguments {
    fn places(&self) -> ResultPlaces {
        let inputs =
            [&self.calibration, &self.recording].into_iter().chain(&self.gyroscope).chain(&self.columns);
        ResultPlaces {
            directory: None,
            results: vec![self.output.clone()],
            inputs: inputs.cloned().chain(imu_tk_files(&self.calibration)).collect(),
        }
    }

    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    for recording in std::iter::once(&arguments.recording).chain(&arguments.gyroscope) {
        check_not_corrected(recording)?;
    }
    let imu = arguments.content.read(&arguments.calibration, arguments.file.raw_units())?.imu;
    let correction = ImuCorrection::of(&imu)?;
    let mut recording = read_for(&imu, arguments)?;
    match arguments.temperature {
        Some(temperature_c) if correction.follows_temperature() => {
            let sensor = recording.accelerometer.as_ref().or(recording.gyroscope.as_ref());
            recording.temperature_c = Some(vec![temperature_c; sensor.map_or(0, Recording::len)]);
        }
        Some(_) => tell(SettingUnused::of(&["--temperature"], "the calibration has no temperature terms")),
        None => {}
    }
    let (clean, spikes) = recording.without_spikes();
    let corrected = correction
        .apply_feeling(&imu, &recording, clean.accelerometer.as_ref())
        .map_err(|error| error.in_recording(&arguments.recording))?;
    for sensor_kind in SensorKind::ALL {
        match (imu.unit(sensor_kind), recording.sensor(sensor_kind)) {
            (Some(_), None) => tell(SensorAbsent { sensor_kind }),
            (None, Some(_)) => tell(SensorUncalibrated { sensor_kind }),
            _ => {}
        }
    }
    if let Some(range) =
        recording.temperature_c.as_deref().and_then(range).filter(|_| correction.follows_temperature())
    {
        CalibrationExtrapolated::of(&imu.parameters.thermal, range).into_iter().for_each(tell);
    }
    for (sensor_kind, spikes) in spikes {
        let count = spikes.samples.len() + spikes.cut.len();
        tell(SpikesCorrected { sensor_kind, spikes: count, time_s: spikes.time_s });
    }
    write_corrected_recording(&arguments.output, &corrected, &file_name(&arguments.calibration))?;
    console::print(&format!("{}: {}\n", arguments.calibration.display(), in_words(&imu)));
    for (sensor_kind, found) in
        [(SensorKind::Accelerometer, &corrected.accelerometer), (SensorKind::Gyroscope, &corrected.gyroscope)]
    {
        if let Some(found) = found {
            console::print(&summary(sensor_kind, found));
        }
    }
    console::print(&format!("{}\n", arguments.output.display()));
    Ok(Exit::DONE)
}

/// Smallest and largest of some values.
fn range(values: &[f64]) -> Option<[f64; 2]> {
    values.iter().map(|&t| [t, t]).reduce(|[low, high], [t, _]| [low.min(t), high.max(t)])
}

/// Reads the recording to which a calibration is applied.
fn read_for(imu: &CalibratedImu, arguments: &Arguments) -> calibrant::Result<ImuRecording> {
    let path = &arguments.recording;
    let file = read(imu, arguments)?;
    let second = arguments.gyroscope.as_ref().map(|path| path.display().to_string());
    let found = file.findings_in(&path.display().to_string(), second.as_deref());
    tell_all(&found);
    for sensor_kind in SensorKind::ALL.into_iter().filter(|&sensor_kind| imu.unit(sensor_kind).is_some()) {
        check_usable(&file, sensor_kind).map_err(|error| error.in_recording(path))?;
    }
    Ok(file.recording)
}

/// Reads the file. The user must give a unit that the file does not state. A calibration in counts needs no unit:
/// it corrects counts.
fn read(imu: &CalibratedImu, arguments: &Arguments) -> calibrant::Result<ImuFile> {
    let options = ImuReadOptions {
        // a sensor without calibration is ignored, whatever its unit
        counts_unless_stated: SensorKind::ALL
            .map(|sensor_kind| imu.unit(sensor_kind).is_none_or(|unit| unit == ReadingUnit::Counts)),
        ..arguments.file.with_columns(arguments.columns.as_deref())?
    };
    let path = &arguments.recording;
    match (&arguments.gyroscope, alone(imu)) {
        (Some(gyroscope), _) => read_imu_pair(path, gyroscope, &options),
        (None, Some(sensor_kind)) => read_imu_sensor(path, sensor_kind, &options),
        (None, None) => read_imu_recording(path, &options),
    }
}

/// The sensor of a calibration of one sensor alone.
fn alone(imu: &CalibratedImu) -> Option<SensorKind> {
    match (imu.accelerometer_unit, imu.gyroscope_unit) {
        (Some(_), None) => Some(SensorKind::Accelerometer),
        (None, Some(_)) => Some(SensorKind::Gyroscope),
        _ => None,
    }
}

/// Returns an error for a sensor whose columns cannot be used. It would be missing from the result.
fn check_usable(file: &ImuFile, sensor_kind: SensorKind) -> calibrant::Result<()> {
    let is_of = |meaning| matches!(meaning, ColumnMeaning::Reading(of, _) if of == sensor_kind);
    let unused = file.columns.iter().filter(|column| is_of(column.meaning));
    let why = unused.filter_map(|column| column.unused.as_deref()).next();
    match why.filter(|_| file.recording.sensor(sensor_kind).is_none()) {
        Some(why) => Err(Error::Recording(Box::new(InputError::new(
            Refusal::ColumnMissing,
            format!("the {sensor_kind} has columns, but they cannot be used: {why}"),
            format!("export it again, or remove the {sensor_kind}'s columns from the file"),
        )))),
        None => Ok(()),
    }
}

/// Number of samples, mean magnitude and uncertainty of one sensor.
fn summary(sensor_kind: SensorKind, corrected: &CorrectedSensor<'_>) -> String {
    let unit = sensor_kind.stimulus_unit().symbol();
    let samples = corrected.values.len();
    let mean = corrected.values.iter().map(|value| value.norm()).sum::<f64>() / samples.max(1) as f64;
    let mut text = format!(
        "  {sensor_kind}: {} samples, mean magnitude {} {unit}\n",
        number_format::count(samples),
        number_format::significant(mean, 6)
    );
    if let Some(sd) = &corrected.sd {
        let largest = |axis: usize| sd.iter().map(|sd| sd[axis]).fold(0.0, f64::max);
        let largest: Vec<_> = (0..3).map(|axis| number_format::significant(largest(axis), 2)).collect();
        text.push_str(&format!(
            "  largest standard uncertainty of the correction: {} {unit}\n",
            largest.join(", ")
        ));
    } else {
        text.push_str("  its uncertainty is not known: the calibration has no covariance for it\n");
    }
    text
}
