//! Information against straightforward sums over samples, and gradients against differences.

use super::*;
use crate::TrajectoryProblem;
use crate::chains_for_tests::{Numbers, arm_of_all_kinds, problem_of};
use crate::motion::Knots;
use calibrant_machine::chain::FrameMotion;
use nalgebra::{DMatrix, Matrix4, Vector3, Vector4};

fn controls(knots: Knots, joints: usize) -> DMatrix<f64> {
    let mut numbers = Numbers(17);
    DMatrix::from_fn(knots.controls(), joints, |_, _| numbers.next(0.8))
}

const RANGE: [f64; 2] = [19.6, 8.7];

#[test]
fn plain_information_is_the_sum_over_many_samples() {
    let chain = arm_of_all_kinds(4, &mut Numbers(5));
    // growth has poles near real times where the joints are slow: six points in an interval leave a hundredth of a nat of it
    for (moving, tolerance) in [(1.0, 1e-4), (2.0, 3e-2)] {
        let mut problem = problem_of(&chain);
        problem.noise.moving = moving;
        let sensing = Sensing::new(&problem).expect("valid");
        let knots = Knots { step_s: 0.5, intervals: 12 };
        let controls = controls(knots, 4);
        let valued = PlainInformation::new(&sensing, knots, 6).at(&controls).expect("determined");

        let (spline, samples) = (knots.spline(&controls), 60_000);
        let mut moments = [Matrix4::<f64>::zeros(); 2];
        let base = FrameMotion::at_rest(&-Vector3::from(sensing.links.base.0));
        let step = knots.duration_s() / f64::from(samples);
        for k in 0..samples {
            let t = (f64::from(k) + 0.5) * step;
            let [q, qd, qdd] = [0, 1, 2].map(|d| spline.at(t, d));
            let state =
                calibrant_machine::chain::JointState { positions: &q, velocities: &qd, accelerations: &qdd };
            let tip = chain.nominal().tip_motion(state, &base);
            let felt = sensing.mount.motion(&tip);
            let s: f64 = qd.iter().zip(&sensing.growth.speeds).map(|(qd, speed)| (qd / speed).powi(2)).sum();
            let growth = 1.0 + (moving * moving - 1.0) * s / (1.0 + s);
            for (s, v, density) in [(0, felt.specific_force, 1.7e-3), (1, felt.rate, 2.4e-4)] {
                let phi = Vector4::new(1.0, v.x, v.y, v.z);
                moments[s] += phi * phi.transpose() * (step / (density * density * growth));
            }
        }
        let wanted: f64 = moments.iter().map(|moment| -3.0 * moment.determinant().ln()).sum();
        assert!((valued.value - wanted).abs() < tolerance, "{} {wanted}", valued.value);
    }
}

#[test]
fn gradients_are_those_of_differences() {
    let chain = arm_of_all_kinds(3, &mut Numbers(8));
    let knots = Knots { step_s: 0.5, intervals: 12 };
    let controls = controls(knots, 3);
    let mut numbers = Numbers(2);
    let direction = DMatrix::from_fn(knots.controls(), 3, |_, _| numbers.next(1.0));
    for criterion in [TrajectoryCriterion::D, TrajectoryCriterion::A { range: RANGE }] {
        let problem = TrajectoryProblem { criterion, ..problem_of(&chain) };
        let sensing = Sensing::new(&problem).expect("valid");
        let slope_of = |value: &mut dyn FnMut(&DMatrix<f64>) -> f64| {
            let h = 1e-5;
            let mut at = |step: f64| value(&(&controls + &direction * step));
            (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h)
        };
        let mut plain = PlainInformation::new(&sensing, knots, 3);
        let wanted = slope_of(&mut |c| plain.at(c).expect("determined").value);
        let valued = plain.at(&controls).expect("determined");
        let found = plain.gradient(&valued).dot(&direction);
        assert!((found - wanted).abs() < 1e-6 * (1.0 + wanted.abs()), "plain {found} {wanted}");

        let mut full = FullInformation::new(&sensing, &chain, knots, 3);
        let wanted = slope_of(&mut |c| full.at(c).expect("determined").valued.value);
        let valued = full.at(&controls).expect("determined");
        let found = full.gradient(&valued).dot(&direction);
        assert!((found - wanted).abs() < 1e-6 * (1.0 + wanted.abs()), "full {found} {wanted}");
    }
}
