//! The interior-point method against Clarabel.

use super::*;
use crate::convex::{ConicProgram, Row as ConicRow};
use crate::limits::{Region, WatchedIntervals};
use crate::local_search::Peaks;
use calibrant_core::motion::{AxisLimits, Rest};
use nalgebra::DMatrix;

/// One axis with every limit, an uneven slope and two forms.
#[test]
fn the_minimum_is_that_of_clarabel() {
    for nodes in [21, 301] {
        let limits = AxisLimits {
            acceleration: Some(10.0),
            jerk: Some(30.0),
            velocity: Some(0.6),
            displacement: Some(0.1),
            rest: Rest::Both,
            ..AxisLimits::default()
        };
        let tau: Vec<f64> = (0..nodes).map(|i| 0.1 * i as f64).collect();
        let region = Region::new(limits, &tau);
        let slope: Vec<f64> = (0..nodes).map(|i| (1.7 * i as f64).sin() / nodes as f64).collect();
        let forms: [Vec<f64>; 2] =
            [1.1, 0.3].map(|w| (0..nodes).map(|i| (w * i as f64).cos() / (nodes as f64).sqrt()).collect());

        let mut chain = region.chain(&Peaks::default());
        chain.slope.iter_mut().zip(&slope).for_each(|(z, slope)| z[0] = *slope);
        let own = ChainProgram {
            chains: vec![chain],
            forms: forms.iter().map(|b| Form { b: vec![b.clone()], offset: 0.05 }).collect(),
            matrix: None,
            reached: 0.0025,
        };
        let start = vec![region.stages(&vec![0.0; nodes])];
        let found = own.solve(start, 1.0).expect("the start is inside");
        assert!(found.iterations < 40, "{}", found.iterations);

        let mut program = ConicProgram::default();
        program.add_variables(nodes);
        region.add_to(&mut program, |i| i, &WatchedIntervals::default());
        slope.iter().enumerate().for_each(|(i, slope)| program.add_linear(i, *slope));
        for b in &forms {
            let z = program.add_variables(1);
            program.add_square(z, 1.0);
            let terms = b.iter().copied().enumerate().chain([(z, -1.0)]);
            program.zero(ConicRow::new(-0.05, terms));
        }
        let clarabel = program.solve().expect("a solution");
        let stages =
            vec![region.stages(&clarabel.x[..nodes].iter().map(|x| x * region.size).collect::<Vec<_>>())];
        let least = own.objective(&stages, &own.forms_at(&stages));
        let value = own.reached - found.gained;
        assert!(value < 0.0 && (value - least).abs() <= found.gap + 1e-8, "{value} {least} {}", found.gap);
        assert!(found.gap < 0.011 * found.gained, "{}", found.gap);
    }
}

/// Accelerations within 1 and nothing else.
fn within_one(nodes: usize) -> (Region, Vec<f64>) {
    let limits = AxisLimits { acceleration: Some(1.0), ..AxisLimits::default() };
    let tau: Vec<f64> = (0..nodes).map(|i| i as f64).collect();
    (Region::new(limits, &tau), vec![0.0; nodes])
}

/// The motion with the largest smallest eigenvalue of a matrix, that eigenvalue, and the number of iterations.
fn largest_smallest(matrix: AffineMatrix) -> (Vec<f64>, f64, usize) {
    let nodes = matrix.around[0].len();
    let (region, still) = within_one(nodes);
    let program = ChainProgram {
        chains: vec![region.chain(&Peaks::default())],
        forms: Vec::new(),
        matrix: Some(matrix),
        reached: 0.0,
    };
    let found = program.solve(vec![region.stages(&still)], 1.0).expect("the start is inside");
    let matrix = program.matrix.expect("there");
    // the matrix less t N is positive definite, and no motion has more than ⟨Z, M⟩ at most, for any Z ⪰ 0 with ⟨N, Z⟩ = 1
    let value = found.gained;
    let rest = matrix.at(&found.stages) - &matrix.metric * (value - 1e-9);
    assert!(rest.cholesky().is_some(), "{value} is above the smallest eigenvalue");
    let z = found.multiplier.expect("there");
    assert!(z.clone().cholesky().is_some(), "{z}");
    let z = &z / z.dot(&matrix.metric);
    let most =
        matrix.constant.dot(&z) + matrix.changes[0].iter().map(|change| change.dot(&z).abs()).sum::<f64>();
    assert!(value <= most + 1e-9 && most - value < 0.011 * value.abs() + 1e-9, "{value} {most}");
    (found.stages[0].iter().map(|z| z[0]).collect(), value, found.iterations)
}

#[test]
fn the_smallest_eigenvalue_is_largest_where_its_multiplier_says() {
    for (size, nodes) in [(2, 3), (4, 9), (12, 60)] {
        let wave = |k: usize| {
            let root =
                DMatrix::from_fn(size, size, |i, j| ((3 * i + 5 * j + 7 * k + i * j * k) as f64).sin());
            &root + root.transpose()
        };
        let root = DMatrix::from_fn(size, size, |i, j| ((i + 2 * j) as f64).cos());
        let matrix = AffineMatrix {
            constant: DMatrix::identity(size, size) * 3.0,
            changes: vec![(0..nodes).map(wave).collect()],
            around: vec![vec![0.0; nodes]],
            metric: &root * root.transpose() + DMatrix::identity(size, size),
        };
        let (_, value, iterations) = largest_smallest(matrix);
        assert!(value > 0.0 && iterations < 30, "{size}: {value} after {iterations}");
    }
}

/// `[[2 + a, b], [b, 2 − a]]`: both eigenvalues meet at zero, where they are 2.
#[test]
fn eigenvalues_meet_at_the_optimum() {
    let changes = [[1.0, 0.0, -1.0], [0.0, 1.0, 0.0]];
    let changes = changes.map(|[a, b, c]| DMatrix::from_row_slice(2, 2, &[a, b, b, c]));
    let identity = DMatrix::identity(2, 2);
    let matrix = AffineMatrix {
        constant: &identity * 2.0,
        changes: vec![changes.to_vec()],
        around: vec![vec![0.0; 2]],
        metric: identity,
    };
    let (_, value, _) = largest_smallest(matrix);
    assert!((value - 2.0).abs() < 0.02, "{value}");
}
