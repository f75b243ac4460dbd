//! The two sensor models on a chain of node accelerations.

use nalgebra::{Matrix1, Matrix1x2, Matrix3, SMatrix, SVector, Vector1, Vector2, Vector3};

/// A sensor model `y = S a + b` with D readings and P parameters, linear in `a` for given `p` and in `p` for given `a`.
pub(super) trait ChainModel<const D: usize, const P: usize> {
    /// The matrix `S`.
    fn matrix(p: &SVector<f64, P>) -> SMatrix<f64, D, D>;
    /// The bias `b`.
    fn bias(p: &SVector<f64, P>) -> SVector<f64, D>;
    /// `G(a) = ∂(S a + b)/∂p`.
    fn sensitivity(a: &SVector<f64, D>) -> SMatrix<f64, D, P>;
    /// The reading `S a + b`.
    fn reading(p: &SVector<f64, P>, a: &SVector<f64, D>) -> SVector<f64, D> {
        Self::matrix(p) * a + Self::bias(p)
    }
}

/// One axis of the scale-bias model: p = (b, K).
pub(super) struct Uniaxial;

impl ChainModel<1, 2> for Uniaxial {
    fn matrix(p: &Vector2<f64>) -> Matrix1<f64> {
        Matrix1::new(p[1])
    }

    fn bias(p: &Vector2<f64>) -> Vector1<f64> {
        Vector1::new(p[0])
    }

    fn sensitivity(a: &Vector1<f64>) -> Matrix1x2<f64> {
        Matrix1x2::new(1.0, a[0])
    }
}

/// The full model, p in the order of [`ParameterList`](crate::sensor::ParameterList): b, diagonal of S, off-diagonal entries row by row.
pub(super) struct Triaxial;

/// (row, column) of the entries of S in their order.
const ENTRIES: [(usize, usize); 9] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)];

impl ChainModel<3, 12> for Triaxial {
    fn matrix(p: &SVector<f64, 12>) -> Matrix3<f64> {
        let mut s = Matrix3::zeros();
        for (k, entry) in ENTRIES.into_iter().enumerate() {
            s[entry] = p[3 + k];
        }
        s
    }

    fn bias(p: &SVector<f64, 12>) -> Vector3<f64> {
        Vector3::new(p[0], p[1], p[2])
    }

    fn sensitivity(a: &Vector3<f64>) -> SMatrix<f64, 3, 12> {
        let mut g = SMatrix::<f64, 3, 12>::zeros();
        for row in 0..3 {
            g[(row, row)] = 1.0;
        }
        for (k, (row, column)) in ENTRIES.into_iter().enumerate() {
            g[(row, 3 + k)] = a[column];
        }
        g
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::{ParameterList, SensorModel, SensorParameters};

    #[test]
    fn the_full_model_agrees_with_the_parameter_list() {
        let list = ParameterList::new(3, SensorModel::Full);
        let p = SVector::<f64, 12>::from_fn(|i, _| (i as f64 + 1.0).sin());
        let mut sensor = SensorParameters { bias: Vector3::zeros(), matrix: Matrix3::zeros() };
        for (quantity, value) in list.quantities().iter().zip(p.iter()) {
            quantity.add_to(&mut sensor, *value);
        }
        let a = Vector3::new(0.3, -2.0, 5.0);
        assert!((Triaxial::reading(&p, &a) - sensor.reading(&a)).amax() < 1e-15);
        let g = Triaxial::sensitivity(&a);
        for (k, quantity) in list.quantities().iter().enumerate() {
            assert_eq!(g.column(k), quantity.derivative(&a));
        }
    }
}
