//! Vectors and matrices of the recursion: each product is a line that the compiler sees through.

use nalgebra::{Matrix3, Vector3};
use std::ops::{Add, AddAssign, Mul, Neg, Sub};

/// Three numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct V(pub(crate) [f64; 3]);

impl V {
    pub(crate) const ZERO: Self = Self([0.0; 3]);

    pub(crate) fn of(v: &Vector3<f64>) -> Self {
        Self([v[0], v[1], v[2]])
    }

    #[inline(always)]
    pub(crate) fn dot(&self, other: &Self) -> f64 {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        a * x + b * y + c * z
    }

    pub(crate) fn norm(&self) -> f64 {
        self.dot(self).sqrt()
    }

    #[inline(always)]
    pub(crate) fn cross(&self, other: &Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }
}

impl Add for V {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([a + x, b + y, c + z])
    }
}

impl Sub for V {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([a - x, b - y, c - z])
    }
}

impl Neg for V {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let [a, b, c] = self.0;
        Self([-a, -b, -c])
    }
}

impl Mul<f64> for V {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        let [a, b, c] = self.0;
        Self([a * factor, b * factor, c * factor])
    }
}

impl AddAssign for V {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

/// Three rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct M(pub(crate) [V; 3]);

impl M {
    pub(crate) const IDENTITY: Self = Self([V([1.0, 0.0, 0.0]), V([0.0, 1.0, 0.0]), V([0.0, 0.0, 1.0])]);

    pub(crate) fn of(m: &Matrix3<f64>) -> Self {
        Self([0, 1, 2].map(|i| V([m[(i, 0)], m[(i, 1)], m[(i, 2)]])))
    }

    /// The matrix with these columns.
    #[inline(always)]
    pub(crate) fn of_columns([a, b, c]: [V; 3]) -> Self {
        let row = |i: usize| V([a.0[i], b.0[i], c.0[i]]);
        Self([row(0), row(1), row(2)])
    }

    /// The matrix times a vector.
    #[inline(always)]
    pub(crate) fn times(&self, v: &V) -> V {
        let Self([a, b, c]) = self;
        V([a.dot(v), b.dot(v), c.dot(v)])
    }

    /// The transposed matrix times a vector.
    #[inline(always)]
    pub(crate) fn transposed_times(&self, v: &V) -> V {
        let Self([a, b, c]) = self;
        *a * v.0[0] + *b * v.0[1] + *c * v.0[2]
    }

    /// The product of two matrices.
    #[inline(always)]
    pub(crate) fn product(&self, other: &Self) -> Self {
        let Self([a, b, c]) = self;
        Self([other.transposed_times(a), other.transposed_times(b), other.transposed_times(c)])
    }

    /// The product with the transposed of another matrix.
    #[inline(always)]
    pub(crate) fn product_transposed(&self, other: &Self) -> Self {
        let Self([a, b, c]) = self;
        Self([other.times(a), other.times(b), other.times(c)])
    }

    #[inline(always)]
    pub(crate) fn trace(&self) -> f64 {
        self.0[0].0[0] + self.0[1].0[1] + self.0[2].0[2]
    }

    /// `Σ x × y` of a sum of products `Σ x yᵀ`.
    #[inline(always)]
    pub(crate) fn axial(&self) -> V {
        let Self([V([_, xy, xz]), V([yx, _, yz]), V([zx, zy, _])]) = self;
        V([yz - zy, zx - xz, xy - yx])
    }
}
