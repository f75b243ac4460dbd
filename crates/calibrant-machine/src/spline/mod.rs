//! The motion as uniform B-splines: value and three derivatives at any time, from a few control points.
//!
//! # Formula
//! A uniform B-spline of degree `d` is `x(t) = Σ_r B_r(u) c_{i+r}`, `r = 0 … d`, on interval `i`, with `u = (t − t_i)/h ∈ [0, 1)`.
//! The weights follow from de Boor's recursion (`deboor2001`). A cubic spline has a piecewise constant third derivative: joint by joint it is the
//! jerk-controlled motion of `vamvaka2021`. A rotation is a cumulative spline (`sommer2020`): `R(t) = R_i Π_r exp(λ_r(u) log(R_{i+r−1}ᵀ R_{i+r}))`.
//!
//! Each interval depends on `d + 1` control points. A least-squares fit is therefore banded, and its time is linear in the duration.

mod fit;
mod knots;
mod rotation_fit;
mod rotation_sensitivity;
mod vector_spline;

pub use fit::{SplineFit, fit_vectors};
pub use knots::{Degree, LARGEST_ORDER, UniformKnots, Weights};
pub use rotation_fit::{RotationFit, fit_rotations};
pub use rotation_sensitivity::{
    RotationSensitivity, left_jacobian_inverse, right_jacobian, right_jacobian_inverse, rotation_sensitivity,
    skew,
};
pub use vector_spline::{RotationAt, RotationSpline, VectorSpline};
