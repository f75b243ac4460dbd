//! Tries what several recordings together tell of a sensor on another recording of it.

use super::caveats_of_calibration::Caveats;
use super::inputs::with_gyroscope;
use super::prediction::{Prediction, inverse_duration};
use super::prediction_errors::Unused;
use super::result::Validation;
use super::statistics::Degrees;
use super::validate::on_another;
use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::imu::{GyroscopeAtRest, TurnsInHolds, needed_temperatures, recordings};
use crate::estimate::{CalibrationProblem, Gyroscope, ImuProblem, ImuSetup, Stimulus};
use crate::motion::Hold;
use crate::sensor::{CalibratedImu, ImuRecording, Recording, Sensor, SensorKind};
use nalgebra::{DMatrix, Vector3};

/// How the holds of a sensor scatter beyond their noise.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct HoldScatter {
    /// Of the accelerometer's means, m/s².
    pub between_holds_sd_mps2: f64,
    /// Of the gyroscope's means, in the unit of its readings.
    pub gyroscope_between_holds_sd: Vector3<f64>,
    /// Of rotations from hold to hold, rad.
    pub between_rotations_sd_rad: f64,
    /// Degrees of freedom behind them.
    pub degrees: f64,
}

impl HoldScatter {
    /// That of several recordings: root mean squares, weighted by degrees of freedom.
    #[must_use]
    pub fn pooled<'a>(of: impl IntoIterator<Item = &'a Self> + Clone) -> Self {
        let weight = |one: &Self| one.degrees.max(1.0);
        let all: f64 = of.clone().into_iter().map(weight).sum();
        let rms = |part: &dyn Fn(&Self) -> f64| {
            let squares = of.clone().into_iter().map(|one| weight(one) * part(one).powi(2));
            (squares.sum::<f64>() / all.max(1.0)).sqrt()
        };
        Self {
            between_holds_sd_mps2: rms(&|of| of.between_holds_sd_mps2),
            gyroscope_between_holds_sd: Vector3::from_fn(|axis, _| {
                rms(&|of| of.gyroscope_between_holds_sd[axis])
            }),
            between_rotations_sd_rad: rms(&|of| of.between_rotations_sd_rad),
            degrees: of.into_iter().map(|of| of.degrees).sum(),
        }
    }
}

/// A recording that was not used, and what is known of it.
#[derive(Debug, Clone, Copy)]
pub struct HeldOutRecording<'a> {
    /// The accelerometer's datasheet.
    pub accelerometer: &'a Sensor,
    /// The gyroscope's, of an IMU.
    pub gyroscope: Option<&'a Gyroscope>,
    /// The samples.
    pub recording: &'a ImuRecording,
    /// Its holds, and where it was made.
    pub setup: &'a ImuSetup,
}

impl<'a> HeldOutRecording<'a> {
    /// The readings of its sensors, checked.
    fn sensors(&self) -> Result<(&'a Recording, Option<&'a Recording>)> {
        let Self { accelerometer: sensor, gyroscope, recording, setup } = *self;
        if let Some(gyroscope) = gyroscope {
            let problem = ImuProblem { accelerometer: sensor, gyroscope, recording, setup };
            return recordings(&problem).map(|(accelerometer, gyroscope)| (accelerometer, Some(gyroscope)));
        }
        let alone = recording[SensorKind::Accelerometer].as_ref().ok_or_else(|| {
            let message = "the recording has no accelerometer";
            Error::recording(InputError::new(Refusal::SensorMissing, message, "choose another file"))
        })?;
        CalibrationProblem { sensor, recording: alone, stimulus: Stimulus::Holds(&setup.holds) }
            .validate()?;
        Ok((alone, None))
    }
}

/// Tries a sensor over temperature on holds of a recording that was not used for it. Its covariance contains all that another recording may differ by; the noise is that of
/// the recording.
///
/// # Errors
/// [`Error::Recording`](crate::Error::Recording) where the recording lacks a sensor or its temperature, or is not one of this sensor.
pub fn validate_over_temperature(
    imu: &CalibratedImu,
    scatter: &HoldScatter,
    of: &HeldOutRecording<'_>,
    holds: &[Hold],
) -> Result<Validation> {
    let (accelerometer, gyroscope) = of.sensors()?;
    let temperatures = needed_temperatures(of.recording)?;
    gyroscope.map_or(Ok(()), |gyroscope| with_gyroscope(holds, gyroscope))?;
    let unused = Unused {
        gyroscope,
        temperatures: Some(temperatures),
        ..Unused::of_accelerometer(accelerometer, holds)
    };
    let these: Vec<&Hold> = unused.holds.iter().map(|(_, hold)| *hold).collect();
    let mut still = Vector3::zeros();
    if let Some(gyroscope) = gyroscope {
        let keep = |found: &Vector3<f64>| {
            still = *found;
            still
        };
        GyroscopeAtRest::of(gyroscope, &these, |_| false, keep);
    }
    let size = imu.quantities.len();
    let degrees = Degrees { of_scatter: scatter.degrees, unknowns: 0.0, share: None };
    let prediction = Prediction {
        imu: imu.parameters,
        quantities: imu.quantities.clone(),
        covariance: imu.covariance.clone().unwrap_or_else(|| DMatrix::zeros(size, size)),
        gravity_mps2: of.setup.holds.gravity.magnitude_mps2,
        vertical_rate: of.setup.vertical_rate(),
        north_sd_radps: of.setup.north_sd(),
        between_holds_sd_mps2: scatter.between_holds_sd_mps2,
        holds_degrees: degrees,
        within: unused.within,
        still_noise: still,
        still_within: still,
        still_sd: scatter.gyroscope_between_holds_sd,
        still_degrees: [degrees; 3],
        inverse_hold_s: inverse_duration(these.iter().copied()),
        rotation_sd_rad: scatter.between_rotations_sd_rad,
        knock_rms: 0.0,
        turns_in_holds: TurnsInHolds::default(),
        rotation_degrees: degrees,
        of_steps: Vector3::zeros(),
    };
    // the noise is this recording's own, and says nothing beside itself
    on_another(&prediction, unused, &Caveats::default())
        .map(|validation| Validation { noise: Vec::new(), ..validation })
}
