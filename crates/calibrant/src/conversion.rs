//! What is changed of a calibration before it is written in another format.

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::Phrase;
use calibrant_core::diagnostic::correction::{PartsOmitted, TemperatureFixed};
use calibrant_core::diagnostic::samples::CalibrationExtrapolated;
use calibrant_core::diagnostic::settings::SettingUnused;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{CalibratedImu, Gauge, ImuPart, ReadingUnit, SensorKind};
use calibrant_io::{
    CalibratedImuFile, ConventionOptions, ImuNoise, read_calibrated_imu, read_kalibr_noise,
    read_measured_noise,
};
use std::path::PathBuf;

/// Changes of a calibration on its way into another format.
///
/// # Examples
/// ```
/// use calibrant::Conversion;
/// use calibrant::io::{CalibratedImuFile, ImuFormat};
/// use calibrant::sensor::{CalibratedImu, Gauge, ImuParameters, ReadingUnit};
///
/// let unit = ReadingUnit::MetrePerSecondSquared;
/// let imu = CalibratedImu::new(ImuParameters::identity(), [Some(unit), None], vec![], "");
/// let mut file = CalibratedImuFile::new(imu, ImuFormat::ImuTk);
/// let notes = Conversion { gauge: Some(Gauge::Lower), ..Conversion::default() }.change(&mut file)?;
/// assert!(notes.is_empty());
/// # Ok::<(), calibrant::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Conversion {
    /// The file of the calibration, for errors.
    pub path: Option<PathBuf>,
    /// The calibration that had corrected the readings of this one: both together are written, of raw readings.
    pub after: Option<PathBuf>,
    /// Files with noise densities: `noise.json`, or an `imu.yaml` of Kalibr. A file adds what the earlier ones lack.
    pub noise: Vec<PathBuf>,
    /// The parts that are left out. This changes the correction.
    pub drop: Vec<ImuPart>,
    /// The sensor that is written alone.
    pub sensor: Option<SensorKind>,
    /// The temperature at which the terms of temperature are evaluated, °C.
    pub temperature_c: Option<f64>,
    /// The gauge of the accelerometer into which the true frame of both sensors is turned.
    pub gauge: Option<Gauge>,
    /// The ROS topic of the IMU.
    pub rostopic: Option<String>,
    /// The rate of its readings, Hz; that of the noise or of the recording by default.
    pub update_rate_hz: Option<f64>,
}

impl Conversion {
    /// Changes a calibration; returns what should be known of it.
    ///
    /// # Errors
    /// [`Error::Experiment`] where a file of noise cannot be read, or where the sensor is missing or cannot be written alone.
    pub fn change(&self, file: &mut CalibratedImuFile) -> Result<Vec<Diagnostic>> {
        let mut notes = Vec::new();
        if let Some(mut noise) = self.densities(&file.imu)? {
            notes.append(&mut noise.findings);
            file.noise = Some(noise);
        }
        if self.rostopic.is_some() || self.update_rate_hz.is_some() {
            let given = ImuNoise {
                rostopic: self.rostopic.clone(),
                update_rate_hz: self.update_rate_hz,
                ..ImuNoise::default()
            };
            file.noise = Some(given.or(file.noise.take().unwrap_or_default()));
        }
        if let Some(path) = &self.after {
            let first = read_calibrated_imu(path, &ConventionOptions::default())?;
            let of_first = |finding: Diagnostic| finding.in_file(path.display().to_string());
            notes.extend(first.findings.into_iter().map(of_first));
            let whole =
                self.sensor.map_or_else(|| file.imu.clone(), |sensor_kind| file.imu.only(sensor_kind));
            file.imu = whole.after(&first.imu)?;
        }
        let whole = self.in_frame(&file.imu)?;
        let is_felt = !self.drop.contains(&ImuPart::GSensitivity);
        if self.sensor == Some(SensorKind::Gyroscope)
            && is_felt
            && ImuPart::GSensitivity.is_of(SensorKind::Gyroscope, &whole)
        {
            return self.refuse(
                "the gyroscope's g-sensitivity takes the accelerometer's readings, and the correction would be another without them",
                "leave it out on purpose with option `drop` g-sensitivity",
            );
        }
        file.imu = self.drop.iter().fold(whole.clone(), |imu, part| imu.without(*part));
        if self.drop.contains(&ImuPart::GyroscopeMatrix)
            && whole.unit(SensorKind::Gyroscope) == Some(ReadingUnit::Counts)
        {
            return self.refuse(
                "the readings of the gyroscope are counts, and have no rate without its gain",
                "keep gyroscope-matrix in option `drop` away",
            );
        }
        match self.temperature_c {
            Some(temperature_c) if file.imu.follows_temperature() => {
                notes.push(TemperatureFixed { temperature_c }.into());
                let thermal = &file.imu.parameters.thermal;
                let beyond = CalibrationExtrapolated::of(thermal, [temperature_c; 2]);
                notes.extend(beyond.into_iter().map(Diagnostic::from));
                file.imu = file.imu.at(temperature_c)?;
            }
            Some(_) => {
                let why = "this calibration has no temperature terms";
                notes.push(SettingUnused::of(&["option `temperature`"], why).into());
            }
            None => {}
        }
        notes.extend(self.omitted(&whole, &file.imu));
        Ok(notes)
    }

    /// The sensors that are written, in the frame in which they are written.
    fn in_frame(&self, imu: &CalibratedImu) -> Result<CalibratedImu> {
        let imu = match self.sensor {
            Some(sensor_kind) if imu.unit(sensor_kind).is_none() => {
                return self.refuse(
                    &format!("the calibration has no {sensor_kind}"),
                    "choose the other with option `sensor`, or leave it away",
                );
            }
            Some(sensor_kind) => imu.only(sensor_kind),
            None => imu.clone(),
        };
        self.gauge.map_or(Ok(imu.clone()), |gauge| imu.in_gauge(gauge))
    }

    /// What is left out of each sensor, with the error that this makes.
    fn omitted(&self, before: &CalibratedImu, after: &CalibratedImu) -> Vec<Diagnostic> {
        let of = |sensor_kind: SensorKind| {
            let error = before.parameters.omission_error(&after.parameters, sensor_kind);
            let mut parts = self.drop.clone();
            parts.dedup();
            parts.retain(|part| part.is_of(sensor_kind, before));
            let mut parts: Vec<_> = parts.into_iter().map(|part| part.title().to_owned()).collect();
            if before.follows_temperature() && !after.follows_temperature() {
                parts.push("what temperature does".into());
            }
            (error.largest > 0.0 && !parts.is_empty()).then(|| {
                let over = Phrase(error.over);
                PartsOmitted { sensor_kind, parts, largest_error: error.largest, over }.into()
            })
        };
        before.units.present().filter_map(|(sensor_kind, _)| of(sensor_kind)).collect()
    }

    /// The noise densities of all files.
    fn densities(&self, imu: &CalibratedImu) -> Result<Option<ImuNoise>> {
        let mut all: Option<ImuNoise> = None;
        for path in &self.noise {
            let is_ours = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
            let noise = if is_ours { read_measured_noise(path, imu)? } else { read_kalibr_noise(path)? };
            all = Some(match all {
                Some(before) => before.or(noise),
                None => noise,
            });
        }
        Ok(all)
    }

    fn refuse<T>(&self, message: &str, help: &str) -> Result<T> {
        let mut input_error = InputError::new(Refusal::SensorMissing, message, help);
        input_error.file = self.path.clone();
        Err(Error::experiment(input_error))
    }
}
