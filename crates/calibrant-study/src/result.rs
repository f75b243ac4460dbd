//! The result of a calibration study: truth beside estimate of many sensors, and what a designed motion improves.

use calibrant_core::estimate::Calibration;
use calibrant_core::information::Criterion;
use calibrant_core::json::if_some;
use calibrant_core::json_object;
use calibrant_core::motion::{JerkControlledMotion, KnownEnds, Limits, MotionTable, Trust};
use calibrant_core::sensor::{ImuParameters, Parameter, Recording, Sensor, SensorKind, SensorParameters};
use calibrant_design::{Design, DesignStatus};
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
        let imu = ImuParameters::identity().with(SensorKind::Accelerometer, self.truth);
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

/// Sensors that went round the thesis's loop (Figure 2). Each was calibrated on a random motion, then again
/// on the best motion, designed at the estimate.
#[derive(Debug, Clone)]
pub struct DesignStudy {
    /// The datasheet from which the sensors were drawn.
    pub sensor: Sensor,
    /// Name, unit, nominal value and spread of each parameter.
    pub parameters: Vec<Parameter>,
    /// Number of intervals of the motions designed.
    pub intervals: usize,
    /// Their duration, s.
    pub interval_s: f64,
    /// Sample rate, Hz.
    pub rate_hz: f64,
    /// How far the motion was trusted.
    pub trust: Trust,
    /// Which ends of it were known.
    pub known_ends: KnownEnds,
    /// The limits of the motion, the sensor's range among them.
    pub limits: Limits,
    /// The criterion that the designs minimised.
    pub criterion: Criterion,
    /// Was the datasheet a prior of every calibration?
    pub datasheet_prior: bool,
    /// Was the initial motion given, one for all sensors? Otherwise each sensor had a random one of its own.
    pub initial_given: bool,
    /// Starts of each design.
    pub starts: usize,
    /// Seed of everything random.
    pub seed: u64,
    /// One entry for each sensor.
    pub outcomes: Vec<DesignOutcome>,
    /// Number of the first sensors whose optimal motions are shown together (the thesis's Figure 9). At most
    /// the number of outcomes.
    pub motions_shown: usize,
    /// The whole design of the first sensor (the thesis's Figure 8).
    pub design: Design,
    /// Summary over the sensors, one entry for each parameter.
    pub summary: Vec<Improvement>,
    /// The traces of the covariances over the sensors.
    pub trace: TraceSummary,
}

json_object! {
    /// Sensors that were calibrated on an initial motion, then on the best motion at that estimate.
    DesignStudy as of {
        seed: of.seed,
        trust: of.trust,
        known_ends: of.known_ends,
        input_noise: if_some(of.trust.input_noise()),
        intervals: of.intervals,
        interval_s: of.interval_s,
        rate_hz: of.rate_hz,
        reading_unit: of.sensor.unit.symbol(),
        limits: &of.limits,
        criterion: &of.criterion,
        /// Of each design.
        starts: of.starts,
        /// Was the datasheet a prior of every calibration?
        datasheet_prior: of.datasheet_prior,
        /// Was the initial motion given, one for all sensors?
        initial_given: of.initial_given,
        /// The order of all lists of values.
        parameters: &of.parameters,
        /// Of each parameter.
        summary: &of.summary,
        /// Trace of the covariance over the sensors.
        trace: of.trace,
        motions_shown: of.motions_shown,
        sensors: &of.outcomes,
        /// The whole design of the first sensor.
        first_design: &of.design,
    }
}

/// One sensor: its truth, and its calibrations on both motions. Values are in the order and the units of the
/// parameters.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct DesignOutcome {
    /// True values.
    pub truth: Vec<f64>,
    /// The calibration on the initial motion.
    pub initial: MotionOutcome,
    /// The calibration on the motion designed at the initial calibration's estimate.
    pub optimal: MotionOutcome,
    /// How the design ended.
    pub design_status: DesignStatus,
}

/// A calibration on one motion.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct MotionOutcome {
    /// The commanded motion.
    pub motion: JerkControlledMotion,
    /// Value of the criterion that was predicted for it at the design's guess, before the recording.
    pub predicted_criterion: f64,
    /// Estimates.
    #[serde(rename = "value")]
    pub values: Vec<f64>,
    /// Their standard deviations, as the calibration states them.
    pub sd: Vec<f64>,
    /// Absolute error of each.
    #[serde(rename = "absolute_error")]
    pub absolute_errors: Vec<f64>,
    /// Trace of the covariance that the calibration states: the sum of the variances in SI, whatever their units.
    pub trace: f64,
    /// p-value of the fit.
    pub p_value: Option<f64>,
    /// How the calibration ended: a [`CalibrationStatus`](calibrant_core::estimate::CalibrationStatus) name.
    pub status: &'static str,
}

/// The results of both motions for one parameter, over the sensors.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Improvement {
    /// With the initial motions.
    pub initial: ParameterSummary,
    /// With the optimal motions.
    pub optimal: ParameterSummary,
    /// Predicted sd (root mean square over the sensors), initial over optimal.
    pub predicted: Factor,
    /// Error (root mean square over the sensors), initial over optimal.
    pub realised: Factor,
}

/// A ratio of two root mean squares over the sensors, and its Monte Carlo uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Factor {
    /// The ratio.
    pub value: f64,
    /// Its Monte Carlo standard error; `None` for a single sensor.
    pub standard_error: Option<f64>,
}

/// The trace of the covariance over the sensors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct TraceSummary {
    /// With the initial motions.
    pub initial: TraceRange,
    /// With the optimal motions.
    pub optimal: TraceRange,
}

/// The spread of a trace over the sensors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct TraceRange {
    /// Least.
    pub least: f64,
    /// Median.
    pub median: f64,
    /// Most.
    pub most: f64,
}
