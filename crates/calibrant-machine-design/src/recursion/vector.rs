//! Vectors and matrices of the recursion's numbers. nalgebra's would ask more of a number than the recursion does.

use super::number::Number;
use nalgebra::{Matrix3, Vector3};
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// Three numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct V<T>(pub(crate) [T; 3]);

impl<T: Number> V<T> {
    #[inline(always)]
    pub(crate) fn zero() -> Self {
        Self([T::of(0.0); 3])
    }

    pub(crate) fn of(v: &Vector3<f64>) -> Self {
        Self([T::of(v[0]), T::of(v[1]), T::of(v[2])])
    }

    #[inline(always)]
    pub(crate) fn dot(&self, other: &Self) -> T {
        self.0[0] * other.0[0] + self.0[1] * other.0[1] + self.0[2] * other.0[2]
    }

    #[inline(always)]
    pub(crate) fn cross(&self, other: &Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }
}

impl<T: Number> Add for V<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl<T: Number> Sub for V<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] - other.0[k]))
    }
}

impl<T: Number> Neg for V<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl<T: Number> Mul<T> for V<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: T) -> Self {
        Self(self.0.map(|x| x * factor))
    }
}

impl<T: Number> AddAssign for V<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Number> SubAssign for V<T> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

/// Three rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct M<T>(pub(crate) [V<T>; 3]);

impl<T: Number> M<T> {
    pub(crate) fn of(m: &Matrix3<f64>) -> Self {
        Self(std::array::from_fn(|i| V(std::array::from_fn(|j| T::of(m[(i, j)])))))
    }

    /// The matrix times a vector.
    #[inline(always)]
    pub(crate) fn times(&self, v: &V<T>) -> V<T> {
        V(std::array::from_fn(|i| self.0[i].dot(v)))
    }

    /// The transposed matrix times a vector.
    #[inline(always)]
    pub(crate) fn transposed_times(&self, v: &V<T>) -> V<T> {
        self.0[0] * v.0[0] + self.0[1] * v.0[1] + self.0[2] * v.0[2]
    }
}
