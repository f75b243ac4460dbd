//! Tests of the reference cases of the design problem, and of what every design must keep.

use calibrant::design::{Design, DesignProblem, DesignSettings, DesignStatus, design, evaluate};
use calibrant::information::Criterion;
use calibrant::information::criterion::{
    AOptimality, COptimality, DOptimality, EOptimality, IOptimality, MOptimality,
};
use calibrant::motion::{InputNoise, JerkControlledMotion, KnownEnds, Limits, MotionClock, Rest, Trust};
use calibrant::report::{About, design_sheet};
use calibrant::sensor::{Sensor, SensorModel, SensorParameters};
use nalgebra::{DVector, Vector3};

/// A case of the specification: its limits, the trust, the reference value of the A-criterion of one axis, and the tolerance.
struct Case {
    name: &'static str,
    limits: Limits,
    trust: Trust,
    reference: f64,
    tolerance: f64,
}

/// The same limit for all axes.
fn all(limit: f64) -> Option<Vector3<f64>> {
    Some(Vector3::repeat(limit))
}

fn cases() -> Vec<Case> {
    let d1 = Limits { acceleration_mps2: all(30.0), jerk_mps3: all(30.0), ..Limits::default() };
    vec![
        Case {
            name: "D1",
            limits: d1.clone(),
            trust: Trust::Known,
            reference: 3.965_463_8e-10,
            tolerance: 1e-6,
        },
        Case {
            name: "D2",
            limits: Limits { intercept_mps2: all(30.0), jerk_mps3: all(30.0), ..Limits::default() },
            trust: Trust::Known,
            reference: 3.973_324_1e-10,
            tolerance: 1e-6,
        },
        Case {
            name: "D3",
            limits: Limits { velocity_mps: all(10.0), displacement_m: all(10.0), rest: Rest::Both, ..d1 },
            trust: Trust::Known,
            reference: 3.990_274_9e-10,
            tolerance: 2e-4, // its reference keeps the limits at ten times of each interval only
        },
        Case {
            name: "D4",
            limits: Limits { acceleration_mps2: all(20.0), jerk_mps3: all(20.0), ..Limits::default() },
            trust: Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 }),
            reference: 1.103_672e-5,
            tolerance: 1e-6,
        },
    ]
}

fn problem<'a>(
    sensor: &'a Sensor,
    limits: &'a Limits,
    trust: Trust,
    criterion: Criterion,
) -> DesignProblem<'a> {
    DesignProblem {
        sensor,
        at: SensorParameters::identity(),
        intervals: 10,
        interval_s: 1.0,
        rate_hz: 10.0,
        trust,
        known_ends: KnownEnds::Start,
        gravity: None,
        clock: MotionClock::default(),
        limits,
        criterion,
        prior: None,
    }
}

fn a_optimality(parameters: usize) -> Criterion {
    Criterion::A(AOptimality { scale: DVector::repeat(parameters, 1.0) })
}

/// The motion keeps its limits at 10 000 times, by integration of its jerk without use of the nodes.
fn assert_admissible(name: &str, design: &Design, limits: &Limits) {
    let motion = &design.optimal.motion;
    let duration = motion.times_s()[motion.intervals()];
    let steps = 10_000_u32.div_ceil(motion.intervals() as u32) * motion.intervals() as u32;
    let dt = duration / f64::from(steps);
    let within = |what: &str, value: f64, limit: Option<Vector3<f64>>, axis: usize, t: f64| {
        if let Some(limit) = limit {
            let excess = value.abs() / limit[axis] - 1.0;
            assert!(excess <= 1e-9, "{name}: {what} of axis {axis} exceeds its limit by {excess:e} at {t} s");
        }
    };
    let (jerk, intercept) = (motion.jerk_mps3(), motion.intercept_mps2());
    for axis in 0..3 {
        // exact within each interval: the jerk is constant
        let (mut v, mut d) = (0.0, 0.0);
        for step in 0..steps {
            let t = f64::from(step) * dt;
            let (i, _) = motion.locate(t + 0.5 * dt);
            let (a, u) = (motion.acceleration_at(t)[axis], jerk[i][axis]);
            within("acceleration", a, limits.acceleration_mps2, axis, t);
            within("jerk", u, limits.jerk_mps3, axis, t);
            within("intercept", intercept[i][axis], limits.intercept_mps2, axis, t);
            within("velocity", v, limits.velocity_mps, axis, t);
            within("displacement", d, limits.displacement_m, axis, t);
            d += v * dt + a * dt * dt / 2.0 + u * dt.powi(3) / 6.0;
            v += a * dt + u * dt * dt / 2.0;
        }
        if limits.rest == Rest::Both {
            assert!(v.abs() < 1e-9, "{name}: axis {axis} ends at {v} m/s");
        }
    }
}

#[test]
fn the_reference_cases_are_reached_from_every_seed() {
    let sensor = Sensor::memsic_mxd2020u();
    for case in cases() {
        for seed in 1..=2 {
            let problem = problem(&sensor, &case.limits, case.trust, a_optimality(6));
            let settings = DesignSettings { seed, certificate: false, ..DesignSettings::default() };
            let design = design(&problem, &settings, &|_| ()).expect("solved");
            let ratio = design.optimal.value / (3.0 * case.reference);
            assert!(ratio <= 1.0 + case.tolerance, "{} seed {seed}: {ratio}", case.name);
            // far below would be a bug: D1 to D3 have no better optimum; D4's is better by no more than its
            // reference's rounding
            assert!(ratio >= 1.0 - 1e-6, "{} seed {seed}: {ratio}", case.name);
            assert_eq!(design.status, DesignStatus::Converged, "{} seed {seed}", case.name);
            assert!(design.initial.value > design.optimal.value);
            let best = design.starts.iter().map(|start| start.value).fold(f64::INFINITY, f64::min);
            let agreed = design.starts.iter().filter(|start| start.value <= best * (1.0 + 1e-7)).count();
            assert!(design.starts.len() == 90 || agreed >= 10, "{} seed {seed}: a start is lost", case.name);
            assert_admissible(case.name, &design, &case.limits);
        }
    }
}

/// What an engineer types after the reference cases: a stage with limits on velocity and displacement. The
/// values to reach are the best of IPOPT's multistart (b, c), and those of the first version of this solver.
/// The work done is part of the test: each start took 170 iterations in case c before it had second derivatives.
#[test]
fn realistic_limits_take_few_iterations() {
    let limits = Limits {
        acceleration_mps2: all(10.0),
        jerk_mps3: all(30.0),
        velocity_mps: all(2.0),
        displacement_m: all(0.5),
        rest: Rest::Both,
        ..Limits::default()
    };
    let diagonal = Sensor::memsic_mxd2020u();
    let full = Sensor { model: SensorModel::Full, ..diagonal.clone() };
    let noisy = Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 });
    for (name, sensor, trust, intervals, reach, iterations) in [
        ("a", &diagonal, Trust::Known, 20, 1.2335e-9, 10),
        ("b", &full, Trust::Known, 20, 1.3316e-9, 20),
        ("c", &full, noisy, 20, 1.8749e-5, 25),
        ("d", &diagonal, noisy, 100, 3.3265e-6, 12),
    ] {
        let problem = DesignProblem {
            intervals,
            interval_s: 10.0 / intervals as f64,
            ..problem(sensor, &limits, trust, a_optimality(sensor.parameter_list().len()))
        };
        let settings = DesignSettings { certificate: false, ..DesignSettings::default() };
        let design = design(&problem, &settings, &|_| ()).expect("solved");
        assert!(design.optimal.value <= reach, "{name}: {}", design.optimal.value);
        assert_admissible(name, &design, &limits);
        let (starts, ended) = (design.starts.len(), design.starts_converged());
        assert!(ended * 100 >= starts * 95, "{name}: {ended} of {starts} starts converged");
        assert!(design.iterations <= iterations * starts, "{name}: {} in {starts}", design.iterations);
    }
}

/// A search that is given time in place of starts ends after it, and is as good as one with few starts.
#[test]
fn a_search_may_be_given_a_time() {
    let sensor = Sensor { model: SensorModel::Full, ..Sensor::memsic_mxd2020u() };
    let case = &cases()[2];
    let problem = problem(&sensor, &case.limits, case.trust, a_optimality(12));
    let few = DesignSettings { starts: 1, certificate: false, ..DesignSettings::default() };
    let one = design(&problem, &few, &|_| ()).expect("solved");
    let long = design(&problem, &DesignSettings { seconds: Some(3.0), ..few }, &|_| ()).expect("solved");
    let (starts, value) = (long.starts.len(), long.optimal.value);
    assert!(starts > one.starts.len(), "{starts}");
    assert!(value <= one.optimal.value * (1.0 + 1e-8), "{value} {}", one.optimal.value);
    assert_eq!(long.status, DesignStatus::Converged);
}

/// A search that may end at a gap ends early where it is reached, after the same starts for any number of
/// threads, and says so plainly where it is not.
#[test]
fn a_search_ends_at_the_gap_that_is_asked_for() {
    let sensor = Sensor::memsic_mxd2020u();
    let case = &cases()[2];
    let run = |threads: usize, gap: f64| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("pool");
        let problem = problem(&sensor, &case.limits, case.trust, a_optimality(6));
        let settings = DesignSettings { gap: Some(gap), ..DesignSettings::default() };
        pool.install(|| design(&problem, &settings, &|_| ()))
    };
    let (one, three) = (run(1, 0.01).expect("solved"), run(3, 0.01).expect("solved"));
    assert_eq!(one.optimal.motion, three.optimal.motion);
    assert_eq!(one.starts, three.starts);
    assert_eq!(one.gap_is_reached(), Some(true));
    assert!(one.starts.len() < 30, "{}", one.starts.len());
    let says = |design: &Design| design_sheet(design, &About::default()).text(10_000);
    assert!(says(&one).contains("is proved: it is "), "{}", says(&one));
    assert!(says(&one).contains(&format!("reached after {} of 90 starts", one.starts.len())));
    // the bound is looser than that
    let none = run(2, 1e-9).expect("solved");
    assert_eq!(none.gap_is_reached(), Some(false));
    assert!(says(&none).contains("NOT reached"), "{}", says(&none));
    for nonsense in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        let error = run(1, nonsense).expect_err("nonsense").to_string();
        assert!(error.contains("gap"), "{error}");
    }
}

#[test]
fn the_result_does_not_depend_on_the_number_of_threads() {
    let sensor = Sensor::memsic_mxd2020u();
    let case = &cases()[2];
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("pool");
        let problem = problem(&sensor, &case.limits, case.trust, a_optimality(6));
        let settings = DesignSettings { starts: 6, certificate: false, ..DesignSettings::default() };
        pool.install(|| design(&problem, &settings, &|_| ()).expect("solved"))
    };
    let (one, three) = (run(1), run(3));
    assert_eq!(one.optimal.motion, three.optimal.motion);
    assert_eq!(one.starts, three.starts);
}

/// The best motion of every criterion is better in its own criterion than the best motions of the others.
#[test]
#[ignore = "long: scripts/test-all runs it"]
fn every_criterion_is_served_best_by_its_own_design() {
    let limits = Limits {
        acceleration_mps2: all(20.0),
        jerk_mps3: all(30.0),
        velocity_mps: all(12.0),
        ..Limits::default()
    };
    let noise = Trust::Noisy(InputNoise { floor_mps3: 1e-3, ratio: 1e-3 });
    for (model, trust, starts) in [
        (SensorModel::ScaleBias, Trust::Known, 20),
        (SensorModel::ScaleBias, noise, 20),
        (SensorModel::Full, Trust::Known, 12),
        (SensorModel::Full, noise, 4),
    ] {
        let sensor = Sensor { noise_mps2: Some(Vector3::repeat(0.01)), ..Sensor::triaxial(model) };
        let size = sensor.parameter_list().len();
        let scale = DVector::from_fn(size, |i, _| if i < 3 { 0.1 } else { 0.005 });
        let range = IOptimality::new(&sensor.parameter_list(), &SensorParameters::identity(), 20.0);
        let criteria = [
            Criterion::A(AOptimality { scale: scale.clone() }),
            Criterion::D(DOptimality { scale: scale.clone() }),
            Criterion::E(EOptimality { scale: scale.clone() }),
            Criterion::M(MOptimality { scale: scale.clone() }),
            Criterion::C(COptimality { weights: DVector::from_fn(size, |i, _| f64::from(u8::from(i == 3))) }),
            Criterion::I(range.expect("regular")),
        ];
        let designs: Vec<_> = criteria
            .iter()
            .map(|criterion| {
                let problem =
                    DesignProblem { intervals: 4, ..problem(&sensor, &limits, trust, criterion.clone()) };
                let settings = DesignSettings { starts, certificate: false, ..DesignSettings::default() };
                let design = design(&problem, &settings, &|_| ()).expect("solved");
                assert_admissible(criterion.letter(), &design, &limits);
                design
            })
            .collect();
        for (criterion, own) in criteria.iter().zip(&designs) {
            for other in &designs {
                let value = criterion.value(other.optimal.covariance.as_ref().expect("determined"));
                let gap = criterion.gap(own.optimal.value, value);
                assert!(
                    gap <= 1e-6,
                    "{model:?} {trust:?}: the best motion for {} is {gap:e} worse than that for {}",
                    criterion.letter(),
                    other.criterion.letter()
                );
            }
        }
    }
}

/// What the elimination of the motion leaves of the scale factors is rounding, however many nodes there are.
#[test]
fn a_sine_with_known_ends_at_rest_determines_no_scale() {
    let sensor = Sensor { model: SensorModel::ScaleBias, ..Sensor::memsic_mxd2020u() };
    let (limits, size) = (Limits::default(), sensor.parameter_list().len());
    for intervals in [20, 50, 100, 200, 500, 1000, 2000] {
        for rate_hz in [2.0, 5.0, 20.0, 100.0] {
            let problem = DesignProblem {
                rate_hz,
                known_ends: KnownEnds::Both,
                ..problem(&sensor, &limits, Trust::Unknown, a_optimality(size))
            };
            let end_mps2 = |end: f64| {
                let node = |i: usize| {
                    let phase = std::f64::consts::TAU * i as f64 / intervals as f64;
                    let ramp = end * i as f64 / intervals as f64;
                    Vector3::new(9.0 * phase.sin(), 5.0 * (3.0 * phase).sin(), (7.0 * phase).sin())
                        .add_scalar(ramp)
                };
                let motion = JerkControlledMotion::uniform(1.0, (0..=intervals).map(node).collect());
                evaluate(&problem, &motion.expect("valid")).expect("evaluated")
            };
            let name = format!("{intervals} intervals at {rate_hz} Hz");
            let free: Vec<_> =
                end_mps2(0.0).undetermined.into_iter().flat_map(|group| group.parameters).collect();
            assert_eq!(free, ["scale.x", "scale.y", "scale.z"], "{name}");
            // a thousandth of the amplitude is enough to tell it, though badly
            assert!(end_mps2(9e-3).undetermined.is_empty(), "{name}");
        }
    }
}
