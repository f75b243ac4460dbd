//! The numbers that the recursion computes with.
//!
//! The recursion is written once, for any [`Number`]. With `f64` it gives values. With [`Dual`] numbers `x + ε ẋ` it gives a derivative along a
//! direction beside each value. With [`Six`] it does so for six directions at once.

use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// What the recursion needs of a number.
pub(crate) trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// A constant.
    fn of(value: f64) -> Self;
}

impl Number for f64 {
    fn of(value: f64) -> Self {
        value
    }
}

/// Six numbers side by side: one for each row of a reading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Six(pub(crate) [f64; 6]);

impl Six {
    /// The unit of row `row`.
    pub(crate) fn unit(row: usize) -> Self {
        let mut six = Self([0.0; 6]);
        six.0[row] = 1.0;
        six
    }

    /// The sum of the six.
    pub(crate) fn sum(self) -> f64 {
        self.0.iter().sum()
    }
}

macro_rules! lanewise {
    ($($operator:ident $function:ident $sign:tt;)*) => {$(
        impl $operator for Six {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(std::array::from_fn(|k| self.0[k] $sign other.0[k]))
            }
        }
    )*};
}

lanewise! { Add add +; Sub sub -; Mul mul *; }

impl Neg for Six {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|x| -x))
    }
}

impl AddAssign for Six {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Six {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Number for Six {
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self([value; 6])
    }
}

/// A value, and its derivative along a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Dual<T> {
    /// The value.
    pub(crate) value: T,
    /// The derivative.
    pub(crate) slope: T,
}

impl<T: Number> Dual<T> {
    #[inline(always)]
    pub(crate) fn new(value: T, slope: T) -> Self {
        Self { value, slope }
    }
}

impl<T: Number> Add for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.value + other.value, self.slope + other.slope)
    }
}

impl<T: Number> Sub for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.value - other.value, self.slope - other.slope)
    }
}

impl<T: Number> Mul for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(self.value * other.value, self.value * other.slope + self.slope * other.value)
    }
}

impl<T: Number> Neg for Dual<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.value, -self.slope)
    }
}

impl<T: Number> AddAssign for Dual<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Number> SubAssign for Dual<T> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<T: Number> Number for Dual<T> {
    #[inline(always)]
    fn of(value: f64) -> Self {
        Self::new(T::of(value), T::of(0.0))
    }
}
