//! What is changed of a calibration before it is written in another format.

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::correction::{GSensitivityOmitted, TemperatureFixed};
use calibrant_core::diagnostic::samples::CalibrationExtrapolated;
use calibrant_core::diagnostic::settings::SettingUnused;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{CalibratedImu, Gauge, SensorKind};
use calibrant_io::{CalibratedImuFile, ImuNoise, read_kalibr_noise, read_measured_noise};
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
    /// Files with noise densities: `noise.json`, or an `imu.yaml` of Kalibr. A file adds what the earlier ones lack.
    pub noise: Vec<PathBuf>,
    /// Is the gyroscope's g-sensitivity left out? This changes the correction.
    pub drop_g_sensitivity: bool,
    /// The sensor that is written alone.
    pub sensor: Option<SensorKind>,
    /// The temperature at which the terms of temperature are evaluated, °C.
    pub temperature_c: Option<f64>,
    /// The gauge of the accelerometer into which the true frame of both sensors is turned.
    pub gauge: Option<Gauge>,
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
        if self.drop_g_sensitivity {
            notes.extend(g_sensitivity_omitted(&file.imu).map(Diagnostic::from));
            file.imu = file.imu.without_g_sensitivity();
        }
        if let Some(sensor_kind) = self.sensor {
            file.imu = self.only(&file.imu, sensor_kind)?;
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
        if let Some(gauge) = self.gauge {
            file.imu = file.imu.in_gauge(gauge)?;
        }
        Ok(notes)
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

    /// One sensor of the calibration alone.
    fn only(&self, imu: &CalibratedImu, sensor_kind: SensorKind) -> Result<CalibratedImu> {
        let refuse = |message: &str, help: &str| {
            let mut input_error = InputError::new(Refusal::SensorMissing, message, help);
            input_error.file = self.path.clone();
            Err(Error::experiment(input_error))
        };
        if imu.unit(sensor_kind).is_none() {
            return refuse(
                &format!("the calibration has no {sensor_kind}"),
                "choose the other with option `sensor`, or leave it away",
            );
        }
        let feels = imu.parameters.g_sensitivity.iter().any(|&entry| entry != 0.0);
        if sensor_kind == SensorKind::Gyroscope && feels {
            return refuse(
                "the gyroscope's g-sensitivity takes the accelerometer's readings, and the correction would be another without them",
                "leave it out on purpose with option `drop_g_sensitivity`",
            );
        }
        Ok(imu.only(sensor_kind))
    }
}

/// How large the error is without the g-sensitivity, where there is one.
fn g_sensitivity_omitted(imu: &CalibratedImu) -> Option<GSensitivityOmitted> {
    let largest = imu.parameters.g_sensitivity.row_iter().map(|row| row.norm()).fold(0.0, f64::max);
    let unit = imu.unit(SensorKind::Gyroscope).map_or("", |unit| unit.symbol());
    (largest > 0.0).then_some(GSensitivityOmitted { error: 9.80665 * largest, unit })
}
