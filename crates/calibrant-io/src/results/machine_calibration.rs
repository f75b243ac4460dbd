//! `calibration.json` of a sensor on a machine: the fields of every calibration, and in `machine` what was found of the machine.

use super::heading::{Heading, JsonFile};
use super::judgement::Judgement;
use super::machine_validation::ValidationOf;
use super::origin::Origin;
use calibrant_core::estimate::{Budget, VarianceSource};
use calibrant_core::form::As;
use calibrant_core::json::{flat, if_any, if_some};
use calibrant_core::json_object;
use calibrant_machine::chain::KinematicChain;
use calibrant_machine::estimate::{
    MachineCalibration, MachineQuantity, MachineSetup, MachineTrust, MachineValidation, SensorResidual,
};
use calibrant_machine::reference::Motion;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;

/// A calibration on a machine with what it is from.
#[derive(Debug, Clone, Copy)]
pub struct MachineResult<'a> {
    /// The calibration.
    pub calibration: &'a MachineCalibration,
    /// What was known beforehand.
    pub setup: &'a MachineSetup,
    /// The log of the machine's motion.
    pub log: &'a MachineLogInput,
    /// How it fares with other data.
    pub validations: &'a [MachineValidation],
}

/// The file of a log of a machine's motion.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct MachineLogInput {
    /// Name of the file, without its directory.
    pub file: String,
    /// SHA-256 of the file, hexadecimal.
    pub sha256: String,
    /// Its format: `joints`, `tum`, ….
    pub format: &'static str,
    /// Number of samples that were used: those of the recovered stream, where the log is an interpolation of one.
    pub samples: usize,
    /// Rate of the slower stream whose interpolation the log is, Hz.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub recovered_rate_hz: Option<f64>,
}

impl<'a> MachineResult<'a> {
    /// The joints, for a log of them.
    fn chain(&self) -> Option<&'a KinematicChain> {
        match &self.calibration.motion {
            Motion::Joints(joints) => Some(&joints.chain),
            Motion::Poses(_) => None,
        }
    }

    /// The unit of each quantity that was estimated.
    fn units(&self) -> Vec<&'static str> {
        let joints: Vec<&'static str> = self
            .chain()
            .map_or(Vec::new(), |chain| chain.joints.iter().map(|joint| joint.kind.unit()).collect());
        let calibration = self.calibration;
        let unit = |quantity: &MachineQuantity| match quantity {
            MachineQuantity::Imu(of) => calibration.sensors.unit_of(*of),
            other => other.unit(&joints).unwrap_or_default(),
        };
        calibration.quantities.iter().map(unit).collect()
    }
}

/// The content of `calibration.json` of a sensor on a machine, which [`read_calibrated_imu`](crate::read_calibrated_imu) reads.
#[derive(Clone, Copy)]
pub struct MachineCalibrationFile<'a> {
    /// The calibration with what it is from.
    pub result: MachineResult<'a>,
    /// Of which sensor it is, and from which files.
    pub origin: &'a Origin,
    /// The verdict's codes, and the limits.
    pub judgement: Judgement<'a>,
}

json_object! {
    /// A calibration of a sensor on a machine, where it comes from, and what judges it.
    MachineCalibrationFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        origin: flat(file.origin),
        verdict: file.judgement.verdict(&file.result.calibration.sensors.warnings),
        calibration: flat(&file.result.calibration.sensors),
        /// What was found of the machine.
        machine: file.result,
        /// How far the parameters move with other data, by its source: `recording`, `folds`.
        validation: if_any(file.validation()),
        /// The figures beside their limits.
        limits: if_any(file.judgement.limits),
        warnings: file.judgement.stated(&file.result.calibration.sensors.warnings),
    }
}

impl JsonFile for MachineCalibrationFile<'_> {
    const KIND: &'static str = "machine";
}

json_object! {
    /// What was found of the machine, and of the noise.
    MachineResult<'_> as of {
        /// Trust in the log.
        trust: match of.calibration.trust {
            MachineTrust::Known => "known",
            MachineTrust::Noisy => "noisy",
        },
        log: of.log,
        /// The link that stands still.
        base: if_some(of.chain().map(|chain| &chain.base)),
        /// The link that carries the sensor.
        tip: if_some(of.chain().map(|chain| &chain.tip)),
        /// Part of the sensor's samples that lie in the log's time and in none of its gaps.
        used_share: of.calibration.used_share,
        knots: of.knots(),
        /// What was estimated beside the sensor's parameters.
        quantities: of.quantities(),
        /// By how much correlation in time widens the standard deviation of each of the sensor's parameters.
        inflation: of.inflation(),
        gravity_mps2: of.calibration.parameters.gravity_mps2,
        /// From the tip to the sensor.
        lever_m: <[f64; 3]>::from(of.calibration.parameters.mount.lever_m),
        /// The sensor's orientation at the tip, a unit quaternion.
        tip_from_sensor_wxyz: of.tip_from_sensor_wxyz(),
        sensor_noise: of.calibration.noise.iter().map(|noise| of.noise_of(noise)).collect::<Vec<_>>(),
        log_noise: &of.calibration.reference_noise,
        /// The variance of each of the sensor's parameters, by source.
        budget: Budget::of(&of.calibration.sensors.budget, VarianceSource::ON_MACHINE),
    }
}

/// The knots of the spline.
#[derive(Serialize, JsonSchema)]
struct Knots {
    start_s: f64,
    step_s: f64,
    /// Number of intervals between knots.
    intervals: usize,
    /// Degree of the polynomials.
    degree: usize,
}

/// A quantity that was estimated beside the sensor's parameters.
#[derive(Serialize, JsonSchema)]
struct Quantity {
    /// Which quantity it is.
    name: String,
    /// Unit of its numbers.
    unit: &'static str,
    /// The estimate.
    value: f64,
    /// Its standard deviation.
    sd: f64,
    /// Standard deviation of what was known before; none without a prior.
    #[serde(with = "As::<Option<f64>>")]
    prior_sd: f64,
    /// By how much correlation in time widens the standard deviation.
    inflation: f64,
}

/// The noise of one sample of a sensor, in `unit`.
#[derive(Serialize, JsonSchema)]
struct NoiseOfSensor {
    /// Which sensor it is.
    sensor: &'static str,
    /// Unit of its readings.
    unit: &'static str,
    /// Standard deviation of one sample at rest, given or from the residuals.
    noise: [f64; 3],
    /// The part that neighbouring samples do not share.
    white_noise: [f64; 3],
    /// Root mean square of the residuals.
    residual_rms: [f64; 3],
    /// Of the variance with the activity of the motion.
    growth: Option<f64>,
}

impl MachineCalibrationFile<'_> {
    fn validation(&self) -> BTreeMap<&'static str, ValidationOf<'_>> {
        let joints = &self.result.calibration.joints;
        let named = |validation| (ValidationOf::name(validation), ValidationOf { validation, joints });
        self.result.validations.iter().map(named).collect()
    }
}

impl MachineResult<'_> {
    fn knots(&self) -> Knots {
        let knots = self.calibration.motion.knots();
        Knots {
            start_s: knots.start_s,
            step_s: knots.step_s,
            intervals: knots.intervals,
            degree: knots.degree.number(),
        }
    }

    /// The places of the quantities that are the sensor's, or that are not.
    fn places(&self, of_imu: bool) -> impl Iterator<Item = usize> {
        let quantities = self.calibration.quantities.iter().enumerate();
        quantities
            .filter(move |(_, quantity)| matches!(quantity, MachineQuantity::Imu(_)) == of_imu)
            .map(|(k, _)| k)
    }

    fn quantities(&self) -> Vec<Quantity> {
        let Self { calibration, setup, .. } = *self;
        let (names, units, sd) = (calibration.names(), self.units(), calibration.sd());
        let quantity = |k: usize| Quantity {
            name: names[k].clone(),
            unit: units[k],
            value: calibration.values[k],
            sd: sd[k],
            prior_sd: setup.prior_sd(calibration.quantities[k], calibration.noise.len()),
            inflation: calibration.inflation[k],
        };
        self.places(false).map(quantity).collect()
    }

    fn inflation(&self) -> Vec<f64> {
        self.places(true).map(|k| self.calibration.inflation[k]).collect()
    }

    fn tip_from_sensor_wxyz(&self) -> [f64; 4] {
        let rotation = self.calibration.parameters.mount.tip_from_sensor;
        [rotation.w, rotation.i, rotation.j, rotation.k]
    }

    fn noise_of(&self, residual: &SensorResidual) -> NoiseOfSensor {
        NoiseOfSensor {
            sensor: residual.sensor.name(),
            unit: self.calibration.sensors.unit(residual.sensor).symbol(),
            noise: residual.noise.into(),
            white_noise: residual.white_noise.into(),
            residual_rms: residual.rms.into(),
            growth: residual.growth,
        }
    }
}
