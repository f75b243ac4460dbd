//! Writes a corrected recording as CSV.

use crate::files::atomic_output::write_entered;
use crate::files::manifest;
use crate::files::standard_input::open_input;
use crate::recording::imu::ImuUnit;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{Axis, CorrectedRecording, CorrectedSensor, PerSensor, SensorKind};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::Path;

/// Writes a corrected recording as CSV: `t_s,ax_mps2,ay_mps2,az_mps2,ax_sd_mps2,…,gx_radps,…,gx_sd_radps,…`, or in other units of specific force and rate.
///
/// A sensor that is not there has no columns, nor has an uncertainty that is not known. `sd` is the standard
/// uncertainty of the correction. It is the same error in every sample and does not average out. It does not
/// contain the noise of the sample. Where the sensors' times differ by more than a thousandth of the sample
/// interval, every time has a row. The fields of a sensor without a sample there are empty. Numbers have the
/// fewest digits that read back to the same bits. The manifest of the folder names the calibration.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_corrected_recording(
    path: &Path,
    recording: &CorrectedRecording<'_>,
    calibration: &str,
    units: PerSensor<ImuUnit>,
) -> Result<()> {
    let sensor_kinds: Vec<_> = [
        (SensorKind::Accelerometer, &recording.accelerometer),
        (SensorKind::Gyroscope, &recording.gyroscope),
    ]
    .into_iter()
    .filter_map(|(sensor_kind, corrected)| Some((sensor_kind, corrected.as_ref()?)))
    .collect();
    let same_s = SAME * sensor_kinds.iter().map(|(_, of)| step(of.times_s)).fold(f64::INFINITY, f64::min);
    write_entered(path, Some(calibration), |out| {
        write!(out, "t_s")?;
        for (sensor_kind, corrected) in &sensor_kinds {
            header(out, *sensor_kind, units[*sensor_kind], corrected)?;
        }
        writeln!(out)?;
        let mut next = vec![0; sensor_kinds.len()];
        loop {
            let times = sensor_kinds
                .iter()
                .zip(&next)
                .filter_map(|((_, corrected), &k)| corrected.times_s.get(k).copied());
            let Some(time) = times.reduce(f64::min) else { return Ok(()) };
            write!(out, "{time:?}")?;
            for ((sensor_kind, corrected), k) in sensor_kinds.iter().zip(&mut next) {
                let here = corrected.times_s.get(*k).is_some_and(|t| t - time <= same_s);
                row(out, corrected, units[*sensor_kind], here.then_some(*k))?;
                *k += usize::from(here);
            }
            writeln!(out)?;
        }
    })
}

/// Longest header that is looked at, bytes.
const LONGEST: u64 = 4096;

/// Refuses a recording that [`write_corrected_recording`] wrote: to correct it again would spoil it.
///
/// It is known by the manifest of its folder, or by its columns of standard uncertainties.
///
/// # Errors
/// [`Error::Recording`] with the name of the calibration where it is known. A file that cannot be read is no error here.
pub fn check_not_corrected(path: &Path) -> Result<()> {
    let with = match manifest::entry(path).map(|entry| entry.corrected_with) {
        Some(Some(calibration)) => format!(", with {}", calibration.escape_debug()),
        _ if has_uncertainties(path).unwrap_or(false) => String::new(),
        _ => return Ok(()),
    };
    let message = format!("this recording has been corrected already{with}");
    let help = "give the recording that the sensor made";
    Err(Error::recording(InputError::new(Refusal::RecordingCorrected, message, help).in_file(path)))
}

/// Has a CSV a column as [`header`] names those of uncertainties?
fn has_uncertainties(path: &Path) -> io::Result<bool> {
    let mut line = Vec::new();
    BufReader::new(open_input(path)?.take(LONGEST)).read_until(b'\n', &mut line)?;
    let line = String::from_utf8_lossy(&line);
    let mut columns = line.trim_end().split(',');
    Ok(columns.any(|name| name.starts_with("ax_sd_") || name.starts_with("gx_sd_")))
}

/// Times closer than this share of the sample interval count as one: those of two files may differ in the
/// last digit.
const SAME: f64 = 1e-3;

/// The mean step of sample times; 0 for fewer than two.
fn step(times_s: &[f64]) -> f64 {
    match times_s {
        [first, .., last] => (last - first) / (times_s.len() - 1) as f64,
        _ => 0.0,
    }
}

fn header(
    out: &mut dyn Write,
    sensor_kind: SensorKind,
    unit: ImuUnit,
    corrected: &CorrectedSensor<'_>,
) -> io::Result<()> {
    let (letter, unit) = (&sensor_kind.name()[..1], unit.suffix());
    for axis in Axis::ALL {
        write!(out, ",{letter}{axis}_{unit}")?;
    }
    if corrected.sd.is_some() {
        for axis in Axis::ALL {
            write!(out, ",{letter}{axis}_sd_{unit}")?;
        }
    }
    Ok(())
}

fn row(
    out: &mut dyn Write,
    corrected: &CorrectedSensor<'_>,
    unit: ImuUnit,
    sample: Option<usize>,
) -> io::Result<()> {
    let (_, size) = unit.reading();
    for vectors in [Some(&corrected.values), corrected.sd.as_ref()].into_iter().flatten() {
        match sample.and_then(|k| vectors.get(k)) {
            Some(values) => values.iter().try_for_each(|value| write!(out, ",{:?}", value / size))?,
            None => write!(out, ",,,")?,
        }
    }
    Ok(())
}
