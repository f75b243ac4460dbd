//! The correction of an IMU, raw → true, and its uncertainty. It applies a calibration and estimates nothing.
//!
//! `f = C_a (y_a − b_a)`, `ω = C_g (y_g − b_g − Γ f)` with `C = S⁻¹`. An error of the parameters moves a
//! corrected reading by `df = −C_a (db_a + dS_a f)` and `dω = −C_g (db_g + dS_g ω + dΓ f + Γ df)`. The
//! covariance of the parameters gives that of the correction. It does not contain the noise of the reading.
//! Where biases and gains follow temperature, all of this is at the temperature of each sample. A response that is bent has the slope at the
//! corrected reading in place of `S`.

use super::entry_vector::{self, ENTRIES, EntryMatrix};
use super::{
    Axis, CalibratedImu, CorrectedRecording, CorrectedSensor, Correction, HIGHEST_ORDER, ImuParameters,
    ImuQuantity, ImuRecording, NonlinearTerm, Quantity, ReadingUnit, Recording, SensorKind, Temperatures,
    ThermalPart, interpolated, times,
};
use crate::error::{Error, InputError, Refusal, Result, TaskOption};
use nalgebra::{Matrix3, SMatrix, Vector3};
use std::ptr;
use std::sync::Arc;

/// The correction of an IMU: `f = C_a (y_a − b_a)`, `ω = C_g (y_g − b_g − Γ f)`.
///
/// # Examples
/// ```
/// use calibrant_core::sensor::{CalibratedImu, ImuCorrection, ImuParameters, ReadingUnit, SensorKind};
/// use nalgebra::Vector3;
/// let mut parameters = ImuParameters::identity();
/// parameters[SensorKind::Accelerometer].bias = Vector3::new(0.1, 0.0, 0.0);
/// let imu = CalibratedImu::new(parameters, [Some(ReadingUnit::MetrePerSecondSquared), None], vec![], "");
/// let correction = ImuCorrection::of(&imu)?;
/// let force = correction.force(&Vector3::new(0.3, 0.0, 9.8)).expect("has an accelerometer");
/// assert!((force.x - 0.2).abs() < 1e-15);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ImuCorrection {
    /// Correction of the accelerometer, where there is one.
    pub accelerometer: Option<Correction>,
    /// Correction of the gyroscope without the g-sensitivity, where there is one.
    pub gyroscope: Option<Correction>,
    /// `Γ`, in the unit of the gyroscope's readings per m/s².
    pub g_sensitivity: Matrix3<f64>,
    /// Units of the readings of accelerometer and gyroscope.
    units: [Option<ReadingUnit>; 2],
    imu: ImuParameters,
    temperature_c: f64,
    covariance: Option<Arc<EntryMatrix>>,
    known: [bool; 2],
}

impl ImuCorrection {
    /// The correction of a calibrated IMU.
    ///
    /// # Errors
    /// [`Error::Experiment`] where a matrix has no inverse, or the g-sensitivity lacks an accelerometer.
    pub fn of(imu: &CalibratedImu) -> Result<Self> {
        let of = |sensor_kind: SensorKind| match imu.unit(sensor_kind) {
            None => Ok(None),
            Some(_) => match Correction::of(imu.parameters.sensor(sensor_kind)) {
                Some(correction) if correction.matrix.iter().all(|entry| entry.is_finite()) => {
                    Ok(Some(correction))
                }
                _ => Err(Error::experiment(InputError::new(
                    Refusal::CalibrationUnusable,
                    format!("the matrix S of the {sensor_kind} is singular, so that it reports nothing"),
                    "calibrate again",
                ))),
            },
        };
        let (accelerometer, gyroscope) = (of(SensorKind::Accelerometer)?, of(SensorKind::Gyroscope)?);
        let g_sensitivity = if gyroscope.is_some() { imu.parameters.g_sensitivity } else { Matrix3::zeros() };
        if g_sensitivity != Matrix3::zeros() && accelerometer.is_none() {
            let message = "the gyroscope's g-sensitivity cannot be corrected without an accelerometer";
            let help = "convert the whole IMU, or set the g-sensitivity to zero";
            return Err(Error::experiment(InputError::new(Refusal::ConversionImpossible, message, help)));
        }
        let covariance = entry_vector::covariance(imu).map(Arc::new);
        let known = SensorKind::ALL.map(|sensor_kind| {
            covariance.is_some()
                && imu
                    .quantities
                    .iter()
                    .any(|quantity| matches!(quantity, ImuQuantity::Of(of, _) | ImuQuantity::Thermal(of, _) if *of == sensor_kind))
        });
        let temperature_c = imu.parameters.thermal.reference_c;
        Ok(Self {
            accelerometer,
            gyroscope,
            g_sensitivity,
            units: SensorKind::ALL.map(|sensor_kind| imu.unit(sensor_kind)),
            imu: imu.parameters,
            temperature_c,
            covariance,
            known,
        })
    }

    /// The correction at a temperature, °C; [`of`](Self::of) gives that at the reference.
    ///
    /// # Errors
    /// [`Error::Recording`] where the polynomial of a gain is not positive there.
    pub fn at(&self, temperature_c: f64) -> Result<Self> {
        let mut there = self.clone();
        there.move_to(temperature_c)?;
        Ok(there)
    }

    /// Makes it that at a temperature, °C.
    fn move_to(&mut self, temperature_c: f64) -> Result<()> {
        self.temperature_c = temperature_c;
        if self.imu.thermal.is_none() {
            return Ok(());
        }
        let imu = &self.imu;
        let tau_k = imu.thermal.tau_k(temperature_c);
        let of = |sensor_kind: SensorKind| match imu.thermal.sensor(sensor_kind).gain_factor(tau_k).min()
            > 0.0
        {
            true => Ok(Correction::of(&imu.sensor_at(sensor_kind, temperature_c))),
            false => Err(Error::recording(InputError::new(
                Refusal::CalibrationUnsuited,
                format!("at {temperature_c} °C the polynomial of the {sensor_kind}'s gain is not positive"),
                "this is too far from the temperatures of the calibration",
            ))),
        };
        self.accelerometer = self.accelerometer.map_or(Ok(None), |_| of(SensorKind::Accelerometer))?;
        self.gyroscope = self.gyroscope.map_or(Ok(None), |_| of(SensorKind::Gyroscope))?;
        Ok(())
    }

    /// Does the correction depend on temperature, in its values or in their covariance?
    #[must_use]
    pub fn follows_temperature(&self) -> bool {
        !self.imu.thermal.is_none() || self.covers(entry_vector::AT_REFERENCE..entry_vector::LINEAR)
    }

    /// Does a term bend the accelerometer's response, in its value or in the covariance?
    fn is_bent(&self) -> bool {
        !self.imu[SensorKind::Accelerometer].nonlinearity.is_none()
            || self.covers(entry_vector::LINEAR..ENTRIES)
    }

    /// `∂f/∂y` of the accelerometer at a corrected force.
    fn force_by_reading(&self, correction: &Correction, force: &Vector3<f64>) -> Matrix3<f64> {
        match correction.nonlinearity.is_none() {
            true => correction.matrix,
            false => {
                correction.by_reading(&self.imu.at(self.temperature_c)[SensorKind::Accelerometer], force)
            }
        }
    }

    /// Corrected specific force, m/s²; `None` without an accelerometer.
    #[must_use]
    pub fn force(&self, reading: &Vector3<f64>) -> Option<Vector3<f64>> {
        self.accelerometer.as_ref().map(|correction| correction.apply(reading))
    }

    /// Corrected angular rate, rad/s, at this (corrected) specific force; `None` without a gyroscope.
    #[must_use]
    pub fn rate(&self, reading: &Vector3<f64>, force: &Vector3<f64>) -> Option<Vector3<f64>> {
        self.gyroscope
            .as_ref()
            .map(|correction| correction.apply(&(reading - times(&self.g_sensitivity, force))))
    }

    /// Standard uncertainty of the corrected force, m/s² per axis; `None` where it is not known.
    #[must_use]
    pub fn force_sd(&self, force: &Vector3<f64>) -> Option<Vector3<f64>> {
        let (correction, covariance) = (self.accelerometer?, self.covariance.as_deref()?);
        let of_reading = if self.follows_temperature() || self.is_bent() {
            let errors = self.all_errors(SensorKind::Accelerometer, force);
            errors * covariance * errors.transpose()
        } else {
            let errors = own_errors(force, &Vector3::repeat(1.0));
            errors * covariance.fixed_view::<12, 12>(0, 0) * errors.transpose()
        };
        let by_reading = self.force_by_reading(&correction, force);
        let variance = by_reading * of_reading * by_reading.transpose();
        self.known[0].then(|| variance.diagonal().map(sqrt))
    }

    /// Standard uncertainty of the corrected rate at this force, rad/s per axis; `None` where it is not known.
    #[must_use]
    pub fn rate_sd(&self, rate: &Vector3<f64>, force: &Vector3<f64>) -> Option<Vector3<f64>> {
        let (correction, covariance) = (self.gyroscope?, self.covariance.as_deref()?);
        let felt = self.g_sensitivity != Matrix3::zeros() || self.covers_g_sensitivity();
        let of_reading = if !felt && !self.follows_temperature() {
            let own = own_errors(rate, &Vector3::repeat(1.0));
            own * covariance.fixed_view::<12, 12>(12, 12) * own.transpose()
        } else {
            let mut errors = self.all_errors(SensorKind::Gyroscope, rate);
            if let Some(accelerometer) = self.accelerometer {
                errors -= self.g_sensitivity
                    * self.force_by_reading(&accelerometer, force)
                    * self.all_errors(SensorKind::Accelerometer, force);
            }
            for row in 0..3 {
                for column in 0..3 {
                    errors[(row, entry_vector::g_sensitivity(row, column))] = force[column];
                }
            }
            if self.follows_temperature() || self.is_bent() {
                errors * covariance * errors.transpose()
            } else {
                const N: usize = entry_vector::AT_REFERENCE; // entries without temperature terms
                let errors = errors.fixed_view::<3, N>(0, 0);
                errors * covariance.fixed_view::<N, N>(0, 0) * errors.transpose()
            }
        };
        let variance = correction.matrix * of_reading * correction.matrix.transpose();
        self.known[1].then(|| variance.diagonal().map(sqrt))
    }

    /// Derivative of a sensor's reading with respect to all entries but the g-sensitivity, at a stimulus and the temperature of this correction.
    fn all_errors(&self, sensor_kind: SensorKind, stimulus: &Vector3<f64>) -> SMatrix<f64, 3, ENTRIES> {
        let thermal = &self.imu.thermal;
        let tau_k = thermal.tau_k(self.temperature_c);
        let factor = thermal.sensor(sensor_kind).gain_factor(tau_k);
        let sensor = self.imu.sensor(sensor_kind);
        let mut errors = SMatrix::<f64, 3, ENTRIES>::zeros();
        errors
            .fixed_columns_mut::<12>(entry_vector::bias(sensor_kind, 0))
            .copy_from(&own_errors(stimulus, &factor));
        if sensor_kind == SensorKind::Accelerometer && self.is_bent() {
            for (row, axis) in Axis::ALL.into_iter().enumerate() {
                let of = |quantity: Quantity| factor[row] * quantity.derivative(sensor, stimulus)[row];
                for (column, other) in Axis::ALL.into_iter().enumerate() {
                    errors[(row, entry_vector::matrix(sensor_kind, row, column))] =
                        of(Quantity::CrossAxis(axis, other));
                }
                for term in NonlinearTerm::ALL {
                    errors[(row, entry_vector::nonlinear(term, row))] = of(Quantity::Nonlinear(term, axis));
                }
            }
        }
        for row in 0..3 {
            let mut power = 1.0;
            for order in 1..=HIGHEST_ORDER {
                power *= tau_k;
                errors[(row, entry_vector::thermal(sensor_kind, ThermalPart::Bias, order, row))] = power;
                errors[(row, entry_vector::thermal(sensor_kind, ThermalPart::Scale, order, row))] =
                    power * sensor.response(row, stimulus);
            }
        }
        errors
    }

    fn covers_g_sensitivity(&self) -> bool {
        self.covers(entry_vector::g_sensitivity(0, 0)..entry_vector::AT_REFERENCE)
    }

    /// Does the covariance contain any of these entries?
    fn covers(&self, mut entries: std::ops::Range<usize>) -> bool {
        self.covariance.as_ref().is_some_and(|sigma| entries.any(|k| sigma[(k, k)] > 0.0))
    }

    /// A corrected recording: every sensor that the calibration and the recording both have.
    ///
    /// Where the sensors' times differ, the specific force at a sample of the gyroscope is interpolated.
    /// Where the accelerometer has no sample nearby, the nearest is taken, or the line across a gap.
    ///
    /// # Errors
    /// [`Error::Recording`] where the readings are in another unit than the calibration's. Also where the
    /// recording lacks the accelerometer or the temperature that the correction needs.
    pub fn apply<'a>(&self, recording: &'a ImuRecording) -> Result<CorrectedRecording<'a>> {
        self.apply_feeling(recording, recording[SensorKind::Accelerometer].as_ref())
    }

    /// The same with the accelerometer's readings `felt` without spikes ([`Recording::without_spikes`]).
    ///
    /// # Errors
    /// As [`apply`](Self::apply).
    pub fn apply_feeling<'a>(
        &self,
        recording: &'a ImuRecording,
        felt: Option<&Recording>,
    ) -> Result<CorrectedRecording<'a>> {
        for (sensor_kind, unit) in SensorKind::ALL.into_iter().zip(self.units) {
            if let (Some(unit), Some(readings)) = (unit, recording.sensor(sensor_kind))
                && unit != readings.unit
            {
                return Err(Error::recording(InputError::new(
                    Refusal::CalibrationUnsuited,
                    format!(
                        "the readings of the {sensor_kind} are in {}, the calibration is of readings in {}",
                        readings.unit.symbol(),
                        unit.symbol()
                    ),
                    "give the recording that is in the calibration's unit, or say its unit with option `unit`",
                )));
            }
        }
        let temperatures = if self.follows_temperature() {
            Some(Temperatures::of(recording)?.ok_or_else(|| {
                Error::recording(InputError::new(Refusal::TemperatureMissing,
                    "the calibration follows temperature, and this recording has no temperature",
                    "say the temperature with option `temperature` CELSIUS, or, where a column of the recording has it, which one with option `columns` EXPERIMENT",
                )
                .answered_by(TaskOption::Temperature, [])
                .answered_by(TaskOption::Columns, []))
            })?)
        } else {
            None
        };
        let temperatures = temperatures.as_ref();
        let accelerometer =
            recording[SensorKind::Accelerometer].as_ref().filter(|_| self.accelerometer.is_some());
        let accelerometer =
            accelerometer.map(|readings| self.correct_forces(readings, temperatures)).transpose()?;
        let gyroscope = match recording[SensorKind::Gyroscope].as_ref().filter(|_| self.gyroscope.is_some()) {
            None => None,
            Some(readings) => {
                let needed = self.g_sensitivity != Matrix3::zeros() || self.covers_g_sensitivity();
                if needed && accelerometer.is_none() {
                    let message = "the gyroscope's g-sensitivity is corrected with the specific force, and this recording has no accelerometer";
                    let help = "give the recording of both sensors";
                    return Err(Error::recording(InputError::new(Refusal::SensorMissing, message, help)));
                }
                let felt = felt.filter(|_| needed);
                let same = |felt: &&Recording| {
                    !recording[SensorKind::Accelerometer].as_ref().is_some_and(|of| ptr::eq(of, *felt))
                };
                let other =
                    felt.filter(same).map(|felt| self.correct_forces(felt, temperatures)).transpose()?;
                let forces = other.as_ref().or(accelerometer.as_ref());
                Some(self.correct_rates(readings, forces, temperatures)?)
            }
        };
        Ok(CorrectedRecording { accelerometer, gyroscope })
    }

    fn correct_forces<'a>(
        &self,
        readings: &'a Recording,
        temperatures: Option<&Temperatures<'_>>,
    ) -> Result<CorrectedSensor<'a>> {
        self.corrected(readings, temperatures, |here, k| {
            let force = here.force(&readings.readings[k])?;
            Some((force, here.force_sd(&force)))
        })
    }

    fn correct_rates<'a>(
        &self,
        readings: &'a Recording,
        forces: Option<&CorrectedSensor<'_>>,
        temperatures: Option<&Temperatures<'_>>,
    ) -> Result<CorrectedSensor<'a>> {
        let force_at = |k: usize| match forces {
            None => Vector3::zeros(),
            Some(forces) => interpolated(forces.times_s, |k| forces.values[k], readings.times_s[k], k)
                .unwrap_or_else(Vector3::zeros),
        };
        self.corrected(readings, temperatures, |here, k| {
            let force = force_at(k);
            let rate = here.rate(&readings.readings[k], &force)?;
            Some((rate, here.rate_sd(&rate, &force)))
        })
    }

    /// Each sample with the correction at its temperature.
    fn corrected<'a>(
        &self,
        readings: &'a Recording,
        temperatures: Option<&Temperatures<'_>>,
        correct: impl Fn(&Self, usize) -> Option<(Vector3<f64>, Option<Vector3<f64>>)>,
    ) -> Result<CorrectedSensor<'a>> {
        let mut values = Vec::with_capacity(readings.len());
        let mut sd = Some(Vec::new());
        let mut here = self.clone();
        for k in 0..readings.readings.len() {
            if let Some(temperatures) = temperatures {
                here.move_to(temperatures.near(readings.times_s[k], k))?;
            }
            if let Some((value, uncertainty)) = correct(&here, k) {
                values.push(value);
                sd = sd.zip(uncertainty).map(|(mut sd, uncertainty)| {
                    sd.push(uncertainty);
                    sd
                });
            }
        }
        Ok(CorrectedSensor { times_s: &readings.times_s, values, sd })
    }
}

/// Derivative of a reading with respect to bias and matrix of its sensor (12 entries), at a stimulus and a factor on each gain.
fn own_errors(stimulus: &Vector3<f64>, gain_factor: &Vector3<f64>) -> SMatrix<f64, 3, 12> {
    // the entries of either sensor have these places, less the sensor's first
    let own = SensorKind::Accelerometer;
    let mut errors = SMatrix::zeros();
    for row in 0..3 {
        errors[(row, entry_vector::bias(own, row))] = 1.0;
        for column in 0..3 {
            errors[(row, entry_vector::matrix(own, row, column))] = gain_factor[row] * stimulus[column];
        }
    }
    errors
}

/// Square root of a variance, which rounding may have made negative. NaN where the variance overflowed.
fn sqrt(variance: f64) -> f64 {
    if variance.is_nan() { f64::INFINITY } else { variance.max(0.0).sqrt() }
}

#[cfg(test)]
mod tests;
