//! Starts of long motions converge, within a number of iterations.

use crate::{Design, DesignProblem, DesignSettings, DesignStatus, Interruption, design};
use calibrant_core::information::Criterion;
use calibrant_core::information::criterion::AOptimality;
use calibrant_core::motion::{InputNoise, KnownEnds, Limits, MotionClock, Rest, Trust};
use calibrant_core::sensor::{Sensor, SensorModel, SensorParameters};
use nalgebra::{DVector, Vector3};

const NOISY: Trust = Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 });

/// One axis, intervals of 0.05 s, limits on everything.
fn long(trust: Trust, intervals: usize, settings: &DesignSettings) -> Design {
    let all = |limit: f64| Some(Vector3::repeat(limit));
    let limits = Limits {
        acceleration_mps2: all(10.0),
        jerk_mps3: all(30.0),
        velocity_mps: all(2.0),
        displacement_m: all(0.5),
        rest: Rest::Both,
        ..Limits::default()
    };
    let sensor = Sensor { axes: 1, model: SensorModel::ScaleBias, ..Sensor::memsic_mxd2020u() };
    let problem = DesignProblem {
        sensor: &sensor,
        at: SensorParameters::identity(),
        intervals,
        interval_s: 0.05,
        rate_hz: 100.0,
        trust,
        known_ends: KnownEnds::Start,
        gravity: None,
        clock: MotionClock::default(),
        limits: &limits,
        criterion: Criterion::A(AOptimality { scale: DVector::repeat(2, 1.0) }),
        prior: None,
    };
    design(&problem, settings, &|_| ()).expect("admissible")
}

/// The iterations of each start, which all converge.
fn iterations(design: &Design) -> Vec<usize> {
    for start in &design.starts {
        assert_eq!(start.status, DesignStatus::Converged, "{start:?}");
    }
    design.starts.iter().map(|start| start.iterations).collect()
}

fn settings(starts: usize) -> DesignSettings {
    DesignSettings { starts, certificate: false, ..DesignSettings::default() }
}

#[test]
fn every_start_of_300_intervals_converges_to_the_known_value() {
    let known = long(Trust::Known, 300, &settings(12));
    assert!(iterations(&known).iter().sum::<usize>() < 12 * 40, "{:?}", iterations(&known));
    // the best that is known, found by Clarabel as the solver of each iteration
    assert!(known.optimal.value < 2.735_033e-11 * (1.0 + 1e-6), "{:e}", known.optimal.value);
    let noisy = long(NOISY, 300, &settings(6));
    assert!(iterations(&noisy).iter().sum::<usize>() < 6 * 40, "{:?}", iterations(&noisy));
}

#[test]
fn starts_of_1000_intervals_converge() {
    for trust in [Trust::Known, NOISY] {
        let design = long(trust, 1000, &settings(2));
        assert!(iterations(&design).iter().all(|&count| count < 120), "{:?}", iterations(&design));
    }
}

#[test]
fn a_start_ends_where_the_search_is_interrupted() {
    let interruption = Interruption::default();
    interruption.ask();
    let design = long(Trust::Known, 300, &DesignSettings { interruption, ..settings(12) });
    assert_eq!(design.status, DesignStatus::Interrupted);
    assert_eq!(iterations_of_all(&design), 0);
}

/// Without a deadline inside a start, the first start alone would be improved.
#[test]
fn a_deadline_that_has_passed_ends_the_first_start() {
    let design = long(Trust::Known, 300, &DesignSettings { seconds: Some(0.0), ..settings(12) });
    assert_eq!(iterations_of_all(&design), 0);
    assert!(design.optimal.value.is_finite());
}

fn iterations_of_all(design: &Design) -> usize {
    design.starts.iter().map(|start| start.iterations).sum()
}
