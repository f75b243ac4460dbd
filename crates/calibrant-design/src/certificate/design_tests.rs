//! Tests of the certificate of a whole design: for every criterion, trust and model.

use crate::{Certificate, DesignProblem, Interruption, certificate, evaluate, limit_use};
use calibrant_core::error::Result;
use calibrant_core::information::Criterion;
use calibrant_core::information::criterion::{
    AOptimality, COptimality, DOptimality, EOptimality, IOptimality, MOptimality,
};
use calibrant_core::motion::{
    InputNoise, JerkControlledMotion, KnownEnds, Limits, MotionClock, MotionGravity, Rest, Trust,
};
use calibrant_core::sensor::{Sensor, SensorModel, SensorParameters};
use calibrant_core::simulate::{Purpose, initial_motion, stream};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

fn certify(problem: &DesignProblem<'_>, value: f64) -> Result<Option<Certificate>> {
    let bound = certificate::lower_bound(problem, &Interruption::default())?;
    Ok(bound.map(|bound| bound.certificate(&problem.criterion, value, problem.floor())))
}

fn problem<'a>(sensor: &'a Sensor, limits: &'a Limits, trust: Trust) -> DesignProblem<'a> {
    let scale = DVector::repeat(sensor.parameter_list().len(), 1.0);
    DesignProblem {
        sensor,
        at: SensorParameters::identity(),
        intervals: 10,
        interval_s: 1.0,
        rate_hz: 10.0,
        trust,
        known_ends: if trust == Trust::Unknown { KnownEnds::Both } else { KnownEnds::Start },
        gravity: None,
        clock: MotionClock::default(),
        limits,
        criterion: Criterion::A(AOptimality { scale }),
        prior: None,
    }
}

fn box_limits(limit: f64) -> Limits {
    let all = Some(Vector3::repeat(limit));
    Limits { acceleration_mps2: all, jerk_mps3: all, ..Limits::default() }
}

/// Process noise on the jerk, as in the report.
const NOISY: Trust = Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 });

#[test]
fn the_certificates_of_d1_and_d4_reach_the_reference() {
    let sensor = Sensor { axes: 1, ..Sensor::memsic_mxd2020u() };
    for (limit, trust, f, sd) in
        [(30.0, Trust::Known, 3.965_463_8e-10, 7.118_84e-7), (20.0, NOISY, 1.103_672e-5, 3.320_37e-3)]
    {
        let limits = box_limits(limit);
        let certificate =
            certify(&problem(&sensor, &limits, trust), f).expect("determined").expect("bounded");
        assert!((-1e-7..2e-3).contains(&certificate.gap), "{certificate:?}");
        // the reference prints six digits, of which those of D4 agree with its f to 7e-6
        let scale = sd / certificate.sd_lower_bound[1] - 1.0;
        assert!((-1e-5..1e-3).contains(&scale), "{certificate:?}");
        assert!(certificate.explanation.contains("scale factors:"), "{}", certificate.explanation);
    }
}

#[test]
fn a_bound_that_is_met_exactly_is_not_passed_by_rounding() {
    let sensor = Sensor { axes: 1, ..Sensor::memsic_mxd2020u() };
    let limits = box_limits(30.0);
    let mut problem = problem(&sensor, &limits, Trust::Known);
    problem.criterion = Criterion::C(COptimality { weights: DVector::from_vec(vec![1.0, 0.0]) });
    // without a mean the bias is known as well as it can be
    for number in 1..100 {
        let size = 0.1 * f64::from(number);
        problem.prior = Some(DMatrix::from_diagonal(&DVector::from_vec(vec![100.0 / size, 4e4 * size])));
        let nodes = (0..=10).map(|i| Vector3::repeat(size * (f64::from(i) - 5.0) / 5.0)).collect();
        let motion = JerkControlledMotion::uniform(1.0, nodes).expect("a motion");
        let value = evaluate(&problem, &motion).expect("determined").value;
        let certificate = certify(&problem, value).expect("determined").expect("bounded");
        assert!((0.0..1e-9).contains(&certificate.gap), "{number}: {}", certificate.gap);
    }
}

#[test]
fn no_motion_beats_the_certificate_of_any_criterion() {
    check_certificates(&box_limits(5.0), None);
}

#[test]
fn no_motion_beats_the_certificate_with_gravity() {
    let slanted = MotionGravity::of_force(Vector3::new(3.0, -4.0, 8.4));
    let exact = MotionGravity {
        sd_mps2: 0.0,
        tilt_sd_rad: 0.0,
        ..MotionGravity::of_force(Vector3::new(0.0, 0.0, 9.8))
    };
    let at_rest = Limits { velocity_mps: Some(Vector3::repeat(2.0)), rest: Rest::Both, ..box_limits(5.0) };
    check_certificates(&box_limits(5.0), Some(slanted));
    check_certificates(&at_rest, Some(exact));
}

/// The mean of a motion that ends at rest is small, so that the bound of the bias is close.
#[test]
fn the_bound_of_a_bias_that_gravity_acts_on_is_close_where_the_motion_ends_at_rest() {
    let sensor = Sensor { axes: 1, ..Sensor::memsic_mxd2020u() };
    let limits = Limits {
        velocity_mps: Some(Vector3::repeat(10.0)),
        displacement_m: Some(Vector3::repeat(10.0)),
        rest: Rest::Both,
        ..box_limits(30.0)
    };
    let gravity = MotionGravity { tilt_sd_rad: 0.0, ..MotionGravity::of_force(Vector3::new(9.8, 0.0, 0.0)) };
    let problem = DesignProblem { gravity: Some(gravity), ..problem(&sensor, &limits, Trust::Known) };
    let settings = crate::DesignSettings { starts: 20, ..crate::DesignSettings::default() };
    let design = crate::design(&problem, &settings, &|_| ()).expect("determined");
    let certificate = design.certificate.as_ref().expect("bounded");
    let excess = design.optimal.sd()[0] / certificate.sd_lower_bound[0] - 1.0;
    assert!((0.0..0.03).contains(&excess), "{excess} {certificate:?}");
    assert!((0.0..0.06).contains(&certificate.gap), "{certificate:?}");
    // without the mean of the motion: σ²/M (1 + g²/v), v the motion variance of a sample
    let sd = design.optimal.sd();
    let still = 2e-4 / 101_f64.sqrt();
    let expected = (still * still + 9.8 * 9.8 * sd[1] * sd[1]).sqrt();
    assert!((sd[0] / expected - 1.0).abs() < 0.05, "{} {expected}", sd[0]);
}

fn check_certificates(limits: &Limits, gravity: Option<MotionGravity>) {
    for model in [SensorModel::ScaleBias, SensorModel::Full] {
        for (number, trust) in [Trust::Known, NOISY, Trust::Unknown].into_iter().enumerate() {
            if model == SensorModel::Full && trust == Trust::Unknown {
                continue; // two readings do not determine four parameters
            }
            let sensor = Sensor { model, ..Sensor::memsic_mxd2020u() };
            let mut problem = DesignProblem { gravity, ..problem(&sensor, limits, trust) };
            problem.intervals = 6;
            if model == SensorModel::Full {
                // not the nominal one: the weights of I are diagonal there
                problem.at.matrix = Matrix3::new(1.0, 0.3, -0.05, 0.02, 0.98, 0.2, 0.1, -0.4, 1.02);
            }
            let list = sensor.parameter_list();
            let size = list.len();
            let ones = DVector::repeat(size, 1.0);
            let prior = DMatrix::from_fn(size, size, |i, j| 1e4 / (1.0 + (i as f64 - j as f64).abs()));
            let mut rng = stream(3, Purpose::Motion, number as u64);
            // as far as the limits allow
            let larger = |motion: &JerkControlledMotion| {
                let used = limit_use(limits, 3, motion);
                let most = used.iter().filter(|found| found.limit > 0.0);
                0.999 / most.map(|found| found.value.abs() / found.limit).fold(0.01, f64::max)
            };
            let motions: Vec<JerkControlledMotion> = (0..20)
                .map(|_| {
                    let motion = initial_motion(6, 1.0, 3, limits, &mut rng).expect("admissible");
                    let nodes = motion.acceleration_mps2().iter().map(|a| a * larger(&motion)).collect();
                    JerkControlledMotion::uniform(1.0, nodes).expect("a motion")
                })
                .collect();
            for criterion in [
                Criterion::A(AOptimality { scale: ones.clone() }),
                Criterion::D(DOptimality { scale: ones.clone() }),
                Criterion::E(EOptimality { scale: ones.clone() }),
                Criterion::M(MOptimality { scale: ones.clone() }),
                Criterion::C(COptimality { weights: ones.clone() }),
                Criterion::I(IOptimality::new(&list, &problem.at, 20.0).expect("regular")),
            ] {
                // a prior is the same with gravity as without
                let with_prior = gravity.is_none().then(|| Some(prior.clone()));
                for prior in [None].into_iter().chain(with_prior) {
                    problem.criterion = criterion.clone();
                    problem.prior = prior;
                    let certificate = certify(&problem, 1.0).expect("determined").expect("bounded");
                    for motion in &motions {
                        let value = evaluate(&problem, motion).expect("determined").value;
                        let letter = criterion.letter();
                        assert!(
                            value >= certificate.lower_bound,
                            "{letter} {value} {certificate:?} {trust:?}"
                        );
                    }
                }
            }
        }
    }
}
