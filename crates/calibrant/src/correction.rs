//! Corrects a recording with a calibration: what is read for it, what is checked, and what is noticed.

use crate::session::Source;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::correction::{
    BiasesSupposed, SensorAbsent, SensorUncalibrated, SpikesCorrected,
};
use calibrant_core::diagnostic::samples::CalibrationExtrapolated;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{
    CalibratedImu, CorrectedRecording, ImuCorrection, ImuRecording, ReadingUnit, SensorKind,
};
use calibrant_io::{ColumnMeaning, ImuFile, ImuReadOptions, Sensitivity, check_counts};

/// A corrected recording, and what was noticed.
#[derive(Debug, Clone)]
pub struct Applied<'a> {
    /// Specific force and angular rate, with the standard uncertainty of the correction.
    pub corrected: CorrectedRecording<'a>,
    /// What was noticed.
    pub notes: Vec<Diagnostic>,
}

/// Corrects a recording, of every sensor that the calibration and the recording both have.
///
/// A spike of the accelerometer is corrected as any sample, but it is no force that the gyroscope feels.
///
/// # Errors
/// [`Error::Experiment`] where the calibration cannot correct anything. [`Error::Recording`] as [`ImuCorrection::apply`].
///
/// # Examples
/// ```
/// use calibrant::sensor::{CalibratedImu, ImuParameters, ReadingUnit, Recording, SensorKind};
/// use calibrant::nalgebra::Vector3;
///
/// let mut parameters = ImuParameters::identity();
/// parameters[SensorKind::Accelerometer].bias.x = 0.1;
/// let unit = ReadingUnit::MetrePerSecondSquared;
/// let imu = CalibratedImu::new(parameters, [Some(unit), None], vec![], "");
/// let readings = vec![Vector3::new(0.3, 0.0, 9.8); 2];
/// let recording = Recording::new(vec![0.0, 0.01], readings, 3, unit)?.into();
/// let applied = calibrant::apply(&imu, &recording)?;
/// assert!((applied.corrected.accelerometer.expect("there").values[0].x - 0.2).abs() < 1e-12);
/// # Ok::<(), calibrant::Error>(())
/// ```
pub fn apply<'a>(imu: &CalibratedImu, recording: &'a ImuRecording) -> Result<Applied<'a>> {
    let correction = ImuCorrection::of(imu)?;
    let (clean, spikes) = recording.without_spikes();
    let corrected = correction.apply_feeling(recording, clean[SensorKind::Accelerometer].as_ref())?;
    let mut notes: Vec<Diagnostic> = Vec::new();
    for sensor_kind in SensorKind::ALL {
        match (imu.unit(sensor_kind), recording.sensor(sensor_kind)) {
            (Some(_), None) => notes.push(SensorAbsent { sensor_kind }.into()),
            (None, Some(_)) => notes.push(SensorUncalibrated { sensor_kind }.into()),
            (Some(_), Some(_)) if !imu.has_bias(sensor_kind) => {
                notes.push(BiasesSupposed { sensor_kind }.into())
            }
            _ => {}
        }
    }
    let temperatures = recording.temperature_c.as_deref().filter(|_| correction.follows_temperature());
    if let Some(range_c) = temperatures.and_then(range) {
        let beyond = CalibrationExtrapolated::of(&imu.parameters.thermal, range_c);
        notes.extend(beyond.into_iter().map(Diagnostic::from));
    }
    notes.extend(spikes.into_iter().map(|(sensor_kind, spikes)| {
        let count = spikes.samples.len() + spikes.cut.len();
        Diagnostic::from(SpikesCorrected { sensor_kind, spikes: count, time_s: spikes.time_s })
    }));
    Ok(Applied { corrected, notes })
}

/// Reads the recording that a calibration is to correct. A calibration in counts needs no unit of the file: it corrects counts. So does one of counts
/// with a known sensitivity, which makes readings of whole numbers; what they show is checked.
///
/// # Errors
/// [`Error::Recording`] as [`read_imu_recording`](calibrant_io::read_imu_recording), and where a calibrated sensor has columns that cannot be used.
pub fn read_for_correction(
    imu: &CalibratedImu,
    source: &Source,
    reading: &ImuReadOptions,
) -> Result<ImuFile> {
    // a sensor without calibration is ignored, whatever its unit
    let takes_counts = |kind: SensorKind| imu.unit(kind).is_none_or(|unit| unit == ReadingUnit::Counts);
    let read = |counts_unless_stated: [bool; 2]| {
        let options = ImuReadOptions { counts_unless_stated, ..reading.clone() };
        match alone(imu) {
            Some(sensor_kind) => source.read_sensor(sensor_kind, &options),
            None => source.read_imu(&options),
        }
    };
    let knows_counts = |kind: SensorKind| takes_counts(kind) || imu.counts_per_unit[kind].is_some();
    let asks = SensorKind::ALL.map(takes_counts);
    let mut file = read(if SensorKind::ALL.into_iter().all(knows_counts) { [true; 2] } else { asks })?;
    for sensor_kind in SensorKind::ALL.into_iter().filter(|&sensor_kind| imu.unit(sensor_kind).is_some()) {
        check_usable(&file, sensor_kind).map_err(|error| error.in_recording(source.path()))?;
    }
    for (sensor_kind, &counts) in imu.counts_per_unit.present() {
        let of_counts = file.recording[sensor_kind].as_mut().filter(|of| of.unit() == ReadingUnit::Counts);
        let (Some(recording), Some(sensitivity)) = (of_counts, Sensitivity::new(sensor_kind, counts)) else {
            continue;
        };
        let is_whole = recording.readings().iter().all(|reading| reading.iter().all(|of| of.fract() == 0.0));
        *recording = recording.mapped(sensor_kind.stimulus_unit(), |reading| reading / counts);
        let checked = check_counts(recording, sensitivity);
        if !is_whole || checked.is_err() {
            // what may be in another unit has it to be said
            read(asks)?;
        }
        checked.map_err(|error| error.in_recording(source.path()))?;
    }
    Ok(file)
}

/// Smallest and largest of some values.
fn range(values: &[f64]) -> Option<[f64; 2]> {
    values.iter().map(|&t| [t, t]).reduce(|[low, high], [t, _]| [low.min(t), high.max(t)])
}

/// The sensor of a calibration of one sensor alone.
fn alone(imu: &CalibratedImu) -> Option<SensorKind> {
    match (imu.unit(SensorKind::Accelerometer), imu.unit(SensorKind::Gyroscope)) {
        (Some(_), None) => Some(SensorKind::Accelerometer),
        (None, Some(_)) => Some(SensorKind::Gyroscope),
        _ => None,
    }
}

/// Returns an error for a sensor whose columns cannot be used. It would be missing from the result.
fn check_usable(file: &ImuFile, sensor_kind: SensorKind) -> Result<()> {
    let is_of = |meaning| matches!(meaning, ColumnMeaning::Reading(of, _) if of == sensor_kind);
    let unused = file.columns.iter().filter(|column| is_of(column.meaning));
    let why = unused.filter_map(|column| column.unused.as_deref()).next();
    match why.filter(|_| file.recording.sensor(sensor_kind).is_none()) {
        Some(why) => Err(Error::recording(InputError::new(
            Refusal::ColumnMissing,
            format!("the {sensor_kind} has columns, but they cannot be used: {why}"),
            format!("export it again, or remove the {sensor_kind}'s columns from the file"),
        ))),
        None => Ok(()),
    }
}
