//! `calibrant apply`: a recording corrected, with the correction's standard uncertainty.

use crate::calibration_file::{Reading, Unit, in_words};
use crate::{Exit, console};
use calibrant::Error;
use calibrant::error::Complaint;
use calibrant::io::{ReadOptions, read_recording, write_corrected_recording};
use calibrant::report::number;
use calibrant::sensor::{CalibratedImu, CorrectedTriad, ImuCorrection, ImuRecording, ReadingUnit, Triad};
use std::path::{Path, PathBuf};

/// Correct a recording with a calibration: true specific force and angular rate, with the correction's standard uncertainty.
///
/// Writes CSV with the columns t_s,ax_mps2,…,ax_sd_mps2,…,gx_radps,…,gx_sd_radps,…. The uncertainty is that of the calibration: the same error in every sample,
/// which does not average out; the noise of a sample is not in it.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The calibration, in any format that `calibrant convert` reads.
    calibration: PathBuf,
    /// The recording: CSV with header t_s,ax,ay,az, or text with columns t x y z.
    recording: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// Where to write the corrected recording.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

pub(crate) fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    let imu = arguments.reading.read(&arguments.calibration)?.imu;
    let correction = ImuCorrection::of(&imu)?;
    let recording = read_for(&imu, &arguments.recording, arguments.reading.unit)?;
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

/// The recording that a calibration is applied to.
///
/// The one place that reads it: a recording of an accelerometer alone so far.
fn read_for(imu: &CalibratedImu, path: &Path, unit: Option<Unit>) -> calibrant::Result<ImuRecording> {
    let Some(expected_unit) = imu.accelerometer_unit else {
        let complaint = Complaint::new(
            "the calibration is of a gyroscope alone, and recordings of a gyroscope are not read yet",
            "give the calibration of an accelerometer or of a whole IMU",
        );
        return Err(Error::Recording(Box::new(complaint.in_file(path))));
    };
    let unit = unit.map(|unit| match unit {
        Unit::Si => ReadingUnit::MetrePerSecondSquared,
        Unit::Counts => ReadingUnit::Counts,
    });
    let file = read_recording(path, &ReadOptions { unit, expected_unit, axes: 3 })?;
    for finding in &file.findings {
        console::note(&format!("{}: {finding}", path.display()));
    }
    Ok(ImuRecording { accelerometer: Some(file.recording), ..ImuRecording::default() })
}

/// The error, about this file.
fn in_file(error: Error, path: &Path) -> Error {
    match error {
        Error::Recording(complaint) => Error::Recording(Box::new(complaint.in_file(path))),
        other => other,
    }
}

/// Samples, size and uncertainty of one sensor in a line or two.
fn summary(triad: Triad, corrected: &CorrectedTriad) -> String {
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
