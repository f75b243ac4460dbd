//! The certificate against dense samples, and motions that break one limit.

use super::*;
use crate::SensorBody;
use crate::chains_for_tests::{Numbers, arm_of_all_kinds, problem_of};
use crate::information::Sensing;
use crate::spheres_for_tests::Spheres;
use calibrant_machine::chain::SpeedNearEnds;
use calibrant_machine::chain::{FrameMotion, JointState};
use nalgebra::{IsometryMatrix3, Vector3};

/// Peaks of everything on dense samples of a motion, with the limits set a little beyond them and a little within.
#[test]
fn limits_beyond_the_peaks_are_proved_and_limits_within_them_are_broken() {
    let mut numbers = Numbers(12);
    let chain = arm_of_all_kinds(4, &mut numbers);
    let spheres = Spheres(vec![
        (0, Vector3::zeros(), 0.05),
        (2, numbers.vector(0.1), 0.05),
        (4, numbers.vector(0.1), 0.05),
    ]);
    let mut problem = problem_of(&chain);
    problem.surroundings = Some(&spheres);
    problem.sensor_body = Some(SensorBody { center_m: numbers.vector(0.05), radius_m: 0.04 });
    problem.tip_speed_mps = Some(100.0);
    let knots = Knots { step_s: 0.4, intervals: 10 };
    let mut controls = DMatrix::from_fn(knots.controls(), 4, |_, _| numbers.next(0.4));
    for j in 0..4 {
        for i in [1, 2] {
            controls[(i, j)] = controls[(0, j)];
        }
    }
    // dense samples, with the chain's own functions
    let (spline, sensing) = (knots.spline(&controls), Sensing::new(&problem).expect("valid"));
    let nominal = chain.nominal();
    let (mut force, mut rate, mut tip, mut least) =
        (Vector3::<f64>::zeros(), Vector3::<f64>::zeros(), 0.0_f64, vec![f64::INFINITY; 3]);
    let mut near = vec![crate::world::Proximity::far(); 3];
    for k in 0..=40_000 {
        let t = 4.0 * f64::from(k) / 40_000.0;
        let [q, qd, qdd] = [0, 1, 2].map(|d| spline.at(t, d));
        let state = JointState { positions: &q, velocities: &qd, accelerations: &qdd };
        let felt = sensing
            .mount
            .motion(&nominal.tip_motion(state, &FrameMotion::at_rest(&-Vector3::from(sensing.links.base.0))));
        force = force.sup(&felt.specific_force.abs());
        rate = rate.sup(&felt.rate.abs());
        tip = tip.max(nominal.tip_velocity(&q, &qd).linear_mps.norm());
        let mut frames = vec![nalgebra::Isometry3::identity()];
        frames.extend(nominal.frames(&q));
        frames.pop();
        let frames: Vec<IsometryMatrix3<f64>> = frames.into_iter().map(nalgebra::convert).collect();
        crate::Surroundings::proximities(&spheres, &frames, &mut near);
        for (least, near) in least.iter_mut().zip(&near) {
            *least = least.min(near.distance_m);
        }
    }
    let nearest = least.iter().copied().fold(f64::INFINITY, f64::min);
    for (factor, kept) in [(1.001, Kept::Proved), (0.999, Kept::Broken)] {
        problem.force_range_mps2 = force * factor;
        problem.rate_range_radps = rate * factor;
        problem.tip_speed_mps = Some(tip * factor);
        problem.clearance_m = nearest / factor;
        let proofs = certify(&problem, knots, &controls);
        let of = |limit| proofs.iter().find(|proof| proof.limit == limit).copied().expect("there");
        for k in 0..3 {
            assert_eq!(of(TrajectoryLimit::Force(k)).kept, kept);
            assert!((of(TrajectoryLimit::Force(k)).peak / force[k] - 1.0).abs() < 1e-3);
            assert_eq!(of(TrajectoryLimit::Rate(k)).kept, kept);
        }
        assert_eq!(of(TrajectoryLimit::TipSpeed).kept, kept);
        let closest = least.iter().position(|d| *d == nearest).expect("one");
        assert_eq!(of(TrajectoryLimit::Clearance(closest)).kept, kept);
    }
}

#[test]
fn joints_are_taken_at_their_extrema() {
    let chain = arm_of_all_kinds(1, &mut Numbers(1));
    let mut problem = problem_of(&chain);
    // a bump: the peak of the position lies between knots
    let knots = Knots { step_s: 1.0, intervals: 6 };
    let controls = DMatrix::from_column_slice(9, 1, &[0.0, 0.0, 0.0, 1.0, 0.7, 0.0, 0.0, 0.0, 0.0]);
    let spline = knots.spline(&controls);
    let dense =
        |d: usize| (0..=60_000).map(|k| spline.at(f64::from(k) * 1e-4, d)[0].abs()).fold(0.0, f64::max);
    let peaks = [0, 1, 2, 3].map(dense);
    problem.joints[0].near_ends = Some(SpeedNearEnds { lower: -1.0, upper: 1.0, slope: 5.0, offset: 0.3 });
    let proofs = certify(&problem, knots, &controls);
    for (proof, peak) in proofs.iter().zip(peaks) {
        assert!((proof.peak.abs() - peak).abs() < 1e-6 && proof.kept == Kept::Proved, "{proof:?} {peak}");
    }
    let of_speed = |proofs: &[LimitProof]| {
        proofs
            .iter()
            .find(|proof| matches!(proof.limit, TrajectoryLimit::SpeedNearEnds(_)))
            .copied()
            .expect("there")
    };
    assert_eq!(of_speed(&proofs).kept, Kept::Proved);
    let used = (0..=60_000).map(|k| {
        let t = f64::from(k) * 1e-4;
        let (q, qd) = (spline.at(t, 0)[0], spline.at(t, 1)[0]);
        let up = (5.0 * (1.0 - q)).sqrt() - 0.3;
        let down = (5.0 * (q + 1.0)).sqrt() - 0.3;
        (qd / up).max(-qd / down)
    });
    let used = used.fold(0.0, f64::max);
    assert!(of_speed(&proofs).used <= used + 1e-9 && used < 1.0);
    // with that use as the limit, the motion just breaks it
    problem.joints[0].near_ends = Some(SpeedNearEnds { lower: -1.0, upper: 1.0, slope: 0.9, offset: 0.3 });
    assert_eq!(of_speed(&certify(&problem, knots, &controls)).kept, Kept::Broken);
}
