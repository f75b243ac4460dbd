//! Tests of the experiments of the thesis's chapter 4: the surface, the loop of Figure 2.

use calibrant::design::{DesignSettings, SurfaceSettings, TraceSurface, trace_surface};
use calibrant::information::criterion::{AOptimality, Criterion};
use calibrant::motion::{InputNoise, JerkControlledMotion, KnownEnds, Limits, MotionClock, Trust};
use calibrant::sensor::Sensor;
use calibrant::study::{DesignStudy, DesignStudyProblem, StudySettings, run_design_study};
use nalgebra::{DVector, Vector3};

/// The process noise of the report.
const NOISE: Trust = Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 });

fn surface(start_mps2: f64) -> TraceSurface {
    let settings = SurfaceSettings { jerk_mps3: 0.5, points: 41, start_mps2, interval_s: 1.0, rate_hz: 10.0 };
    trace_surface(&Sensor::memsic_mxd2020u(), &settings).expect("valid")
}

fn problem(sensor: &Sensor, trust: Trust, bound: f64, sensors: usize) -> DesignStudyProblem<'_> {
    let limits = Limits {
        intercept_mps2: Some(Vector3::repeat(bound)),
        jerk_mps3: Some(Vector3::repeat(bound)),
        ..Limits::default()
    };
    DesignStudyProblem {
        sensor,
        intervals: 10,
        interval_s: 1.0,
        rate_hz: 10.0,
        trust,
        known_ends: KnownEnds::Start,
        gravity: None,
        clock: MotionClock::default(),
        limits,
        criterion: Criterion::A(AOptimality { scale: DVector::repeat(6, 1.0) }),
        initial: None,
        sensors,
        motions_shown: 3,
    }
}

fn settings(seed: u64) -> StudySettings {
    let design = DesignSettings { starts: 3, certificate: false, ..DesignSettings::default() };
    StudySettings { seed, design, ..StudySettings::default() }
}

fn run(trust: Trust, bound: f64, sensors: usize) -> DesignStudy {
    let sensor = Sensor::memsic_mxd2020u();
    run_design_study(&problem(&sensor, trust, bound, sensors), &settings(1), &|_| ()).expect("determined")
}

#[test]
fn the_surface_is_the_closed_form_and_has_a_hole_at_rest() {
    for start in [0.0, 0.2] {
        let surface = surface(start);
        for (i, u1) in surface.jerk_mps3.iter().enumerate() {
            for (j, u2) in surface.jerk_mps3.iter().enumerate() {
                // SPEC: A = σ² (M + S₂)/(M S₂ − S₁²), per axis
                let a = |k: i32| {
                    let t = f64::from(k) / 10.0;
                    start + u1 * t.min(1.0) + u2 * (t - 1.0).max(0.0)
                };
                let (m, s1) = (21.0, (0..=20).map(a).sum::<f64>());
                let s2 = (0..=20).map(|k| a(k).powi(2)).sum::<f64>();
                match surface.log10_trace[i][j] {
                    Some(found) => {
                        let closed = (4e-8 * (m + s2) / (m * s2 - s1 * s1)).log10();
                        assert!((found - closed).abs() < 1e-9, "{u1} {u2}: {found} {closed}");
                    }
                    None => assert_eq!((*u1, *u2), (0.0, 0.0), "only a motion at rest tells nothing"),
                }
            }
        }
        assert_eq!(surface.log10_trace[20][20], None);
    }
}

#[test]
fn the_surface_is_the_same_for_the_mirrored_motion_and_least_at_the_corners() {
    let surface = surface(0.0);
    let n = surface.jerk_mps3.len();
    let at = |i: usize, j: usize| surface.log10_trace[i][j];
    let mut least = f64::INFINITY;
    for i in 0..n {
        for j in 0..n {
            let mirrored = at(n - 1 - i, n - 1 - j);
            assert_eq!(at(i, j).is_some(), mirrored.is_some());
            if let (Some(here), Some(mirrored)) = (at(i, j), mirrored) {
                assert!((here - mirrored).abs() < 1e-12);
                least = least.min(here);
            }
        }
    }
    assert_eq!(at(0, 0).map(|corner| corner - least < 1e-12), Some(true), "both jerks at their limit");
    // larger jerks of the same shape are better, all along the diagonals
    for step in 21..n - 1 {
        assert!(at(step, step) > at(step + 1, step + 1) && at(step, 40 - step) > at(step + 1, 39 - step));
    }
}

#[test]
fn every_sensor_goes_round_the_loop_and_gains() {
    for (trust, bound) in [(Trust::Known, 30.0), (NOISE, 20.0)] {
        let study = run(trust, bound, 4);
        assert_eq!((study.outcomes.len(), study.motions_shown), (4, 3));
        let motions: Vec<&JerkControlledMotion> =
            study.outcomes.iter().map(|outcome| &outcome.initial.motion).collect();
        assert!(motions[0] != motions[1] && motions[1] != motions[2], "each has a motion of its own");
        assert_eq!(study.design.initial.motion, study.outcomes[0].initial.motion);
        assert_eq!(study.design.optimal.motion, study.outcomes[0].optimal.motion);
        for outcome in &study.outcomes {
            let (before, after) = (&outcome.initial, &outcome.optimal);
            assert_eq!((before.status, after.status), ("converged", "converged"));
            assert!(after.predicted_criterion <= before.predicted_criterion);
            assert!(after.trace < before.trace, "{} {}", after.trace, before.trace);
            // promised at the estimate, stated by the calibration: apart by the error of the estimate
            assert!((after.predicted_criterion / after.trace - 1.0).abs() < 0.05);
            let peak = |values: &[Vector3<f64>]| values.iter().fold(0.0_f64, |peak, v| peak.max(v.amax()));
            assert!(peak(&after.motion.jerk_mps3()) <= bound * (1.0 + 1e-9));
            assert!(peak(&after.motion.intercept_mps2()) <= bound * (1.0 + 1e-9));
        }
        for row in &study.summary {
            assert!(row.predicted.value >= 1.0, "{}: {}", row.initial.name, row.predicted.value);
            assert!(row.realised.standard_error.is_some_and(|error| error > 0.0));
        }
        assert!(study.trace.optimal.most < study.trace.initial.least);
    }
}

#[test]
fn a_given_motion_is_the_initial_one_of_every_sensor() {
    let sensor = Sensor::memsic_mxd2020u();
    let nodes = (0..=10).map(|i| Vector3::repeat(f64::from(i % 3))).collect();
    let motion = JerkControlledMotion::uniform(1.0, nodes).expect("valid");
    let problem = DesignStudyProblem { initial: Some(&motion), ..problem(&sensor, Trust::Known, 30.0, 2) };
    let study = run_design_study(&problem, &settings(1), &|_| ()).expect("determined");
    assert!(study.initial_given);
    assert!(study.outcomes.iter().all(|outcome| outcome.initial.motion == motion));
    assert_eq!(study.design.initial.motion, motion);
}

#[test]
fn sensors_do_not_depend_on_their_number_and_seeds_differ() {
    let (few, many) = (run(Trust::Known, 30.0, 2), run(Trust::Known, 30.0, 3));
    for (one, other) in few.outcomes.iter().zip(&many.outcomes) {
        assert_eq!((&one.truth, &one.optimal.values), (&other.truth, &other.optimal.values));
        assert_eq!(one.optimal.motion, other.optimal.motion);
    }
    let sensor = Sensor::memsic_mxd2020u();
    let problem = problem(&sensor, Trust::Known, 30.0, 1);
    let other = run_design_study(&problem, &settings(2), &|_| ()).expect("determined");
    assert!(other.outcomes[0].truth != few.outcomes[0].truth);
    assert!(other.outcomes[0].initial.motion != few.outcomes[0].initial.motion);
}

#[test]
fn what_forbids_a_design_is_said() {
    let sensor = Sensor::memsic_mxd2020u();
    let unknown = problem(&sensor, Trust::Unknown, 30.0, 1);
    assert!(unknown.obstacle().is_some_and(|reason| reason.contains("nothing is known of the motion")));
    let free = DesignStudyProblem { limits: Limits::default(), ..problem(&sensor, Trust::Known, 30.0, 1) };
    assert!(free.obstacle().is_some_and(|reason| reason.contains("nothing bounds the acceleration")));
    assert_eq!(problem(&sensor, NOISE, 20.0, 1).obstacle(), None);
}
