//! Tests of the bound of noisy increments: closed forms, dense sampling, and the best motions of random problems.

use super::increment_design::IncrementDesign;
use super::largest_gain::IncrementGain;
use crate::{DesignProblem, DesignSettings, Interruption, design, evaluate};
use calibrant_core::information::Criterion;
use calibrant_core::information::criterion::{
    AOptimality, COptimality, DOptimality, EOptimality, IOptimality, MOptimality,
};
use calibrant_core::motion::{InputNoise, JerkControlledMotion, KnownEnds, Limits, MotionClock, Rest, Trust};
use calibrant_core::sensor::{Sensor, SensorModel, SensorParameters};
use calibrant_core::simulate::{Purpose, Rng, initial_motion, stream};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use rand::RngExt;

fn full() -> Sensor {
    Sensor { model: SensorModel::Full, ..Sensor::memsic_mxd2020u() }
}

/// All criteria, the parameters divided by these numbers.
fn criteria(sensor: &Sensor, at: &SensorParameters, scale: &DVector<f64>) -> [Criterion; 6] {
    let weights = DVector::from_fn(scale.len(), |i, _| (i % 3) as f64);
    [
        Criterion::A(AOptimality { scale: scale.clone() }),
        Criterion::D(DOptimality { scale: scale.clone() }),
        Criterion::E(EOptimality { scale: scale.clone() }),
        Criterion::M(MOptimality { scale: scale.clone() }),
        Criterion::C(COptimality { weights }),
        Criterion::I(IOptimality::new(&sensor.parameter_list(), at, 20.0).expect("regular")),
    ]
}

/// Noise that does not depend on the jerk: a Hadamard matrix of jerks is optimal for every criterion, and
/// `C = σ²/(N U²)` for every element.
#[test]
fn noise_of_constant_sd_has_the_design_of_hadamard() {
    let sensor = full();
    let quantities = sensor.parameter_list().quantities().to_vec();
    let (floor, jerk, intervals) = (0.02, 3.0, 8);
    let variance = floor * floor / (intervals as f64 * jerk * jerk);
    let on_biases = DMatrix::from_diagonal_element(12, 12, 1e9);
    let ones = DVector::repeat(12, 1.0);
    for criterion in criteria(&sensor, &SensorParameters::identity(), &ones) {
        let design = IncrementDesign {
            criterion: &criterion,
            quantities: &quantities,
            matrix: Matrix3::identity(),
            noise: InputNoise { floor_mps3: floor, ratio: 0.0 },
            jerk: vec![Vector3::repeat(jerk); intervals],
            start: Vector3::repeat(1.0),
            on_biases: &on_biases,
            prior: None,
        };
        let bound = design.bound(&Interruption::default()).expect("bounded");
        let best = DVector::from_fn(12, |i, _| if i < 3 { 1e-9 } else { variance });
        let best = criterion.value(&DMatrix::from_diagonal(&best));
        let gap = criterion.gap(best, bound);
        assert!((-1e-9..2e-3 * 9.0).contains(&gap), "{} {gap}", criterion.letter());
    }
}

#[test]
fn the_largest_gain_is_that_of_dense_sampling() {
    let mut rng = stream(11, Purpose::Motion, 0);
    for _ in 0..20 {
        let mut omega = || {
            let factor = Matrix3::from_fn(|_, _| rng.random_range(-1.0..1.0));
            factor * factor.transpose()
        };
        let omega = [omega(), omega(), omega()];
        let (floor, ratio) = (10f64.powf(rng.random_range(-3.0..0.0)), rng.random_range(0.0..0.1));
        let most = Vector3::from_fn(|_, _| rng.random_range(1.0..40.0));
        let gain = IncrementGain { omega, floor, ratio };
        let largest = gain.largest(&most);
        let mut sampled = 0.0_f64;
        for code in 0..41_usize.pow(3) {
            // fine near zero, where the noise is at its floor
            let u = Vector3::from_fn(|m, _| {
                let x = (code / 41_usize.pow(m as u32) % 41) as f64 / 20.0 - 1.0;
                most[m] * x.powi(3)
            });
            sampled = sampled.max(gain.at(&u));
        }
        assert!(largest.bound >= sampled, "{} {sampled}", largest.bound);
        let (value, place) = largest.places[0];
        assert!((gain.at(&place) / value - 1.0).abs() < 1e-12);
        assert!(largest.bound <= value * 1.0003, "{} {value}", largest.bound);
    }
}

/// A random problem of a full sensor.
fn random(rng: &mut Rng) -> (Limits, SensorParameters, InputNoise, usize, Option<DMatrix<f64>>) {
    let mut all = |low: f64, high: f64| Some(Vector3::from_fn(|_, _| rng.random_range(low..high)));
    let mut limits =
        Limits { acceleration_mps2: all(3.0, 20.0), jerk_mps3: all(5.0, 40.0), ..Limits::default() };
    let (velocity, displacement) = (all(1.0, 5.0), all(0.5, 3.0));
    if rng.random_bool(0.5) {
        (limits.velocity_mps, limits.displacement_m) = (velocity, displacement);
        limits.rest = Rest::Both;
    }
    let mut at = SensorParameters::identity();
    if rng.random_bool(0.7) {
        at.matrix += Matrix3::from_fn(|_, _| rng.random_range(-0.3..0.3));
    }
    let floor_mps3 = 10f64.powf(rng.random_range(-2.5..-0.5));
    let noise = InputNoise { floor_mps3, ratio: rng.random_range(0.0..0.05) };
    let factor = DMatrix::from_fn(12, 12, |_, _| rng.random_range(-300.0..300.0));
    let prior = rng.random_bool(0.5).then(|| &factor * factor.transpose());
    (limits, at, noise, rng.random_range(5..9_usize), prior)
}

#[test]
fn no_random_motion_and_no_optimum_beats_the_bound() {
    let sensor = full();
    let quantities = sensor.parameter_list().quantities().to_vec();
    for number in 0..6 {
        let mut rng = stream(13, Purpose::Motion, number);
        let (limits, at, noise, intervals, prior) = random(&mut rng);
        let scale = DVector::from_fn(12, |i, _| if i < 3 { 0.1 } else { 0.005 });
        for (place, criterion) in criteria(&sensor, &at, &scale).into_iter().enumerate() {
            let problem = DesignProblem {
                sensor: &sensor,
                at,
                intervals,
                interval_s: 0.5,
                rate_hz: 10.0,
                trust: Trust::Noisy(noise),
                known_ends: KnownEnds::Start,
                limits: &limits,
                criterion: criterion.clone(),
                prior: prior.clone(),
                gravity: None,
                clock: MotionClock::default(),
            };
            let rest = JerkControlledMotion::uniform(0.5, vec![Vector3::zeros(); intervals + 1]);
            let setting = problem.setting().expect("a setting");
            let still = setting.information(&rest.expect("a motion")).expect("determined");
            let (most, jerk) = (limits.acceleration_mps2.expect("set"), limits.jerk_mps3.expect("set"));
            let increments = IncrementDesign {
                criterion: &criterion,
                quantities: &quantities,
                matrix: at.matrix,
                noise,
                jerk: vec![jerk.inf(&(most * 4.0)); intervals],
                start: most,
                on_biases: &prior.as_ref().map_or_else(|| still.clone(), |prior| &still + prior),
                prior: prior.as_ref(),
            };
            let bound = increments.bound(&Interruption::default()).expect("bounded");
            let gap = |motion: &JerkControlledMotion| {
                criterion.gap(evaluate(&problem, motion).expect("evaluated").value, bound)
            };
            for _ in 0..5 {
                let motion = initial_motion(intervals, 0.5, 3, &limits, &mut rng).expect("admissible");
                assert!(gap(&motion) >= -1e-9, "{number} {}", criterion.letter());
            }
            // one criterion of each problem, in turn: a search takes longer
            if place == number as usize {
                let settings = DesignSettings { starts: 1, certificate: false, ..DesignSettings::default() };
                let best = design(&problem, &settings, &|_| ()).expect("solved");
                let gap = gap(&best.optimal.motion);
                assert!(gap >= -1e-9, "{number} {} {gap}", criterion.letter());
            }
        }
    }
}

/// The stage of 20 intervals, full and noisy. The best motion known has 1.848 827e-5.
#[test]
fn the_bound_of_the_stage_is_five_percent_below_its_best_motion() {
    let sensor = full();
    let quantities = sensor.parameter_list().quantities().to_vec();
    let criterion = Criterion::A(AOptimality { scale: DVector::repeat(12, 1.0) });
    let design = IncrementDesign {
        criterion: &criterion,
        quantities: &quantities,
        matrix: Matrix3::identity(),
        noise: InputNoise { floor_mps3: 0.01, ratio: 0.01 },
        jerk: vec![Vector3::repeat(30.0); 20],
        start: Vector3::repeat(10.0),
        // at rest, to within what the biases add
        on_biases: &DMatrix::from_diagonal_element(12, 12, 5e7),
        prior: None,
    };
    let bound = design.bound(&Interruption::default()).expect("bounded");
    assert!((1.753e-5..1.848_827e-5).contains(&bound), "{bound}");
}
