//! The result of a calibration study: truth beside estimate of many sensors.

use calibrant_core::estimate::Calibration;
use calibrant_core::motion::JerkControlledMotion;
use calibrant_core::sensor::{Parameter, Recording, Sensor, SensorParameters};

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

/// Truth and estimate of one sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorOutcome {
    /// True values of the parameters.
    pub truth: Vec<f64>,
    /// Estimates.
    pub values: Vec<f64>,
    /// Their standard deviations, as the calibration states them.
    pub sd: Vec<f64>,
    /// p-value of the fit.
    pub p_value: Option<f64>,
    /// How the calibration ended: a [`CalibrationStatus`](calibrant_core::estimate::CalibrationStatus) name.
    pub status: &'static str,
}

/// The result of the population for one parameter.
#[derive(Debug, Clone, PartialEq)]
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
