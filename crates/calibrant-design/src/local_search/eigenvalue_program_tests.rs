//! Designs with criterion E against those of a semidefinite program: Clarabel 0.11.1 with its cone of positive
//! semidefinite matrices, as the solver of each iteration.

use crate::{Design, DesignProblem, DesignSettings, DesignStatus, design};
use calibrant_core::information::Criterion;
use calibrant_core::information::criterion::EOptimality;
use calibrant_core::motion::{InputNoise, KnownEnds, Limits, MotionClock, Rest, Trust};
use calibrant_core::sensor::{Sensor, SensorModel, SensorParameters};
use nalgebra::{DVector, Vector3};

const NOISY: Trust = Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 });

/// The arm of the thesis's case D3, or D1 where its velocity is not limited.
fn limits(slow: bool) -> Limits {
    let all = |limit: f64| Some(Vector3::repeat(limit));
    let still = slow.then(Vector3::zeros);
    Limits {
        acceleration_mps2: all(if slow { 19.6 } else { 30.0 }),
        jerk_mps3: all(30.0),
        velocity_mps: all(10.0).filter(|_| slow),
        displacement_m: all(10.0).filter(|_| slow),
        rest: if slow { Rest::Both } else { Rest::None },
        start_acceleration_mps2: still,
        end_acceleration_mps2: still,
        ..Limits::default()
    }
}

/// The best motion for criterion E, in parameters divided by 0.1 m/s² and 0.005.
fn best(model: SensorModel, trust: Trust, limits: &Limits, intervals: usize, interval_s: f64) -> Design {
    let sensor = Sensor { noise_mps2: Some(Vector3::repeat(2e-4)), ..Sensor::triaxial(model) };
    let parameters = if model == SensorModel::Full { 12 } else { 6 };
    let scale = DVector::from_fn(parameters, |i, _| if i < 3 { 0.1 } else { 0.005 });
    let problem = DesignProblem {
        sensor: &sensor,
        at: SensorParameters::identity(),
        intervals,
        interval_s,
        rate_hz: 10.0 / interval_s,
        trust,
        known_ends: KnownEnds::Start,
        gravity: None,
        clock: MotionClock::default(),
        limits,
        criterion: Criterion::E(EOptimality { scale }),
        prior: None,
    };
    let settings = DesignSettings { starts: 3, certificate: false, ..DesignSettings::default() };
    let design = design(&problem, &settings, &|_| ()).expect("admissible");
    assert_eq!(design.status, DesignStatus::Converged);
    design
}

fn check(design: &Design, reference: f64, within: f64, iterations_of_a_start: usize) {
    let (value, starts) = (design.optimal.value, &design.starts);
    assert!((value / reference - 1.0).abs() < within, "{value:e} {reference:e} {starts:?}");
    let iterations: usize = starts.iter().map(|start| start.iterations).sum();
    assert!(iterations < iterations_of_a_start * starts.len(), "{iterations} of {} starts", starts.len());
}

#[test]
fn axes_on_their_own_have_the_value_of_the_semidefinite_program() {
    check(
        &best(SensorModel::ScaleBias, Trust::Known, &limits(true), 5, 1.0),
        4.135_521_630_244_7e-7,
        1e-8,
        5,
    );
    check(&best(SensorModel::ScaleBias, NOISY, &limits(true), 5, 1.0), 0.911_030_622_713_7, 1e-8, 200);
}

#[test]
fn a_full_sensor_has_the_value_of_the_semidefinite_program() {
    // its starts end within 1e-7 of each other, where the interior-point method no longer tells one motion from the next
    check(&best(SensorModel::Full, Trust::Known, &limits(true), 5, 1.0), 3.621_266_909_964e-6, 1e-7, 30);
    // the bias decides, whatever the motion
    check(&best(SensorModel::Full, Trust::Known, &limits(false), 10, 1.0), 3.960_396_039_603_97e-8, 1e-8, 5);
}

#[test]
fn starts_of_long_motions_converge() {
    let design = best(SensorModel::ScaleBias, Trust::Known, &limits(true), 200, 0.1);
    assert!(design.optimal.value < 4.72e-9, "{:e}", design.optimal.value);
    assert!(design.starts.iter().all(|start| start.status == DesignStatus::Converged), "{:?}", design.starts);
}
