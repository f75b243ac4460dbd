//! Puts the result together.

use super::drift;
use super::machine_calibration::{of_sensors, sensor_quantities};
use super::shared_errors::shared_errors;
use crate::chain::JointKind;
use crate::estimate::covariance::{budget, inflation};
use crate::estimate::least_squares::{Minimum, Model, Pass, State, white_noise};
use crate::estimate::noise::{Growths, Posterior};
use crate::estimate::{
    MachineCalibration, MachineProblem, MachineTrust, MountVariance, ReferenceNoise, SampleResidual,
    SensorResidual, mount_variances,
};
use crate::log::ReferenceLog;
use calibrant_core::estimate::{
    BudgetRow, Calibration, FitStatistics, FoundOnMachine, Recovered, shares_of_prior,
};
use calibrant_core::sensor::{Axis, Gauge, ImuQuantity, Parameter, PerSensor, SensorKind};
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
        sensors: sensors(
            problem,
            model,
            minimum,
            posterior,
            (&covariance, budget(layout, posterior, &covariance, &beyond, model.trust)),
            FoundOnMachine {
                shared: shared_errors(layout, &model.joint_names(), &posterior.covariance, &covariance),
                frame: frame(model, state),
            },
            fit(problem, minimum, posterior, layout.len(), used),
        ),
        trust: model.trust,
        joints: model.joint_names(),
        quantities: layout.quantities.clone(),
        values: layout.quantities.iter().map(|of| state.parameters.value(*of, &layout.nominal)).collect(),
        covariance,
        linear_covariance: posterior.covariance.clone(),
        inflation,
        unseen: DMatrix::zeros(n, n),
        parameters: state.parameters.clone(),
        nominal: layout.nominal.clone(),
        noise,
        reference_noise: reference_noise(problem, model, growths.log, &outliers),
        motion: state.motion.clone(),
        covered: model.covered.clone(),
        used_share: used as f64 / samples.max(1) as f64,
    }
}

/// The sensors' part of the result.
fn sensors(
    problem: &MachineProblem<'_>,
    model: &Model<'_>,
    minimum: &Minimum,
    posterior: &Posterior,
    (covariance, budget): (&DMatrix<f64>, Vec<BudgetRow>),
    found: FoundOnMachine,
    fit: FitStatistics,
) -> Calibration {
    let units = PerSensor::from_fn(|kind| problem.recording.sensor(kind).map(|recording| recording.unit()));
    let imu = minimum.state.parameters.imu;
    let quantities: Vec<ImuQuantity> =
        sensor_quantities(&model.layout.quantities).map(|(_, quantity)| quantity).collect();
    let of_sensors = |of: &DMatrix<f64>| of_sensors(&model.layout.quantities, of);
    let prior = of_sensors(&model.layout.prior).diagonal();
    let prior_share = match prior.amax() > 0.0 {
        true => shares_of_prior(prior.as_slice(), &of_sensors(&posterior.covariance)),
        false => Vec::new(),
    };
    let unit = |kind: SensorKind| units[kind].unwrap_or(kind.stimulus_unit());
    Calibration {
        status: minimum.status,
        iterations: minimum.iterations,
        gradient_norm: minimum.last_step,
        parameters: quantities.iter().map(|of| Parameter::undescribed(*of, unit(of.sensor_kind()))).collect(),
        values: quantities.iter().map(|of| of.value(&imu)).collect(),
        covariance: of_sensors(covariance),
        budget,
        quantities,
        prior_share,
        gravity_slope: Vec::new(),
        datasheet_prior: false,
        imu,
        units,
        counts_per_unit: PerSensor::default(),
        fit,
        recovered: Recovered::OnMachine(found),
        gyroscope: None,
        soak: None,
        soak_prior: Vec::new(),
        changes: Vec::new(),
        warnings: Vec::new(),
    }
}

/// The true frame, in words: a matrix that has the form of a gauge defines it.
fn frame(model: &Model<'_>, state: &State) -> String {
    let reference = model.streams.first().map(|stream| state.parameters.imu.sensor(stream.sensor).matrix);
    match reference.and_then(|matrix| Gauge::of(&matrix)) {
        Some(gauge) => {
            format!("that of the gauge `{}`: its orientation on the tip is in `machine.mount`", gauge.name())
        }
        None => "the axes of the machine's tip, turned by the mounting".to_owned(),
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
