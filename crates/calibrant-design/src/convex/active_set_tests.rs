use super::*;
use crate::convex::{ConicProgram, Row};
use calibrant_core::simulate::{Purpose, stream};
use rand::RngExt;

fn solved(hessian: &DMatrix<f64>, slope: &DVector<f64>, rows: &[LinearRow], warm: &[Active]) -> ActiveSet {
    let factor = hessian.clone().cholesky().expect("positive definite");
    let mut set = ActiveSet::begin(&factor, slope.clone(), rows, warm).expect("regular");
    set.solve(rows).expect("feasible");
    set
}

/// Random programs whose rows admit 0.
fn random(seed: u64, size: usize, count: usize) -> (DMatrix<f64>, DVector<f64>, Vec<LinearRow>) {
    let mut rng = stream(seed, Purpose::Start, 0);
    let mut draw = || rng.random_range(-1.0..1.0);
    let factor = DMatrix::from_fn(size, size.div_ceil(2), |_, _| draw());
    let hessian = &factor * factor.transpose() + DMatrix::identity(size, size) * 1e-4;
    let slope = DVector::from_fn(size, |_, _| draw());
    let mut rows: Vec<_> = (0..size).map(|k| LinearRow::new(k, vec![1.0], -1.0, 1.0)).collect();
    for _ in 0..count {
        let coefficients = (0..size).map(|_| draw()).collect();
        rows.push(LinearRow::new(0, coefficients, -0.5, 0.3));
    }
    let coefficients = (0..size - 2).map(|_| draw()).collect();
    rows.push(LinearRow::new(2, coefficients, 0.1, 0.1));
    (hessian, slope, rows)
}

#[test]
fn the_solution_keeps_the_optimality_conditions() {
    for seed in 0..200 {
        let (hessian, slope, rows) = random(seed, 12, 20);
        let set = solved(&hessian, &slope, &rows, &[]);
        let x = set.x();
        assert!(rows.iter().all(|row| (row.lower - 1e-10..=row.upper + 1e-10).contains(&row.at(x))));
        let mut gradient = &hessian * x + &slope;
        for ((row, side), multiplier) in set.active() {
            assert!(multiplier >= 0.0 || rows[row].is_equality());
            let bound = if side == Side::Lower { rows[row].lower } else { rows[row].upper };
            assert!((rows[row].at(x) - bound).abs() < 1e-10);
            let normal = &rows[row].coefficients * (side.sign() * multiplier);
            let mut own = gradient.rows_mut(rows[row].first, normal.len());
            own -= normal;
        }
        assert!(gradient.amax() < 1e-9, "seed {seed}: {}", gradient.amax());
    }
}

#[test]
fn clarabel_finds_the_same_minimum() {
    for seed in 0..20 {
        let (hessian, slope, rows) = random(seed, 8, 10);
        let x = solved(&hessian, &slope, &rows, &[]).x().clone();
        let mut program = ConicProgram::default();
        program.add_variables(16);
        let factor = hessian.clone().cholesky().expect("positive definite").l();
        for k in 0..8 {
            program.add_linear(k, slope[k]);
            program.add_square(8 + k, 1.0);
            let terms = (0..8).map(|i| (i, factor[(i, k)])).chain([(8 + k, -1.0)]);
            program.zero(Row::new(0.0, terms));
        }
        for row in &rows {
            let terms = row.coefficients.iter().enumerate();
            let form = Row::new(0.0, terms.map(|(k, &c)| (row.first + k, c)));
            if row.is_equality() {
                program.zero(form.plus(&Row::new(-row.lower, [])));
            } else {
                program.nonnegative(form.clone().plus(&Row::new(-row.lower, [])));
                program.nonnegative(form.times(-1.0).plus(&Row::new(row.upper, [])));
            }
        }
        let value = |x: &DVector<f64>| (x.transpose() * &hessian * x)[0] / 2.0 + slope.dot(x);
        let other = DVector::from_column_slice(&program.solve().expect("solved").x[..8]);
        assert!((value(&x) - value(&other)).abs() < 1e-7, "seed {seed}: {} {}", value(&x), value(&other));
    }
}

#[test]
fn a_warm_start_ends_at_the_same_place_with_less_work() {
    let (hessian, slope, rows) = random(3, 30, 60);
    let cold = solved(&hessian, &slope, &rows, &[]);
    let active: Vec<Active> = cold.active().map(|(row, _)| row).collect();
    let again = solved(&hessian, &slope, &rows, &active);
    assert!((cold.x() - again.x()).amax() < 1e-9);
    assert_eq!(again.changes(), active.len());
    // another program nearby
    let near = solved(&(&hessian * 1.1), &(&slope * 0.9), &rows, &active);
    let from_nothing = solved(&(&hessian * 1.1), &(&slope * 0.9), &rows, &[]);
    assert!((near.x() - from_nothing.x()).amax() < 1e-9);
    assert!(near.changes() <= from_nothing.changes());
}

#[test]
fn a_wrong_warm_start_does_no_harm() {
    let (hessian, slope, rows) = random(4, 10, 20);
    let cold = solved(&hessian, &slope, &rows, &[]);
    let wrong: Vec<Active> = (0..rows.len()).map(|row| (row, Side::Upper)).collect();
    assert!((cold.x() - solved(&hessian, &slope, &rows, &wrong).x()).amax() < 1e-9);
}

#[test]
fn contradicting_rows_have_no_solution() {
    let rows = [LinearRow::new(0, vec![1.0], 1.0, 2.0), LinearRow::new(0, vec![2.0], -8.0, 1.0)];
    let factor = DMatrix::identity(2, 2).cholesky().expect("positive definite");
    let mut set = ActiveSet::begin(&factor, DVector::zeros(2), &rows, &[]).expect("regular");
    assert!(set.solve(&rows).is_none());
}

#[test]
fn a_row_that_is_added_later_moves_the_minimum() {
    let mut rows = vec![LinearRow::new(0, vec![1.0], -3.0, 3.0)];
    let factor = DMatrix::identity(2, 2).cholesky().expect("positive definite");
    let mut set = ActiveSet::begin(&factor, DVector::from_vec(vec![-4.0, 0.0]), &rows, &[]).expect("regular");
    set.solve(&rows).expect("feasible");
    assert!((set.x()[0] - 3.0).abs() < 1e-14);
    rows.push(LinearRow::new(0, vec![1.0, 1.0], -1.0, 1.0));
    set.solve(&rows).expect("feasible");
    // the nearest point to (4, 0) with x + y ≤ 1 and x ≤ 3
    assert!((set.x() - DVector::from_vec(vec![2.5, -1.5])).amax() < 1e-14, "{}", set.x());
}
