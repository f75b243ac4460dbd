//! The result of a calibration study: truth beside estimate of many sensors.

use calibrant_core::estimate::Calibration;
use calibrant_core::json_object;
use calibrant_core::motion::{JerkControlledMotion, MotionTable};
use calibrant_core::sensor::{ImuParameters, Parameter, Recording, Sensor, SensorParameters};
use schemars::JsonSchema;
use serde::Serialize;

/// A population of simulated sensors, truth beside estimate. Each is calibrated from its own recording of the
/// same commanded motion.
#[derive(Debug, Clone)]
pub struct Study {
    /// The datasheet from which the sensors were drawn.
    pub sensor: Sensor,
    /// Name, unit, nominal value and spread of each parameter.
    pub parameters: Vec<Parameter>,
    /// How far the motion was trusted: `known`, `noisy`, `unknown`.
    pub trust: &'static str,
    /// Seed of everything random.
    pub seed: u64,
    /// Sample rate of the population's recordings, Hz.
    pub rate_hz: f64,
    /// The commanded motion.
    pub motion: JerkControlledMotion,
    /// One entry for each sensor.
    pub outcomes: Vec<SensorOutcome>,
    /// Summary over the sensors, one entry for each parameter.
    pub summary: Vec<ParameterSummary>,
    /// One sensor in detail at the population's rate (the thesis's Figure 4).
    pub single: SingleCase,
    /// One sensor in detail at a higher rate (the thesis's Figure 5).
    pub fine: SingleCase,
}

json_object! {
    /// A population of simulated sensors, truth beside estimate.
    Study as of {
        seed: of.seed,
        trust: of.trust,
        rate_hz: of.rate_hz,
        reading_unit: of.sensor.unit.symbol(),
        /// The order of all lists of values.
        parameters: &of.parameters,
        /// As commanded.
        motion: MotionTable { motion: &of.motion, axes: of.sensor.axes, acceleration_sd_mps2: None },
        /// Of each parameter.
        summary: &of.summary,
        sensors: &of.outcomes,
        /// One sensor in detail.
        single: &of.single,
        /// The same at a higher rate.
        fine: &of.fine,
    }
}

json_object! {
    /// One simulated sensor and its calibration, without its samples.
    SingleCase as of {
        rate_hz: of.recording.rate_hz(),
        samples: of.recording.len(),
        /// True values of the parameters.
        truth: of.true_values(),
        /// What the arm did: the command with process noise.
        true_motion: MotionTable {
            motion: &of.true_motion,
            axes: of.calibration.axes(),
            acceleration_sd_mps2: None,
        },
        calibration: &of.calibration,
    }
}

impl SingleCase {
    /// True values of the parameters, in the order of the calibration.
    fn true_values(&self) -> Vec<f64> {
        let imu = ImuParameters { accelerometer: self.truth, ..ImuParameters::identity() };
        self.calibration.quantities.iter().map(|quantity| quantity.value(&imu)).collect()
    }
}

/// Truth and estimate of one sensor.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SensorOutcome {
    /// True values of the parameters.
    pub truth: Vec<f64>,
    /// Estimates.
    #[serde(rename = "value")]
    pub values: Vec<f64>,
    /// Their standard deviations, as the calibration states them.
    pub sd: Vec<f64>,
    /// p-value of the fit.
    pub p_value: Option<f64>,
    /// How the calibration ended: a [`CalibrationStatus`](calibrant_core::estimate::CalibrationStatus) name.
    pub status: &'static str,
}

/// The result of the population for one parameter.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ParameterSummary {
    /// Name of the parameter.
    pub name: String,
    /// Unit.
    pub unit: &'static str,
    /// Standard deviation that the calibrations state: root mean square over the sensors.
    pub predicted_sd: f64,
    /// Root mean square of estimate less truth.
    pub realised_rms: f64,
    /// Mean of estimate less truth.
    pub mean_error: f64,
    /// Fraction of sensors whose 95 % interval contains the truth.
    pub coverage_95: f64,
}

/// One simulated sensor, its recording and its calibration.
#[derive(Debug, Clone)]
pub struct SingleCase {
    /// True parameters.
    pub truth: SensorParameters,
    /// The motion that really happened (the command plus process noise).
    pub true_motion: JerkControlledMotion,
    /// The recording.
    pub recording: Recording,
    /// The calibration from it.
    pub calibration: Calibration,
}
