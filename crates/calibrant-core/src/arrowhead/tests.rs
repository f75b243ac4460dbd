//! Tests of the arrowhead kernel against the dense solution.

use super::*;
use nalgebra::{DMatrix, DVector, Matrix2, Matrix3, Vector2};

/// Number of intervals of the test chain.
const N: usize = 6;

/// Jacobians with respect to first node, last node and border, and residuals.
type Interval = (SMatrix<f64, 5, 2>, SMatrix<f64, 5, 2>, SMatrix<f64, 5, 3>, SVector<f64, 5>);

/// A deterministic, well-conditioned chain: each interval has five "samples" of random Jacobian.
fn jacobians() -> Vec<Interval> {
    let mut state = 1_u64;
    let mut next = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    (0..N)
        .map(|_| {
            (
                SMatrix::from_fn(|_, _| next()),
                SMatrix::from_fn(|_, _| next()),
                SMatrix::from_fn(|_, _| next()),
                SVector::from_fn(|_, _| next()),
            )
        })
        .collect()
}

fn link(i: usize) -> Link<2, 3> {
    let (j0, j1, g, r) = jacobians()[i];
    Link {
        h00: j0.tr_mul(&j0),
        h01: j0.tr_mul(&j1),
        h11: j1.tr_mul(&j1),
        b0: j0.tr_mul(&g),
        b1: j1.tr_mul(&g),
        c: g.tr_mul(&g),
        g0: j0.tr_mul(&r),
        g1: j1.tr_mul(&r),
        gp: g.tr_mul(&r),
    }
}

/// The same system, dense, with weights 1/q: unknowns a_1..a_N then p.
fn dense(increment: impl Fn(usize) -> Increment<2>) -> (DMatrix<f64>, DVector<f64>) {
    let size = 2 * N + 3;
    let (mut h, mut g) = (DMatrix::zeros(size, size), DVector::zeros(size));
    for i in 0..N {
        let (j0, j1, jp, r) = jacobians()[i];
        let mut j = DMatrix::zeros(5, size);
        if i > 0 {
            j.view_mut((0, 2 * i - 2), (5, 2)).copy_from(&j0);
        }
        j.view_mut((0, 2 * i), (5, 2)).copy_from(&j1);
        j.view_mut((0, 2 * N), (5, 3)).copy_from(&jp);
        h += j.tr_mul(&j);
        g += j.tr_mul(&r);
        let known = increment(i);
        for axis in 0..2 {
            let q = known.variance[axis];
            if q.is_finite() {
                let mut row = DVector::zeros(size);
                row[2 * i + axis] = 1.0;
                if i > 0 {
                    row[2 * i - 2 + axis] = -1.0;
                }
                h += &row * row.transpose() / q;
                g += row * (known.residual[axis] / q);
            }
        }
    }
    (h, g)
}

fn compare(increment: impl Fn(usize) -> Increment<2> + Copy, tolerance: f64) {
    let arrowhead =
        Arrowhead::eliminate(N, link, increment, Matrix3::zeros(), SVector::zeros()).expect("regular");
    let (mut h, mut g) = dense(increment);
    // known nodes are struck out
    let mut fixed = vec![];
    for i in 0..N {
        for axis in 0..2 {
            if increment(i).fixed[axis] {
                fixed.push(2 * i + axis);
            }
        }
    }
    for &index in &fixed {
        h.row_mut(index).fill(0.0);
        h.column_mut(index).fill(0.0);
        h[(index, index)] = 1.0;
        g[index] = 0.0;
    }
    let covariance = h.clone().try_inverse().expect("regular");
    let solution = &covariance * g;
    let f = covariance.fixed_view::<3, 3>(2 * N, 2 * N).into_owned().try_inverse().expect("regular");
    assert!((arrowhead.information - f).amax() < tolerance * f.amax(), "{} {}", arrowhead.information, f);
    let step = arrowhead.information.try_inverse().expect("regular") * arrowhead.rhs;
    let chain = arrowhead.chain_step(&step);
    for (i, step) in chain.iter().enumerate().skip(1) {
        let expected = solution.fixed_rows::<2>(2 * i - 2);
        assert!((step - expected).amax() < tolerance * 100.0, "node {i}");
    }
    let border = arrowhead.information.try_inverse().expect("regular");
    arrowhead.walk_covariance(&border, |i, at| {
        let expected: Matrix2<f64> = covariance.fixed_view::<2, 2>(2 * i, 2 * i).into_owned();
        if increment(i).fixed == [false; 2] {
            assert!((at.node1 - expected).amax() < tolerance * 100.0, "covariance of node {}", i + 1);
            let expected = covariance.fixed_view::<2, 3>(2 * i, 2 * N).into_owned();
            assert!((at.node1_border - expected).amax() < tolerance * 100.0);
            if i > 0 {
                let expected: Matrix2<f64> = covariance.fixed_view::<2, 2>(2 * i, 2 * i - 2).into_owned();
                assert!((at.node1_node0 - expected).amax() < tolerance * 100.0);
            }
            if i > 1 {
                let expected: Matrix2<f64> = covariance.fixed_view::<2, 2>(2 * i, 2 * i - 4).into_owned();
                assert!((at.before.expect("a node before").1 - expected).amax() < tolerance * 100.0);
            }
        }
    });
}

fn residual(i: usize) -> Vector2<f64> {
    Vector2::new(0.1 * i as f64 - 0.2, 0.3)
}

#[test]
fn finite_variances_equal_the_dense_solution() {
    let q = |i: usize| Vector2::new(0.5 + i as f64, 0.02);
    compare(|i| Increment { variance: q(i), residual: residual(i), fixed: [false; 2] }, 1e-11);
}

#[test]
fn unknown_increments_equal_the_dense_solution() {
    compare(|_| Increment::unknown(), 1e-10);
}

#[test]
fn a_mixture_with_a_known_end_equals_the_dense_solution() {
    compare(
        |i| Increment {
            variance: Vector2::new(if i % 2 == 0 { f64::INFINITY } else { 0.3 }, 2.0),
            residual: residual(i),
            fixed: [i == N - 1; 2],
        },
        1e-10,
    );
}

#[test]
fn vanishing_variance_tends_to_the_exact_constraint_without_loss() {
    let at = |q: f64| {
        let increment =
            |i| Increment { variance: Vector2::repeat(q), residual: residual(i), fixed: [false; 2] };
        let system =
            Arrowhead::eliminate(N, link, increment, Matrix3::zeros(), SVector::zeros()).expect("regular");
        (system.information, system.rhs)
    };
    let (exact, exact_rhs) = at(0.0);
    let (tiny, tiny_rhs) = at(1e-30);
    assert!((tiny - exact).amax() < 1e-14 && (tiny_rhs - exact_rhs).amax() < 1e-13);
}

#[test]
fn a_node_without_information_is_named() {
    let empty = |i| if i == 3 || i == 4 { Link::zero() } else { link(i) };
    let result = Arrowhead::eliminate(N, empty, |_| Increment::unknown(), Matrix3::zeros(), SVector::zeros());
    assert_eq!(result.expect_err("node 4 has no data").node, 4);
}
