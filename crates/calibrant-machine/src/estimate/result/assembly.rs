//! Puts the result together.

use super::drift;
use super::shared_errors::shared_errors;
use crate::chain::JointKind;
use crate::estimate::covariance::{budget, inflation};
use crate::estimate::least_squares::{Minimum, Model, Pass, white_noise};
use crate::estimate::noise::{Growths, Posterior};
use crate::estimate::{
    MachineCalibration, MachineProblem, MachineTrust, MountVariance, ReferenceNoise, SampleResidual,
    SensorResidual, mount_variances,
};
use crate::log::ReferenceLog;
use calibrant_core::estimate::FitStatistics;
use calibrant_core::sensor::{Axis, SensorKind};
use nalgebra::{DMatrix, Vector3};
use statrs::distribution::{ChiSquared, ContinuousCDF};

pub(crate) fn assembled(
    problem: &MachineProblem<'_>,
    model: &Model<'_>,
    minimum: &Minimum,
    posterior: &Posterior,
    growths: &Growths,
    outliers: Vec<usize>,
) -> MachineCalibration {
    let (state, layout) = (&minimum.state, &model.layout);
    let inflation = inflation(layout, &posterior.covariance, &minimum.solved.information, &minimum.blocks);
    let n = layout.len();
    let of_mount = mount_variances(layout, &state.parameters, &posterior.covariance);
    let beyond: Vec<f64> = of_mount.into_iter().map(MountVariance::beyond).collect();
    let covariance = DMatrix::from_fn(n, n, |i, j| {
        let first = posterior.covariance[(i, j)] * inflation[i] * inflation[j];
        if i == j { first + beyond[i] } else { first }
    });
    let noise: Vec<SensorResidual> = (0..model.streams.len())
        .map(|s| {
            let stream = &model.streams[s];
            let residuals = model.residuals(state, s, Pass::all(model.trust));
            let squares: Vector3<f64> = residuals.iter().map(|of| of.value.map(|r| r * r)).sum();
            let values: Vec<SampleResidual> = residuals
                .iter()
                .map(|of| SampleResidual { time_s: of.time_s, value: of.value, sd: stream.sd_of(of.sample) })
                .collect();
            let bias = state.parameters.imu.sensor(stream.sensor).bias;
            let without_bias: Vec<Vector3<f64>> =
                residuals.iter().map(|of| stream.recording.readings()[of.sample] - bias).collect();
            SensorResidual {
                sensor: stream.sensor,
                noise: stream.sd,
                white_noise: white_noise(stream.recording),
                growth: growths.streams[s],
                rms: (squares / (residuals.len() as f64).max(1.0)).map(f64::sqrt),
                drift: drift::find(&values, &without_bias),
                residuals: values,
            }
        })
        .collect();
    let samples: usize = model.streams.iter().map(|stream| stream.recording.len()).sum();
    let used: usize = noise.iter().map(|of| of.residuals.len()).sum();
    MachineCalibration {
        status: minimum.status,
        iterations: minimum.iterations,
        gradient_norm: minimum.last_step,
        trust: model.trust,
        joints: model.joint_names(),
        quantities: layout.quantities.clone(),
        values: layout.quantities.iter().map(|of| state.parameters.value(*of, &layout.nominal)).collect(),
        budget: budget(layout, posterior, &covariance, &beyond, model.trust),
        shared: shared_errors(layout, &model.joint_names(), &posterior.covariance, &covariance),
        covariance,
        linear_covariance: posterior.covariance.clone(),
        inflation,
        unseen: DMatrix::zeros(n, n),
        parameters: state.parameters.clone(),
        nominal: layout.nominal.clone(),
        units: SensorKind::ALL.map(|kind| problem.recording.sensor(kind).map(|recording| recording.unit())),
        fit: fit(problem, minimum, posterior, layout.len(), used),
        noise,
        reference_noise: reference_noise(problem, model, growths.log, &outliers),
        motion: state.motion.clone(),
        covered: model.covered.clone(),
        used_share: used as f64 / samples.max(1) as f64,
        warnings: Vec::new(),
    }
}

/// χ² of everything: the sensor's samples, the log's where it is not trusted, and the priors.
fn fit(
    problem: &MachineProblem<'_>,
    minimum: &Minimum,
    posterior: &Posterior,
    parameters: usize,
    used: usize,
) -> FitStatistics {
    let noisy = problem.setup.trust == MachineTrust::Noisy;
    let log: f64 = if noisy { posterior.sums.log.iter().map(|moments| moments.count).sum() } else { 0.0 };
    let determined: f64 =
        if noisy { posterior.sums.log.iter().map(|moments| moments.leverage).sum() } else { 0.0 };
    let of_streams: f64 = posterior.sums.streams.iter().flatten().map(|moments| moments.leverage).sum();
    let unknowns = (determined + of_streams).max(parameters.min(3 * used) as f64);
    let degrees = (3 * used) as f64 + log - unknowns;
    let degrees_of_freedom = degrees.max(0.0).round() as usize;
    let setup = problem.setup;
    let given = SensorKind::ALL
        .into_iter()
        .filter(|kind| problem.recording.sensor(*kind).is_some())
        .all(|kind| setup.noise_of(kind).is_some())
        && (!noisy || setup.reference_noise.is_some());
    let p_value = (given && degrees_of_freedom > 0)
        .then(|| ChiSquared::new(degrees).ok().map(|distribution| distribution.sf(minimum.cost.max(0.0))))
        .flatten();
    FitStatistics {
        chi2: minimum.cost,
        degrees_of_freedom,
        p_value,
        residual_rms: None,
        assumed_noise: None,
        noise_estimate: None,
        whiteness: Vec::new(),
    }
}

fn reference_noise(
    problem: &MachineProblem<'_>,
    model: &Model<'_>,
    growth: Option<f64>,
    outliers: &[usize],
) -> Vec<ReferenceNoise> {
    let names: Vec<(String, &'static str)> = match model.log.log {
        ReferenceLog::Joints(log) => {
            let unit = |j: usize| match &problem.chain.map(|chain| chain.joints[j].kind) {
                Some(JointKind::Prismatic) => "m",
                _ => "rad",
            };
            log.names.iter().enumerate().map(|(j, name)| (name.clone(), unit(j))).collect()
        }
        ReferenceLog::Poses(_) => [("position", "m"), ("orientation", "rad")]
            .into_iter()
            .flat_map(|(part, unit)| Axis::ALL.map(|axis| (format!("{part}.{axis}"), unit)))
            .collect(),
    };
    (names.into_iter().enumerate())
        .map(|(k, (name, unit))| ReferenceNoise {
            name,
            unit,
            sd: model.log.sd[k],
            growth,
            outliers: outliers.get(k).copied().unwrap_or(0),
            samples: model.log.samples(k),
        })
        .collect()
}
