//! Information against straightforward sums over samples, and gradients against differences.

use super::directions::Directions;
use super::*;
use crate::TrajectoryProblem;
use crate::chains_for_tests::{Numbers, arm_of_all_kinds, problem_of};
use crate::motion::{Grid, Knots};
use crate::recursion::V;
use calibrant_machine::chain::{ChainSensitivity, FrameMotion, JointState};
use calibrant_machine::estimate::MachineQuantity;
use nalgebra::{DMatrix, Matrix4, Vector3, Vector4, Vector6};

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
            let state = JointState { positions: &q, velocities: &qd, accelerations: &qdd };
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

/// Each column of the nuisances, against the derivatives that the estimate on a machine uses.
#[test]
fn nuisances_change_the_readings_as_in_the_estimate() {
    let chain = arm_of_all_kinds(4, &mut Numbers(5));
    let problem = problem_of(&chain);
    let sensing = Sensing::new(&problem).expect("valid");
    let knots = Knots { step_s: 0.5, intervals: 4 };
    let (grid, controls) = (Grid::at(knots, [0.3]), controls(knots, 4));
    let mut sampled = Sampled::new(4, grid.len());
    sampled.fill(&sensing.links, &grid, &controls);
    sampled.thirds(&sensing.links);
    let tip = chain.tip_transform.rotation.to_rotation_matrix().into_inner();
    let directions = Directions::new(&sensing, &tip);
    let base = FrameMotion::at_rest(&-Vector3::from(sensing.links.base.0));
    let (spline, after_middle_s) = (knots.spline(&controls), 0.7);
    for k in 0..grid.len() {
        let [q, qd, qdd, jerk] = [0, 1, 2, 3].map(|d| spline.at(grid.time_s(k), d));
        let state = JointState { positions: &q, velocities: &qd, accelerations: &qdd };
        let mut of = ChainSensitivity::new(4);
        of.evaluate(&chain.nominal(), state, &base, &sensing.mount);
        let mut change = Vector6::zeros();
        for j in 0..4 {
            change += of.positions.column(j) * qd[j]
                + of.velocities.column(j) * qdd[j]
                + of.accelerations.column(j) * jerk[j];
        }
        let of_sensor = |s: usize| Vector6::from_fn(|row, _| if row / 3 == s { change[row] } else { 0.0 });
        let wanted = |quantity: &MachineQuantity| -> Option<Vector6<f64>> {
            Some(match *quantity {
                MachineQuantity::Imu(_) => return None,
                MachineQuantity::Lever(axis) => of.mount.lever.column(axis.index()).into_owned(),
                MachineQuantity::Mounting(axis) => of.mount.mounting.column(axis.index()).into_owned(),
                MachineQuantity::Tilt(k) => of.gravity() * sensing.by_gravity[k],
                MachineQuantity::Gravity => of.gravity() * sensing.by_gravity[2],
                MachineQuantity::Delay(sensor) => of_sensor(sensor as usize),
                MachineQuantity::ClockRate => change * after_middle_s,
                MachineQuantity::Zero(j) => of.positions.column(j).into_owned(),
                MachineQuantity::Geometry(j, k) => of.geometry.column(6 * j + k).into_owned(),
            })
        };
        let wanted: Vec<Vector6<f64>> = sensing.layout.quantities.iter().filter_map(wanted).collect();
        assert_eq!(wanted.len(), directions.len());
        directions.columns(sampled.sweep(k), after_middle_s, |place, [V(force), V(rate)]| {
            let found = Vector6::from_iterator(force.into_iter().chain(rate));
            let error = (found - wanted[place]).norm();
            assert!(error < 1e-11 * (1.0 + wanted[place].norm()), "{k} {place}: {found} {}", wanted[place]);
        });
    }
}
