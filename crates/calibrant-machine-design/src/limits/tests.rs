//! Slopes of the rows against differences, and rows of control points against the definition.

use super::*;
use crate::chains_for_tests::{Numbers, arm_of_all_kinds, problem_of};
use crate::information::Sensing;
use crate::motion::{Grid, Knots, Ties};
use crate::spheres_for_tests::Spheres;
use calibrant_machine::chain::SpeedNearEnds;
use nalgebra::{DMatrix, Vector3};

#[test]
fn slopes_of_the_rows_are_those_of_differences() {
    let mut numbers = Numbers(6);
    let chain = arm_of_all_kinds(4, &mut numbers);
    let near_ends = SpeedNearEnds { lower: -2.0, upper: 2.0, slope: 12.0, offset: 0.3 };
    let spheres = Spheres(vec![
        (0, Vector3::zeros(), 0.8),
        (2, numbers.vector(0.1), 0.8),
        (4, numbers.vector(0.1), 0.8),
    ]);
    let mut problem = problem_of(&chain);
    problem.surroundings = Some(&spheres);
    problem.tip_speed_mps = Some(3.0);
    problem.sensor_body = Some(SensorBody { center_m: numbers.vector(0.05), radius_m: 0.04 });
    problem.joints[1].near_ends = Some(near_ends);
    let sensing = Sensing::new(&problem).expect("valid");
    let pointwise = Pointwise::new(&problem, sensing.links.clone(), -0.1, 0.9);
    let knots = Knots { step_s: 0.4, intervals: 1 };
    let grid = Grid::at(knots, [0.3]);
    let controls = DMatrix::from_fn(4, 4, |_, _| numbers.next(0.4));
    let direction = DMatrix::from_fn(4, 4, |_, _| numbers.next(1.0));
    let (n, positions) = (4, pointwise.position_rows());
    let mut work = pointwise.work();
    let mut by_position = vec![0.0; positions * n];
    let mut by_state = vec![0.0; (pointwise.rows() - positions) * 3 * n];
    let mut at = |controls: &DMatrix<f64>, with_slopes: bool| {
        let mut values = vec![0.0; pointwise.rows()];
        let rows = PointRows {
            values: &mut values,
            by_position: &mut by_position,
            by_state: &mut by_state,
            with_slopes,
        };
        pointwise.at(&mut work, &grid, 0, controls, rows);
        values
    };
    let h = 1e-6;
    let [high, low] = [h, -h].map(|step| at(&(&controls + &direction * step), false));
    let values = at(&controls, true);
    assert_eq!(values.len(), 3 + 6 + 2 + 2);
    assert!(values[..3].iter().any(|value| *value < 1.0));
    let (_, weights) = grid.rows(0);
    let state: Vec<f64> = (0..3)
        .flat_map(|d| (0..n).map(move |j| (d, j)))
        .map(|(d, j)| (0..4).map(|r| weights[d][r] * direction[(r, j)]).sum())
        .collect();
    for row in 0..values.len() {
        let slopes = match row.checked_sub(positions) {
            None => &by_position[row * n..(row + 1) * n],
            Some(row) => &by_state[row * 3 * n..(row + 1) * 3 * n],
        };
        let found: f64 = slopes.iter().zip(&state).map(|(slope, state)| slope * state).sum();
        let wanted = (high[row] - low[row]) / (2.0 * h);
        assert!((found - wanted).abs() < 1e-6 * (1.0 + wanted.abs()), "{row}: {found} {wanted}");
    }
}

#[test]
fn limits_on_control_points_are_differences_of_them() {
    let limit =
        JointLimit { lower: -1.0, upper: 3.0, velocity: 2.0, acceleration: 5.0, jerk: 50.0, near_ends: None };
    let knots = Knots { step_s: 0.5, intervals: 5 };
    let ties = Ties::new(8, None, &[0.7], &[]);
    let controls = DMatrix::from_column_slice(8, 1, &[0.0, 0.0, 0.0, 0.4, 1.0, 1.2, 1.2, 1.2]);
    let linear = Linear::new(&[limit], &knots, &ties);
    let mut slacks = vec![0.0; linear.len()];
    linear.slacks(&ties.unknowns_of(&controls), &mut slacks);
    let least = slacks.iter().copied().fold(f64::INFINITY, f64::min);
    // the largest use is that of the speed: 0.6/0.5 of 2
    assert!((least - 0.4).abs() < 1e-12, "{least}");
    assert!((least_slack(&[limit], &knots, &controls) - 0.4).abs() < 1e-12);
}

#[test]
fn no_point_of_a_sensor_body_is_faster_than_the_fastest_and_one_nearly_as_fast() {
    let mut numbers = Numbers(5);
    for _ in 0..20 {
        let (v, w, body) = (
            numbers.vector(1.0),
            numbers.vector(5.0),
            SensorBody { center_m: Vector3::zeros(), radius_m: 0.1 },
        );
        let points = (0..20_000).map(|_| body.radius_m * numbers.vector(1.0).normalize());
        let fastest = points.map(|x| (v + w.cross(&x)).norm()).fold(0.0, f64::max);
        let found = body.fastest_mps(&v, &w);
        assert!(fastest <= found * (1.0 + 1e-12) && fastest > 0.999 * found, "{fastest} {found}");
    }
    let still = SensorBody { center_m: Vector3::zeros(), radius_m: 0.1 };
    assert_eq!(still.fastest_mps(&Vector3::x(), &Vector3::zeros()), 1.0);
}
