//! Best poses: a calibration from them has the standard deviations that the design promises.
//!
//! Sensors are simulated in the poses of a design, in its order, with a drift of the biases and a scatter
//! between holds. The scatter of the estimates about the truth is compared with the promised one.

use crate::common::normal;
use crate::common::steady_holds;
use calibrant::design::DesignSettings;
use calibrant::design::poses::{
    Allowed, DirectionKnowledge, PoseDesign, PoseNuisance, PoseProblem, design_poses,
};
use calibrant::estimate::{
    CalibrationProblem, CalibrationSettings, FacesProblem, HoldsSetup, Stimulus, calibrate, calibrate_faces,
};
use calibrant::information::Criterion;
use calibrant::information::criterion::DOptimality;
use calibrant::motion::Gravity;
use calibrant::sensor::{
    Gauge, ImuParameters, ParameterList, Recording, Sensor, SensorKind, SensorModel, SensorParameters,
};
use calibrant::simulate::{
    HoldsSimulation, ImuSimulation, Purpose, Rng, TableAction, TableStep, draw_sensor, simulate_holds_in,
    simulate_table, stream,
};
use nalgebra::{DVector, Vector3};
use rayon::prelude::*;

/// Noise of a sample, scatter between holds, standard deviation of the drift: m/s².
const NOISE: f64 = 0.01;
const BETWEEN: f64 = 1e-3;
const DRIFT: f64 = 5e-3;
/// Standard deviation of the directions, where they are known, rad.
const TILT: f64 = 2e-3;
const GRAVITY: f64 = 9.80665;
const RATE_HZ: f64 = 50.0;
const HOLD_S: f64 = 2.0;
const TURN_S: f64 = 1.5;

fn sensor() -> Sensor {
    Sensor {
        noise_mps2: Some(Vector3::repeat(NOISE)),
        bias_sd_mps2: Some(Vector3::repeat(0.05)),
        scale_sd: Some(Vector3::repeat(0.005)),
        cross_axis_sd: Some(0.005),
        ..Sensor::triaxial(SensorModel::Full)
    }
}

fn design(knowledge: DirectionKnowledge, poses: usize) -> (PoseProblem, PoseDesign) {
    // an accelerometer in known directions is calibrated without a drift
    let (list, drift) = match knowledge {
        DirectionKnowledge::Unknown => (Gauge::Upper.parameter_list(SensorModel::Full), DRIFT),
        DirectionKnowledge::Known { .. } => (ParameterList::new(3, SensorModel::Full), 0.0),
    };
    let problem = PoseProblem {
        criterion: Criterion::D(DOptimality { scale: DVector::repeat(list.len(), 1.0) }),
        list,
        at: SensorParameters::identity(),
        gravity_mps2: GRAVITY,
        mean_sd: Vector3::repeat((NOISE / (HOLD_S * RATE_HZ).sqrt()).hypot(BETWEEN)),
        directions: knowledge,
        allowed: Allowed::Anywhere,
        prior: None,
        poses,
        nuisance: PoseNuisance { drift_sd: Vector3::repeat(drift), ..PoseNuisance::none() },
    };
    let design = design_poses(&problem, &DesignSettings::default(), &|_| {}).expect("determined");
    (problem, design)
}

/// The recording with a drift of each bias from the middle of the first hold to that of the last.
fn drifting(mut recording: Recording, rng: &mut Rng) -> Recording {
    let drift = Vector3::from_fn(|_, _| DRIFT * normal(rng));
    let last = recording.times_s().last().copied().unwrap_or(0.0);
    let (first, last) = (0.5 * HOLD_S, last - 0.5 * HOLD_S);
    for (t, reading) in recording.samples_mut() {
        *reading += drift * ((t - first) / (last - first) - 0.5);
    }
    recording
}

fn holds(poses: usize, start_s: impl Fn(usize) -> f64) -> HoldsSetup {
    let hold = |k| (start_s(k), start_s(k) + HOLD_S - 0.5 / RATE_HZ);
    HoldsSetup {
        gravity: Gravity { magnitude_mps2: GRAVITY, sd_mps2: 0.0 },
        gauge: Gauge::Upper,
        intervals_s: Some((0..poses).map(hold).collect()),
        bias_drift_sd_mps2: DRIFT,
        ..steady_holds()
    }
}

/// Errors of a calibration in unknown directions, in promised standard deviations.
fn by_hand(problem: &PoseProblem, design: &PoseDesign, number: u64) -> Vec<f64> {
    let mut rng = stream(401, Purpose::Sensor, number);
    let truth = Gauge::Upper.apply(&draw_sensor(&sensor(), &mut rng));
    let simulation = HoldsSimulation {
        poses: design.directions.len(),
        hold_s: HOLD_S,
        turn_s: TURN_S,
        rate_hz: RATE_HZ,
        gravity_mps2: GRAVITY,
        between_holds_sd_mps2: BETWEEN,
    };
    let noise = Vector3::repeat(NOISE);
    let (recording, _) =
        simulate_holds_in(&truth, &noise, sensor().unit, &design.directions, &simulation, &mut rng);
    let recording = drifting(recording, &mut rng);
    let setup = holds(design.directions.len(), |k| k as f64 * (HOLD_S + TURN_S));
    let problem_of =
        CalibrationProblem { sensor: &sensor(), recording: &recording, stimulus: Stimulus::Holds(&setup) };
    let found = calibrate(&problem_of, &CalibrationSettings::default()).expect("determined");
    errors(problem, design, &found.values, &truth)
}

/// The same in known directions.
fn in_fixture(problem: &PoseProblem, design: &PoseDesign, number: u64) -> Vec<f64> {
    let mut rng = stream(402, Purpose::Sensor, number);
    let truth = draw_sensor(&sensor(), &mut rng);
    let start_s = |k: usize| k as f64 * (HOLD_S + TURN_S);
    let step = |(k, direction): (usize, &Vector3<f64>)| TableStep {
        start_s: start_s(k),
        end_s: start_s(k) + HOLD_S,
        action: TableAction::Hold(*direction),
    };
    let steps: Vec<TableStep> = design.directions.iter().enumerate().map(step).collect();
    let simulation = ImuSimulation {
        face_sd_rad: TILT,
        rate_hz: RATE_HZ,
        gravity_mps2: GRAVITY,
        accelerometer_noise: NOISE,
        between_holds_sd_mps2: BETWEEN,
        ..ImuSimulation::default()
    };
    let imu = ImuParameters::identity().with(SensorKind::Accelerometer, truth);
    let recording = simulate_table(&imu, &steps, &simulation, &mut rng)[SensorKind::Accelerometer]
        .clone()
        .expect("recorded");
    let setup = holds(design.directions.len(), start_s);
    let problem_of = FacesProblem {
        sensor: &sensor(),
        recording: &recording,
        holds: &setup,
        directions: &design.directions,
        face_sd_rad: Some(TILT),
    };
    let found = calibrate_faces(&problem_of, &CalibrationSettings::default()).expect("determined");
    errors(problem, design, &found.values, &truth)
}

fn errors(problem: &PoseProblem, design: &PoseDesign, values: &[f64], truth: &SensorParameters) -> Vec<f64> {
    let of = |((quantity, value), sd): ((&calibrant::sensor::Quantity, &f64), &f64)| {
        (value - quantity.value(truth)) / sd
    };
    problem.list.quantities().iter().zip(values).zip(design.sd().iter()).map(of).collect()
}

/// Root mean square of the errors of each parameter, in promised standard deviations.
fn ratios(
    count: u64,
    names: &[String],
    errors: impl Fn(u64) -> Vec<f64> + Sync + Send,
) -> Vec<(String, f64)> {
    let all: Vec<Vec<f64>> = (0..count).into_par_iter().map(errors).collect();
    let of = |(k, name): (usize, &String)| {
        let square: f64 = all.iter().map(|errors| errors[k] * errors[k]).sum();
        (name.clone(), (square / count as f64).sqrt())
    };
    names.iter().enumerate().map(of).collect()
}

/// The ratios are 1 to within four standard deviations of the simulation, `1/√(2 count)`.
fn check(count: u64) {
    let (unknown, by_design) = design(DirectionKnowledge::Unknown, 18);
    let found = ratios(count, &unknown.list.names(), |number| by_hand(&unknown, &by_design, number));
    let (known, of_fixture) = design(DirectionKnowledge::Known { sd_rad: TILT }, 16);
    let other = ratios(count, &known.list.names(), |number| in_fixture(&known, &of_fixture, number));
    let error = 1.0 / (2.0 * count as f64).sqrt();
    for (kind, (name, ratio)) in
        found.iter().map(|found| ("unknown", found)).chain(other.iter().map(|found| ("known", found)))
    {
        println!("{kind} {name}: {ratio:.4} ± {error:.4}");
    }
    for (name, ratio) in found.iter().chain(&other) {
        assert!((ratio - 1.0).abs() < 4.0 * error, "{name}: {ratio} ± {error}");
    }
}

#[test]
fn calibrations_have_the_standard_deviations_that_the_poses_promise() {
    check(40);
}

#[test]
#[ignore = "long: scripts/test-all runs it"]
fn ten_thousand_calibrations_have_the_standard_deviations_that_the_poses_promise() {
    check(10_000);
}
