//! The sensor model on a chain of node accelerations, for one reading or three: its products in the normal
//! equations. The estimation and the information share it.
//!
//! `y = S a + b` is linear in the parameters for given `a`. Sorted by reading,
//! `p = (b_1, S_11 … S_1D, b_2, S_21 …)`, its sensitivity is block diagonal. Reading r depends on its own D +
//! 1 parameters only, through `ã = (1, a)`. So P = D (D + 1): 2 for one axis, 12 for three. All terms of the
//! normal equations in the parameters are outer products of `ã`.

use crate::arrowhead::Link;
use nalgebra::{SMatrix, SVector};

/// Places in the parameter list of the full chain's parameters. They are sorted by reading: bias, then row of
/// `S`.
pub(crate) const FULL_SLOTS: [usize; 12] = [0, 3, 6, 7, 1, 8, 4, 9, 2, 10, 11, 5];

/// Entry k of `ã = (1, a)`.
fn lifted<const D: usize>(a: &SVector<f64, D>, k: usize) -> f64 {
    if k == 0 { 1.0 } else { a[k - 1] }
}

/// `G(a)`: reading r depends on `(1, a)` through its own parameters.
pub(crate) fn sensitivity<const D: usize, const P: usize>(a: &SVector<f64, D>) -> SMatrix<f64, D, P> {
    let mut g = SMatrix::zeros();
    for row in 0..D {
        for k in 0..=D {
            g[(row, row * (D + 1) + k)] = lifted(a, k);
        }
    }
    g
}

/// The matrix `S`.
pub(crate) fn matrix<const D: usize, const P: usize>(p: &SVector<f64, P>) -> SMatrix<f64, D, D> {
    SMatrix::from_fn(|row, column| p[row * (D + 1) + 1 + column])
}

/// The reading `S a + b`.
pub(crate) fn reading<const D: usize, const P: usize>(
    p: &SVector<f64, P>,
    a: &SVector<f64, D>,
) -> SVector<f64, D> {
    SVector::from_fn(|row, _| (0..=D).map(|k| p[row * (D + 1) + k] * lifted(a, k)).sum())
}

/// Parameters of a sensor without cross-axis terms.
pub(crate) fn diagonal<const D: usize, const P: usize>(
    bias: &SVector<f64, D>,
    gain: &SVector<f64, D>,
) -> SVector<f64, P> {
    let mut p = SVector::zeros();
    for row in 0..D {
        p[row * (D + 1)] = bias[row];
        p[row * (D + 1) + 1 + row] = gain[row];
    }
    p
}

/// `Σ_ij m_ij G(a_i)ᵀ W G(a_j)` over the two nodes of an interval, with `m = (m_00, m_01, m_11)`.
pub(crate) fn information<const D: usize, const P: usize>(
    weight: &SVector<f64, D>,
    m: [f64; 3],
    a0: &SVector<f64, D>,
    a1: &SVector<f64, D>,
) -> SMatrix<f64, P, P> {
    let mut information = SMatrix::zeros();
    for j in 0..=D {
        for k in 0..=j {
            let (x0, x1, y0, y1) = (lifted(a0, j), lifted(a1, j), lifted(a0, k), lifted(a1, k));
            let sum = m[0] * x0 * y0 + m[1] * (x0 * y1 + x1 * y0) + m[2] * x1 * y1;
            for row in 0..D {
                let at = row * (D + 1);
                information[(at + j, at + k)] = weight[row] * sum;
                information[(at + k, at + j)] = weight[row] * sum;
            }
        }
    }
    information
}

/// `Sᵀ W (m_0 G(a_0) + m_1 G(a_1))`.
pub(crate) fn coupling<const D: usize, const P: usize>(
    s: &SMatrix<f64, D, D>,
    weight: &SVector<f64, D>,
    m: [f64; 2],
    a0: &SVector<f64, D>,
    a1: &SVector<f64, D>,
) -> SMatrix<f64, D, P> {
    let mut coupling = SMatrix::zeros();
    for k in 0..=D {
        let sum = m[0] * lifted(a0, k) + m[1] * lifted(a1, k);
        for row in 0..D {
            for node in 0..D {
                coupling[(node, row * (D + 1) + k)] = s[(row, node)] * weight[row] * sum;
            }
        }
    }
    coupling
}

/// `G(a_0)ᵀ r_0 + G(a_1)ᵀ r_1`.
pub(crate) fn gradient<const D: usize, const P: usize>(
    a0: &SVector<f64, D>,
    r0: &SVector<f64, D>,
    a1: &SVector<f64, D>,
    r1: &SVector<f64, D>,
) -> SVector<f64, P> {
    let mut gradient = SVector::zeros();
    for row in 0..D {
        for k in 0..=D {
            gradient[row * (D + 1) + k] = r0[row] * lifted(a0, k) + r1[row] * lifted(a1, k);
        }
    }
    gradient
}

/// The change of the reading with the delay of the clock and with its rate at both ends of an interval: `S j (1, s)`, with the jerk `j` and the times
/// `s` of the ends from the middle of the motion. Both are linear within an interval, as the reading is.
pub(crate) fn clock_sensitivity<const D: usize>(
    s: &SMatrix<f64, D, D>,
    jerk: &SVector<f64, D>,
    times_s: [f64; 2],
) -> [SMatrix<f64, D, 2>; 2] {
    let moved = s * jerk;
    times_s.map(|time_s| SMatrix::from_columns(&[moved, moved * time_s]))
}

/// The normal equations of an interval with delay and rate of the clock behind the parameters: Q = P + 2.
///
/// `clock` is their sensitivity at both ends, `m = (m_00, m_01, m_11)`, `r` the weighted sums of the residuals at both ends.
pub(crate) fn with_clock<const D: usize, const P: usize, const Q: usize>(
    link: &Link<D, P>,
    s: &SMatrix<f64, D, D>,
    weight: &SVector<f64, D>,
    m: [f64; 3],
    nodes: [&SVector<f64, D>; 2],
    clock: &[SMatrix<f64, D, 2>; 2],
    r: [&SVector<f64, D>; 2],
) -> Link<D, Q> {
    let weighted =
        |of: SMatrix<f64, D, 2>| SMatrix::<f64, D, 2>::from_fn(|row, c| weight[row] * of[(row, c)]);
    let u0 = weighted(clock[0] * m[0] + clock[1] * m[1]);
    let u1 = weighted(clock[0] * m[1] + clock[1] * m[2]);
    let mut whole: Link<D, Q> = Link {
        h00: link.h00,
        h01: link.h01,
        h11: link.h11,
        b0: SMatrix::zeros(),
        b1: SMatrix::zeros(),
        c: SMatrix::zeros(),
        g0: link.g0,
        g1: link.g1,
        gp: SVector::zeros(),
    };
    whole.b0.fixed_view_mut::<D, P>(0, 0).copy_from(&link.b0);
    whole.b1.fixed_view_mut::<D, P>(0, 0).copy_from(&link.b1);
    whole.c.fixed_view_mut::<P, P>(0, 0).copy_from(&link.c);
    whole.gp.fixed_rows_mut::<P>(0).copy_from(&link.gp);
    whole.b0.fixed_view_mut::<D, 2>(0, P).copy_from(&s.tr_mul(&u0));
    whole.b1.fixed_view_mut::<D, 2>(0, P).copy_from(&s.tr_mul(&u1));
    for k in 0..2 {
        let both: SVector<f64, P> =
            gradient(nodes[0], &u0.column(k).into_owned(), nodes[1], &u1.column(k).into_owned());
        whole.c.fixed_view_mut::<P, 1>(0, P + k).copy_from(&both);
        whole.c.fixed_view_mut::<1, P>(P + k, 0).copy_from(&both.transpose());
    }
    whole.c.fixed_view_mut::<2, 2>(P, P).copy_from(&(clock[0].tr_mul(&u0) + clock[1].tr_mul(&u1)));
    whole.gp.fixed_rows_mut::<2>(P).copy_from(&(clock[0].tr_mul(r[0]) + clock[1].tr_mul(r[1])));
    whole
}

/// A node of the chain after a fit: its acceleration, and the covariance of that with the parameters.
pub(crate) struct FittedNode<const D: usize, const P: usize> {
    pub(crate) a: SVector<f64, D>,
    pub(crate) with_parameters: SMatrix<f64, D, P>,
}

/// Covariance of the fitted readings at two nodes, reading by reading. It follows from the covariance of the
/// nodes (`one` with `other`) and of the parameters.
pub(crate) fn reading_covariance<const D: usize, const P: usize>(
    s: &SMatrix<f64, D, D>,
    nodes: &SMatrix<f64, D, D>,
    one: &FittedNode<D, P>,
    other: &FittedNode<D, P>,
    parameters: &SMatrix<f64, P, P>,
) -> SVector<f64, D> {
    SVector::from_fn(|row, _| {
        let at = row * (D + 1);
        let mut covariance = 0.0;
        for i in 0..D {
            for j in 0..D {
                covariance += s[(row, i)] * nodes[(i, j)] * s[(row, j)];
            }
            for k in 0..=D {
                covariance += s[(row, i)]
                    * (one.with_parameters[(i, at + k)] * lifted(&other.a, k)
                        + other.with_parameters[(i, at + k)] * lifted(&one.a, k));
            }
        }
        for j in 0..=D {
            for k in 0..=D {
                covariance += lifted(&one.a, j) * parameters[(at + j, at + k)] * lifted(&other.a, k);
            }
        }
        covariance
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::JerkControlledMotion;
    use crate::sensor::{ParameterList, SensorModel, SensorParameters};
    use nalgebra::{Matrix3, Vector3};

    type P = SVector<f64, 12>;

    fn parameters() -> P {
        P::from_fn(|i, _| (i as f64 + 1.0).sin())
    }

    /// G(a) by differences. The model is linear, so they are exact to rounding.
    fn sensitivity(a: &Vector3<f64>) -> SMatrix<f64, 3, 12> {
        let p = parameters();
        SMatrix::from_fn(|row, k| {
            let mut q = p;
            q[k] += 1.0;
            reading(&q, a)[row] - reading(&p, a)[row]
        })
    }

    #[test]
    fn the_model_agrees_with_the_parameter_list() {
        let list = ParameterList::new(3, SensorModel::Full);
        let p = parameters();
        let mut sensor = SensorParameters::linear(Vector3::zeros(), Matrix3::zeros());
        for (slot, value) in FULL_SLOTS.into_iter().zip(p.iter()) {
            list.quantities()[slot].add_to(&mut sensor, *value);
        }
        let a = Vector3::new(0.3, -2.0, 5.0);
        assert!((reading(&p, &a) - sensor.reading(&a)).amax() < 1e-15);
        assert_eq!(matrix::<3, 12>(&p), sensor.matrix);
        for (k, slot) in FULL_SLOTS.into_iter().enumerate() {
            let derivative = list.quantities()[slot].derivative(&sensor, &a);
            assert!((sensitivity(&a).column(k) - derivative).amax() < 1e-14);
        }
    }

    #[test]
    fn the_outer_products_equal_dense_matrix_products() {
        let (a0, a1) = (Vector3::new(0.3, -2.0, 5.0), Vector3::new(1.3, 0.4, -4.0));
        let (g0, g1) = (sensitivity(&a0), sensitivity(&a1));
        let weight = Vector3::new(1.0, 2.0, 3.0);
        let w = Matrix3::from_diagonal(&weight);
        let m = [0.7, 0.2, 0.5];
        let dense = g0.tr_mul(&(w * g0)) * m[0]
            + (g0.tr_mul(&(w * g1)) + g1.tr_mul(&(w * g0))) * m[1]
            + g1.tr_mul(&(w * g1)) * m[2];
        assert!((information::<3, 12>(&weight, m, &a0, &a1) - dense).amax() < 1e-12);
        let s = matrix::<3, 12>(&parameters());
        let dense = s.tr_mul(&(w * (g0 * m[0] + g1 * m[1])));
        assert!((coupling::<3, 12>(&s, &weight, [m[0], m[1]], &a0, &a1) - dense).amax() < 1e-12);
        let dense = g0.tr_mul(&a1) + g1.tr_mul(&a0);
        assert!((gradient::<3, 12>(&a0, &a1, &a1, &a0) - dense).amax() < 1e-12);
    }

    #[test]
    fn one_axis_is_bias_and_scale() {
        let p = diagonal::<1, 2>(&SVector::repeat(0.5), &SVector::repeat(2.0));
        assert_eq!(reading(&p, &SVector::<f64, 1>::repeat(3.0))[0], 6.5);
        let motion = JerkControlledMotion::uniform(1.0, vec![Vector3::zeros(); 2]).expect("valid");
        assert_eq!(motion.intervals(), 1);
    }
}
