//! Writes `calibration.json` of a sensor on a machine: the fields of every calibration, and in `machine` what was found of the machine.

use super::diagnostics::DiagnosticWords;
use super::heading::Heading;
use super::json;
use super::machine_validation::{ValidationFields, validation_fields};
use super::origin::Origin;
use super::shared_fields::{FitFields, matrix_rows};
use calibrant_core::acceptance::CheckedLimit;
use calibrant_core::diagnostic::{Diagnostic, Verdict};
use calibrant_core::error::Result;
use calibrant_core::sensor::{ImuFields, ReadingUnit, SensorKind};
use calibrant_machine::chain::KinematicChain;
use calibrant_machine::estimate::{
    MachineCalibration, MachineQuantity, MachineSetup, MachineTrust, MachineValidation, ReferenceNoise,
    SensorResidual, Source,
};
use calibrant_machine::reference::Motion;
use nalgebra::DMatrix;
use serde::Serialize;
use std::path::Path;

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
#[derive(Debug, Clone, PartialEq, Serialize)]
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
    #[must_use]
    pub fn units(&self) -> Vec<&'static str> {
        let joints: Vec<&'static str> = self
            .chain()
            .map_or(Vec::new(), |chain| chain.joints.iter().map(|joint| joint.kind.unit()).collect());
        let calibration = self.calibration;
        let unit = |quantity: &MachineQuantity| match quantity {
            MachineQuantity::Imu(of) => {
                let readings = calibration.units[usize::from(of.sensor_kind() != SensorKind::Accelerometer)];
                of.unit(readings.unwrap_or(of.sensor_kind().stimulus_unit()))
            }
            other => other.unit(&joints).unwrap_or_default(),
        };
        calibration.quantities.iter().map(unit).collect()
    }
}

/// Writes `calibration.json`, which [`read_calibrated_imu`](super::read_calibrated_imu) reads.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_machine_calibration(
    path: &Path,
    result: &MachineResult<'_>,
    origin: &Origin,
    words: &DiagnosticWords<'_>,
) -> Result<()> {
    json::write_json(path, &CalibrationFile::of(result, origin, words))
}

/// The text that [`write_machine_calibration`] writes.
#[must_use]
pub fn machine_calibration_json(
    result: &MachineResult<'_>,
    origin: &Origin,
    words: &DiagnosticWords<'_>,
) -> String {
    json::to_json(&CalibrationFile::of(result, origin, words))
}

#[derive(Serialize)]
struct CalibrationFile<'a> {
    #[serde(flatten)]
    heading: Heading,
    #[serde(flatten)]
    origin: &'a Origin,
    verdict: Verdict,
    status: &'static str,
    iterations: usize,
    gradient_norm: f64,
    #[serde(flatten)]
    core: ImuFields,
    correlation: Vec<Vec<f64>>,
    fit: FitFields,
    machine: MachineFields<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    validation: Option<ValidationFields>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    limits: Vec<CheckedLimit>,
    warnings: Vec<Diagnostic>,
}

impl<'a> CalibrationFile<'a> {
    fn of(result: &MachineResult<'a>, origin: &'a Origin, words: &'a DiagnosticWords<'a>) -> Self {
        let calibration = result.calibration;
        let imu = calibration.calibrated();
        Self {
            heading: Heading::of("calibration"),
            origin,
            verdict: words.verdict(&calibration.warnings),
            status: calibration.status.name(),
            iterations: calibration.iterations,
            gradient_norm: calibration.gradient_norm,
            core: ImuFields::of(imu.clone()),
            correlation: imu.covariance.as_ref().map_or(Vec::new(), |sigma| matrix_rows(&correlation(sigma))),
            fit: FitFields::of(&calibration.fit, ReadingUnit::MetrePerSecondSquared, 3),
            machine: MachineFields::of(result),
            validation: validation_fields(result.validations, &calibration.joints),
            limits: words.limits.to_vec(),
            warnings: words.stated(&calibration.warnings),
        }
    }
}

fn correlation(sigma: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(sigma.nrows(), sigma.ncols(), |i, j| {
        if i == j { 1.0 } else { sigma[(i, j)] / (sigma[(i, i)] * sigma[(j, j)]).sqrt() }
    })
}

#[derive(Serialize)]
struct MachineFields<'a> {
    trust: &'static str,
    log: &'a MachineLogInput,
    #[serde(skip_serializing_if = "Option::is_none")]
    base: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    tip: Option<&'a str>,
    used_share: f64,
    knots: KnotFields,
    quantities: Vec<QuantityFields>,
    /// Of each of the sensor's parameters, in their order.
    inflation: Vec<f64>,
    gravity_mps2: f64,
    lever_m: Vec<f64>,
    tip_from_sensor_wxyz: [f64; 4],
    sensor_noise: Vec<SensorNoiseFields>,
    log_noise: Vec<LogNoiseFields<'a>>,
    budget: BudgetFields,
}

#[derive(Serialize)]
struct KnotFields {
    start_s: f64,
    step_s: f64,
    intervals: usize,
    degree: usize,
}

#[derive(Serialize)]
struct QuantityFields {
    name: String,
    unit: &'static str,
    value: f64,
    sd: f64,
    prior_sd: f64,
    inflation: f64,
}

#[derive(Serialize)]
struct SensorNoiseFields {
    sensor: &'static str,
    unit: &'static str,
    noise: Vec<f64>,
    white_noise: Vec<f64>,
    residual_rms: Vec<f64>,
    growth: Option<f64>,
}

#[derive(Serialize)]
struct LogNoiseFields<'a> {
    name: &'a str,
    unit: &'static str,
    sd: f64,
    growth: Option<f64>,
    outliers: usize,
    samples: usize,
}

/// The variance of each of the sensor's parameters, by source.
#[derive(Serialize)]
struct BudgetFields {
    sources: [&'static str; Source::ALL.len()],
    /// Shares of the variance, a row for each parameter.
    shares: Vec<Vec<f64>>,
}

impl<'a> MachineFields<'a> {
    fn of(result: &MachineResult<'a>) -> Self {
        let MachineResult { calibration, setup, log, .. } = *result;
        let (chain, sensors) = (result.chain(), calibration.noise.len());
        let (knots, mount) = (calibration.motion.knots(), &calibration.parameters.mount);
        let imu = |quantity: &MachineQuantity| matches!(quantity, MachineQuantity::Imu(_));
        let (names, units, sd) = (calibration.names(), result.units(), calibration.sd());
        let quantity = |k: usize| QuantityFields {
            name: names[k].clone(),
            unit: units[k],
            value: calibration.values[k],
            sd: sd[k],
            prior_sd: setup.prior_sd(calibration.quantities[k], sensors),
            inflation: calibration.inflation[k],
        };
        let (of_imu, of_machine): (Vec<usize>, Vec<usize>) =
            (0..calibration.quantities.len()).partition(|k| imu(&calibration.quantities[*k]));
        let rotation = mount.tip_from_sensor;
        Self {
            trust: match calibration.trust {
                MachineTrust::Known => "known",
                MachineTrust::Noisy => "noisy",
            },
            log,
            base: chain.map(|chain| chain.base.as_str()),
            tip: chain.map(|chain| chain.tip.as_str()),
            used_share: calibration.used_share,
            knots: KnotFields {
                start_s: knots.start_s,
                step_s: knots.step_s,
                intervals: knots.intervals,
                degree: knots.degree.number(),
            },
            quantities: of_machine.into_iter().map(quantity).collect(),
            inflation: of_imu.into_iter().map(|k| calibration.inflation[k]).collect(),
            gravity_mps2: calibration.parameters.gravity_mps2,
            lever_m: mount.lever_m.iter().copied().collect(),
            tip_from_sensor_wxyz: [rotation.w, rotation.i, rotation.j, rotation.k],
            sensor_noise: calibration.noise.iter().map(|noise| of_sensor(calibration, noise)).collect(),
            log_noise: calibration.reference_noise.iter().map(of_log).collect(),
            budget: BudgetFields {
                sources: Source::ALL.map(Source::name),
                shares: (calibration.budget.iter())
                    .map(|row| row.parts.iter().map(|part| part / row.variance).collect())
                    .collect(),
            },
        }
    }
}

fn of_sensor(calibration: &MachineCalibration, residual: &SensorResidual) -> SensorNoiseFields {
    let kind = residual.sensor;
    let unit = calibration.units[usize::from(kind != SensorKind::Accelerometer)];
    SensorNoiseFields {
        sensor: kind.name(),
        unit: unit.unwrap_or(kind.stimulus_unit()).symbol(),
        noise: residual.noise.iter().copied().collect(),
        white_noise: residual.white_noise.iter().copied().collect(),
        residual_rms: residual.rms.iter().copied().collect(),
        growth: residual.growth,
    }
}

fn of_log(noise: &ReferenceNoise) -> LogNoiseFields<'_> {
    let ReferenceNoise { name, unit, sd, growth, outliers, samples } = noise;
    LogNoiseFields { name, unit, sd: *sd, growth: *growth, outliers: *outliers, samples: *samples }
}
