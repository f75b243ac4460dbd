//! `calibrant apply`: a recording corrected, with the correction's standard uncertainty.

use crate::calibration_file::{Reading, Unit, in_words};
use crate::reading::in_file;
use crate::{Exit, console, place};
use calibrant::io::{
    FileFormat, ImuFile, ImuReadOptions, ImuUnit, ReadOptions, read_imu_pair, read_imu_recording,
    read_recording, write_corrected_recording,
};
use calibrant::report::number;
use calibrant::sensor::{
    CalibratedImu, CorrectedTriad, ImuCorrection, ImuRecording, ReadingUnit, Recording, Triad,
};
use std::path::PathBuf;

/// Correct a recording with a calibration: true specific force and angular rate, with the correction's standard uncertainty.
///
/// Writes CSV with the columns t_s,ax_mps2,…,ax_sd_mps2,…,gx_radps,…,gx_sd_radps,…. The uncertainty is that of the calibration: the same error in every sample,
/// which does not average out; the noise of a sample is not in it.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The calibration, in any format that `calibrant convert` reads.
    calibration: PathBuf,
    /// The recording, in any format that `calibrant inspect` knows.
    recording: PathBuf,
    /// The gyroscope's file, where the sensors have a file each (imu_tk).
    #[arg(long, value_name = "FILE")]
    gyroscope: Option<PathBuf>,
    #[command(flatten)]
    file: crate::reading::RecordingOptions,
    #[command(flatten)]
    reading: Reading,
    /// The temperature, °C, where the calibration follows it and the recording does not have it (or another).
    #[arg(long, value_name = "CELSIUS", allow_negative_numbers = true, value_parser = crate::reading::celsius)]
    temperature: Option<f64>,
    /// Where to write the corrected recording.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

pub(crate) fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    let second = arguments.gyroscope.as_deref().unwrap_or(&arguments.recording);
    place::check_not_input(&arguments.output, &[&arguments.calibration, &arguments.recording, second])?;
    let imu = arguments.reading.read(&arguments.calibration)?.imu;
    let correction = ImuCorrection::of(&imu)?;
    let mut recording = read_for(&imu, arguments)?;
    match arguments.temperature {
        Some(temperature_c) if correction.follows_temperature() => {
            let sensor = recording.accelerometer.as_ref().or(recording.gyroscope.as_ref());
            recording.temperature_c = Some(vec![temperature_c; sensor.map_or(0, Recording::len)]);
        }
        Some(_) => console::note("--temperature is not used: the calibration does not follow temperature"),
        None => {}
    }
    let corrected =
        correction.apply(&imu, &recording).map_err(|error| in_file(error, &arguments.recording))?;
    for triad in Triad::ALL {
        match (imu.unit(triad), recording.triad(triad)) {
            (Some(_), None) => {
                console::note(&format!("the recording has no {triad}: nothing of it is corrected"))
            }
            (None, Some(_)) => {
                console::warn(&format!("the calibration has no {triad}: its readings are left out"));
            }
            _ => {}
        }
    }
    if let Some(range) =
        recording.temperature_c.as_deref().and_then(range).filter(|_| correction.follows_temperature())
    {
        console::warn_beyond(&imu, range);
    }
    write_corrected_recording(&arguments.output, &corrected)?;
    console::print(&format!("{}: {}\n", arguments.calibration.display(), in_words(&imu)));
    for (triad, found) in
        [(Triad::Accelerometer, &corrected.accelerometer), (Triad::Gyroscope, &corrected.gyroscope)]
    {
        if let Some(found) = found {
            console::print(&summary(triad, found));
        }
    }
    console::print(&format!("{}\n", arguments.output.display()));
    Ok(Exit::DONE)
}

/// Least and greatest of some values.
fn range(values: &[f64]) -> Option<[f64; 2]> {
    values.iter().map(|&t| [t, t]).reduce(|[low, high], [t, _]| [low.min(t), high.max(t)])
}

/// The recording that a calibration is applied to: what its file does not say of units is taken to be as the calibration has it.
fn read_for(imu: &CalibratedImu, arguments: &Arguments) -> calibrant::Result<ImuRecording> {
    let path = &arguments.recording;
    let read = |options: &ImuReadOptions| match &arguments.gyroscope {
        Some(gyroscope) => read_imu_pair(path, gyroscope, options),
        None => read_imu_recording(path, options),
    };
    let given = arguments.file.options();
    let si = |triad: Triad, unit: ReadingUnit| match (unit, triad) {
        (ReadingUnit::Counts, _) => ImuUnit::Counts,
        (_, Triad::Accelerometer) => ImuUnit::MetrePerSecondSquared,
        (_, Triad::Gyroscope) => ImuUnit::RadianPerSecond,
    };
    let chosen = arguments.reading.unit.map(|unit| match unit {
        Unit::Si => ReadingUnit::MetrePerSecondSquared,
        Unit::Counts => ReadingUnit::Counts,
    });
    let unit = |triad: Triad| chosen.or(imu.unit(triad)).map(|unit| si(triad, unit));
    let assumed = given.clone().or(ImuReadOptions {
        accelerometer_unit: unit(Triad::Accelerometer),
        gyroscope_unit: unit(Triad::Gyroscope),
        ..ImuReadOptions::default()
    });
    let file = read(&given)
        .or_else(|_| read(&assumed))
        .or_else(|error| one_sensor(imu, arguments).map_err(|_| error))?;
    for finding in &file.findings {
        console::finding(&path.display().to_string(), finding);
    }
    Ok(file.recording)
}

/// A file of one sensor alone, `t x y z`, for a calibration of one.
fn one_sensor(imu: &CalibratedImu, arguments: &Arguments) -> calibrant::Result<ImuFile> {
    let (triad, expected_unit) = match (imu.accelerometer_unit, imu.gyroscope_unit) {
        (Some(unit), _) => (Triad::Accelerometer, unit),
        (None, Some(unit)) => (Triad::Gyroscope, unit),
        (None, None) => (Triad::Accelerometer, ReadingUnit::MetrePerSecondSquared),
    };
    let file = read_recording(&arguments.recording, &ReadOptions { unit: None, expected_unit, axes: 3 })?;
    let mut recording = ImuRecording::default();
    match triad {
        Triad::Accelerometer => recording.accelerometer = Some(file.recording),
        Triad::Gyroscope => recording.gyroscope = Some(file.recording),
    }
    Ok(ImuFile {
        recording,
        format: FileFormat::ImuTk,
        columns: Vec::new(),
        findings: file.findings,
        rows: file.lines,
        sha256: vec![file.sha256],
    })
}

/// Samples, size and uncertainty of one sensor in a line or two.
fn summary(triad: Triad, corrected: &CorrectedTriad<'_>) -> String {
    let unit = triad.stimulus_unit().symbol();
    let samples = corrected.values.len();
    let mean = corrected.values.iter().map(|value| value.norm()).sum::<f64>() / samples.max(1) as f64;
    let mut text = format!(
        "  {triad}: {} samples, mean magnitude {} {unit}\n",
        number::count(samples),
        number::significant(mean, 6)
    );
    if let Some(sd) = &corrected.sd {
        let largest = |axis: usize| sd.iter().map(|sd| sd[axis]).fold(0.0, f64::max);
        let largest: Vec<_> = (0..3).map(|axis| number::significant(largest(axis), 2)).collect();
        text.push_str(&format!(
            "  largest standard uncertainty of the correction: {} {unit}\n",
            largest.join(", ")
        ));
    } else {
        text.push_str("  its uncertainty is not known: the calibration has no covariance of it\n");
    }
    text
}
