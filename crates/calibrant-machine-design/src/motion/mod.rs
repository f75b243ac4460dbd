//! The motion: uniform cubic B-splines of the joints' positions, from rest to rest.
//!
//! # Formula
//! `q(t) = Σ_r B_r(u) c_{i+r}`, `r = 0 … 3`, in interval `i` of length `h`, `u = t/h − i`. Velocity, acceleration and jerk are splines of lower degree with the
//! control points
//!
//! ```text
//! (c_{i+1} − c_i)/h        (c_{i+2} − 2c_{i+1} + c_i)/h²        (c_{i+3} − 3c_{i+2} + 3c_{i+1} − c_i)/h³
//! ```
//!
//! A spline lies in the convex hull of its control points, so limits on these hold for all times. Three equal control points are rest at a knot; each further
//! one that is equal holds the machine for another interval: a dwell.

mod halving;
mod knots;
mod quadrature;
mod ties;

pub(crate) use halving::halved;
pub(crate) use knots::{Grid, Knots, derivative, derivatives, rows_at};
pub(crate) use quadrature::gauss_legendre;
pub(crate) use ties::{REST, Ties};
