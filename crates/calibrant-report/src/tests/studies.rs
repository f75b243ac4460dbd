//! Made-up studies: swings in place of the optima, errors drawn from the predicted
//! covariance.

use super::{design, designs, fakes, motion, sensor, simulate, study};
use calibrant_core::diagnostic::Phrase;
use calibrant_core::diagnostic::design::MotionNotDesigned;
use design::{DesignStatus, Evaluation, SurfaceSettings, trace_surface};
use motion::{InputNoise, Trust};
use rand_distr::{Distribution, StandardNormal};
use sensor::{Sensor, SensorParameters};
use simulate::{Purpose, Rng, draw_sensor, initial_motion, stream};
use study::{
    DesignOutcome, DesignStudy, Factor, Improvement, MotionOutcome, ParameterSummary, SensorOutcome, Studies,
    Study, TraceRange, TraceSummary,
};

/// One study of calibrations and nothing else.
pub(crate) fn calibrations(study: Study) -> Studies {
    Studies { calibration: Some(study), ..Studies::default() }
}

/// All studies of the thesis.
pub(crate) fn everything(calibrated: usize, designed: usize) -> Studies {
    let surface =
        SurfaceSettings { jerk_mps3: 0.5, points: 41, start_mps2: 0.0, interval_s: 1.0, rate_hz: 10.0 };
    Studies {
        calibration: Some(calibration_study(calibrated)),
        surface: Some(trace_surface(&Sensor::memsic_mxd2020u(), &surface).expect("valid settings")),
        design: Some(design_study(designed, Trust::Known)),
        noisy: Some(design_study(designed, Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 }))),
        notes: vec![MotionNotDesigned { is_noisy: false, why: Phrase("<and why>".into()) }.into()],
        ..Studies::default()
    }
}

/// Initial against swinging motions.
pub(crate) fn design_study(sensors: usize, trust: Trust) -> DesignStudy {
    let (sensor, limits) = (Sensor::memsic_mxd2020u(), designs::arm());
    let problem = design::DesignProblem { trust, ..designs::problem(&sensor, &limits) };
    let list = sensor.parameter_list();
    let outcomes: Vec<DesignOutcome> = (0..sensors as u64)
        .map(|index| {
            let mut rng = stream(5, Purpose::Sensor, index);
            let truth = draw_sensor(&sensor, &mut rng);
            let truth: Vec<f64> = list.quantities().iter().map(|quantity| quantity.value(&truth)).collect();
            let random = initial_motion(10, 1.0, 3, &limits, &mut stream(5, Purpose::Motion, index));
            let initial = design::evaluate(&problem, &random.expect("valid")).expect("valid");
            let optimal = designs::swing(&problem, [2.0, if index % 3 == 0 { -2.0 } else { 2.0 }, 2.0]);
            DesignOutcome {
                initial: estimated(&truth, initial, &mut rng),
                optimal: estimated(&truth, optimal, &mut rng),
                truth,
                design_status: DesignStatus::Converged,
            }
        })
        .collect();
    let design = designs::design_of(&problem, 30);
    DesignStudy {
        sensor: sensor.clone(),
        parameters: design.parameters.clone(),
        intervals: 10,
        interval_s: 1.0,
        rate_hz: 10.0,
        trust,
        known_ends: problem.known_ends,
        limits: design.limits.clone(),
        criterion: problem.criterion.clone(),
        datasheet_prior: false,
        initial_given: false,
        starts: 30,
        seed: 5,
        motions_shown: 10.min(outcomes.len()),
        summary: (0..list.len()).map(|p| improvement(&design.parameters[p], p, &outcomes)).collect(),
        trace: TraceSummary {
            initial: range(outcomes.iter().map(|outcome| outcome.initial.trace).collect()),
            optimal: range(outcomes.iter().map(|outcome| outcome.optimal.trace).collect()),
        },
        outcomes,
        design,
    }
}

fn estimated(truth: &[f64], evaluation: Evaluation, rng: &mut Rng) -> MotionOutcome {
    let sd = evaluation.sd();
    let draw = |(value, sd): (&f64, &f64)| {
        let z: f64 = StandardNormal.sample(rng);
        value + sd * z
    };
    let values: Vec<f64> = truth.iter().zip(&sd).map(draw).collect();
    MotionOutcome {
        absolute_errors: truth.iter().zip(&values).map(|(truth, value)| (value - truth).abs()).collect(),
        values,
        trace: sd.iter().map(|sd| sd * sd).sum(),
        sd,
        predicted_criterion: evaluation.value,
        motion: evaluation.motion,
        p_value: Some(0.4),
        status: "converged",
    }
}

fn improvement(parameter: &sensor::Parameter, p: usize, outcomes: &[DesignOutcome]) -> Improvement {
    let n = outcomes.len() as f64;
    let of = |motion: fn(&DesignOutcome) -> &MotionOutcome| {
        let error = |o: &DesignOutcome| motion(o).values[p] - o.truth[p];
        ParameterSummary {
            name: parameter.name.clone(),
            unit: parameter.unit,
            predicted_sd: (outcomes.iter().map(|o| motion(o).sd[p].powi(2)).sum::<f64>() / n).sqrt(),
            realised_rms: (outcomes.iter().map(|o| error(o).powi(2)).sum::<f64>() / n).sqrt(),
            mean_error: outcomes.iter().map(error).sum::<f64>() / n,
            coverage_95: outcomes.iter().filter(|o| error(o).abs() < 1.96 * motion(o).sd[p]).count() as f64
                / n,
        }
    };
    let (initial, optimal) = (of(|o| &o.initial), of(|o| &o.optimal));
    let factor = |value: f64, share: f64| Factor { value, standard_error: Some(share * value / n.sqrt()) };
    Improvement {
        predicted: factor(initial.predicted_sd / optimal.predicted_sd, 0.3),
        realised: factor(initial.realised_rms / optimal.realised_rms, 1.0),
        initial,
        optimal,
    }
}

fn range(mut values: Vec<f64>) -> TraceRange {
    values.sort_by(f64::total_cmp);
    let at = |place: usize| values.get(place).copied().unwrap_or(f64::NAN);
    TraceRange { least: at(0), median: at(values.len() / 2), most: at(values.len().saturating_sub(1)) }
}

/// A study of this many sensors.
pub(crate) fn calibration_study(sensors: usize) -> Study {
    let mut dice = fakes::Dice::new(50);
    let single = fakes::motion_case(3, 14, 2.0, 4);
    let fine = fakes::motion_case(3, 14, 10.0, 4);
    let datasheet = Sensor::memsic_mxd2020u();
    let parameters = datasheet.parameter_list().describe(&datasheet, &SensorParameters::identity());
    let sd = [8e-5, 6e-5, 9e-5, 4e-5, 7e-5, 5e-5];
    let outcomes: Vec<SensorOutcome> = (0..sensors)
        .map(|_| {
            let truth: Vec<f64> = parameters
                .iter()
                .map(|q| q.nominal.unwrap_or(0.0) + dice.normal(q.spread.unwrap_or(0.1)))
                .collect();
            let values = truth.iter().zip(sd).map(|(value, sd)| value + dice.normal(sd)).collect();
            let p_value = (0..6).fold(0.5, |p: f64, _| (p + dice.normal(0.7)).rem_euclid(1.0));
            SensorOutcome { truth, values, sd: sd.to_vec(), p_value: Some(p_value), status: "converged" }
        })
        .collect();
    let summary = parameters
        .iter()
        .enumerate()
        .map(|(p, parameter)| {
            let errors: Vec<f64> = outcomes.iter().map(|o| o.values[p] - o.truth[p]).collect();
            let n = errors.len().max(1) as f64;
            ParameterSummary {
                name: parameter.name.clone(),
                unit: parameter.unit,
                predicted_sd: sd[p],
                realised_rms: (errors.iter().map(|e| e * e).sum::<f64>() / n).sqrt(),
                mean_error: errors.iter().sum::<f64>() / n,
                coverage_95: errors.iter().filter(|e| e.abs() < 1.96 * sd[p]).count() as f64 / n,
            }
        })
        .collect();
    Study {
        sensor: datasheet,
        parameters,
        trust: "unknown",
        seed: 1,
        rate_hz: 2.0,
        motion: single.true_motion.clone(),
        outcomes,
        summary,
        single,
        fine,
    }
}
