//! A rehearsal of a machine: simulated sensors, calibrated on a plain routine and again on the best trajectory.

use super::Improvement;
use super::summary::{Triple, compare};
use calibrant_core::json_object;
use calibrant_core::sensor::Parameter;
use schemars::JsonSchema;
use serde::Serialize;

/// Sensors that were calibrated on a plain routine of a machine, and again on its best trajectory. All is drawn anew for each: the sensor, its mount, the clocks, gravity
/// and the geometry of the machine.
#[derive(Debug, Clone)]
pub struct Rehearsal {
    /// Seed of the first sensor; each later one has the next.
    pub seed: u64,
    /// Duration of both motions, s.
    pub duration_s: f64,
    /// The parameters, in the order of all lists of values.
    pub parameters: Vec<Parameter>,
    /// What the first motion is.
    pub routine: &'static str,
    /// Standard deviations that were designed: with the plain routine, and with the best trajectory.
    pub designed_sd: [Vec<f64>; 2],
    /// One entry for each sensor.
    pub sensors: Vec<RehearsedSensor>,
    /// Summary over the sensors, one entry for each parameter; initial is the plain routine.
    pub summary: Vec<Improvement>,
}

/// One sensor with both calibrations.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RehearsedSensor {
    /// Its seed: `calibrant simulate --seed` makes it again.
    pub seed: u64,
    /// True values.
    pub truth: Vec<f64>,
    /// The calibration on the plain routine.
    pub plain: RehearsedCalibration,
    /// The calibration on the best trajectory.
    pub optimal: RehearsedCalibration,
}

/// A calibration of a rehearsal.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct RehearsedCalibration {
    /// Estimates.
    #[serde(rename = "value")]
    pub values: Vec<f64>,
    /// Their standard deviations, as the calibration states them.
    pub sd: Vec<f64>,
    /// May the result be used: `ok`, `doubtful` or `bad`.
    pub verdict: &'static str,
    /// Codes of the warnings.
    pub codes: Vec<&'static str>,
}

impl Rehearsal {
    /// Of these sensors, with the summary.
    #[must_use]
    pub fn of(
        (seed, duration_s): (u64, f64),
        parameters: Vec<Parameter>,
        routine: &'static str,
        designed_sd: [Vec<f64>; 2],
        sensors: Vec<RehearsedSensor>,
    ) -> Self {
        fn triple<'a>(of: &'a RehearsedSensor, by: &'a RehearsedCalibration) -> Triple<'a> {
            (&of.truth, &by.values, &by.sd)
        }
        let plain: Vec<_> = sensors.iter().map(|of| triple(of, &of.plain)).collect();
        let optimal: Vec<_> = sensors.iter().map(|of| triple(of, &of.optimal)).collect();
        let summary = compare(&parameters, &plain, &optimal);
        Self { seed, duration_s, summary, parameters, routine, designed_sd, sensors }
    }
}

json_object! {
    /// Simulated sensors on a machine, calibrated on a plain routine and again on the best trajectory.
    Rehearsal as of {
        /// Of the first sensor; each later one has the next.
        seed: of.seed,
        /// Duration of both motions, s.
        duration_s: of.duration_s,
        /// The order of all lists of values.
        parameters: &of.parameters,
        /// What the plain routine is: `six poses` or `joints in turn`.
        routine: of.routine,
        /// Standard deviations that the design states for the plain routine.
        designed_sd_plain: &of.designed_sd[0],
        /// Standard deviations that the design states for the best trajectory.
        designed_sd_optimal: &of.designed_sd[1],
        /// Of each parameter; initial is the plain routine.
        summary: &of.summary,
        /// Each sensor with both calibrations.
        sensors: &of.sensors,
    }
}
