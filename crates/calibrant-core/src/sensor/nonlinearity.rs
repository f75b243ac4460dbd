//! A response that is not linear: terms that bend the straight line of each sense element.
//!
//! With `u = S f/ρ`, the stimulus along the sensitive directions, and `ρ` the norms of the rows of `S`, a sensor reads
//! `y = b + ρ ∘ h(u)` with `h(u) = u + Σ_k c_k e_k(u)` for each axis. A turn of the true frame, `S → S R`, leaves the coefficients as they are.
//! One more shape is one more [`NonlinearTerm`].

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// The shape of a term, a function of the stimulus along the axis (`ieee1293`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NonlinearTerm {
    /// `e(u) = u²`: the second-order coefficient `K₂`, (m/s²)⁻¹.
    SecondOrder,
    /// `e(u) = |u|/2`: the gain for positive stimuli less that for negative ones, as a share of the gain. The standard calls it asymmetry.
    GainBySign,
}

/// Number of terms.
const TERMS: usize = NonlinearTerm::ALL.len();

/// Most steps of the inverse, and most halvings of one; three to five are usual, and none.
const MOST_STEPS: usize = 50;

/// No step goes where the response rises less than this, of 1.
const LEAST_SLOPE: f64 = 0.05;

impl NonlinearTerm {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::SecondOrder, Self::GainBySign];

    /// As in names of parameters: `second_order`, `gain_by_sign`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::SecondOrder => "second_order",
            Self::GainBySign => "gain_by_sign",
        }
    }

    /// The power `p` of `e(λ u) = λᵖ e(u)`, λ > 0. A coefficient has the unit (m/s²)¹⁻ᵖ.
    #[must_use]
    pub const fn power(self) -> i32 {
        match self {
            Self::SecondOrder => 2,
            Self::GainBySign => 1,
        }
    }

    /// Its key in files, with its unit.
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::SecondOrder => "second_order_per_mps2",
            Self::GainBySign => "gain_by_sign",
        }
    }

    /// Unit of its coefficient.
    #[must_use]
    pub const fn unit(self) -> &'static str {
        match self {
            Self::SecondOrder => "1/(m/s²)",
            Self::GainBySign => "1",
        }
    }

    /// `e(u)`.
    #[must_use]
    pub fn value(self, u: f64) -> f64 {
        match self {
            Self::SecondOrder => u * u,
            Self::GainBySign => 0.5 * u.abs(),
        }
    }

    /// `e′(u)`; at the kink of `|u|` that of positive stimuli.
    #[must_use]
    pub fn slope(self, u: f64) -> f64 {
        match self {
            Self::SecondOrder => 2.0 * u,
            Self::GainBySign => 0.5_f64.copysign(u),
        }
    }

    /// `e(u)` and `e′(u)` in C, of a variable `u`, as the C header has them.
    #[must_use]
    pub const fn in_c(self) -> [&'static str; 2] {
        match self {
            Self::SecondOrder => ["u * u", "2 * u"],
            Self::GainBySign => {
                ["(u < 0 ? -u : u) / 2", "(u < 0 ? (CALIBRANT_REAL)-0.5 : (CALIBRANT_REAL)0.5)"]
            }
        }
    }
}

/// The coefficients of a sensor's terms, zero where its response is linear.
///
/// # Examples
/// ```
/// use calibrant_core::sensor::{NonlinearTerm, SensorParameters};
/// use nalgebra::Vector3;
/// let mut sensor = SensorParameters::identity();
/// sensor.nonlinearity.of_mut(NonlinearTerm::GainBySign).x = 0.01;
/// let reading = |x: f64| sensor.reading(&Vector3::new(x, 0.0, 0.0)).x;
/// assert!((reading(9.8) / 9.8 - 1.005).abs() < 1e-12);
/// assert!((reading(-9.8) / -9.8 - 0.995).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Nonlinearity {
    coefficients: [Vector3<f64>; TERMS],
}

impl Nonlinearity {
    /// The coefficients of a term, one for each axis.
    #[must_use]
    pub const fn of(&self, term: NonlinearTerm) -> &Vector3<f64> {
        &self.coefficients[term as usize]
    }

    /// The same, to change them.
    pub const fn of_mut(&mut self, term: NonlinearTerm) -> &mut Vector3<f64> {
        &mut self.coefficients[term as usize]
    }

    /// Is the response linear?
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    fn sum(&self, axis: usize, of: impl Fn(NonlinearTerm) -> f64) -> f64 {
        NonlinearTerm::ALL.into_iter().map(|term| self.of(term)[axis] * of(term)).sum()
    }

    /// `h(u) − u` of an axis, m/s².
    #[must_use]
    pub fn bend(&self, axis: usize, u: f64) -> f64 {
        self.sum(axis, |term| term.value(u))
    }

    /// `h′(u)` of an axis.
    #[must_use]
    pub fn slope(&self, axis: usize, u: f64) -> f64 {
        1.0 + self.sum(axis, |term| term.slope(u))
    }

    /// The stimulus along an axis where `h(u) = v`, by Newton's method from zero.
    ///
    /// # Numerics
    /// Where no stimulus gives this reading, beyond the turning point of a parabola, it ends shortly before that point: no step goes where the response hardly rises.
    #[must_use]
    pub fn straightened(&self, axis: usize, v: f64) -> f64 {
        let mut u = f64::MIN_POSITIVE.copysign(v);
        for _ in 0..MOST_STEPS {
            let step = (u + self.bend(axis, u) - v) / self.slope(axis, u);
            let mut next = u - step;
            for _ in 0..MOST_STEPS {
                // the response goes through zero and keeps the sign
                if next * v >= 0.0 && self.slope(axis, next) >= LEAST_SLOPE {
                    break;
                }
                next = 0.5 * (u + next);
            }
            let is_close = (next - u).abs() <= 4.0 * f64::EPSILON * v.abs();
            u = next;
            if is_close {
                break;
            }
        }
        u
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::{Axis, Correction, Quantity, SensorParameters};
    use nalgebra::Matrix3;

    fn sensor() -> SensorParameters {
        let mut sensor = SensorParameters {
            bias: Vector3::new(0.2, -0.3, 0.1),
            matrix: Matrix3::new(1.02, 0.03, -0.01, 0.02, 0.97, 0.04, -0.02, 0.01, 1.01),
            ..SensorParameters::identity()
        };
        *sensor.nonlinearity.of_mut(NonlinearTerm::SecondOrder) = Vector3::new(2e-4, -1e-3, 5e-4);
        *sensor.nonlinearity.of_mut(NonlinearTerm::GainBySign) = Vector3::new(0.005, 0.02, -0.01);
        sensor
    }

    #[test]
    fn the_correction_gives_back_every_stimulus() {
        let correction = Correction::of(&sensor()).expect("regular");
        for force in [Vector3::new(9.8, -0.1, 3.0), Vector3::new(-40.0, 20.0, 0.0), Vector3::zeros()] {
            let error = correction.apply(&sensor().reading(&force)) - force;
            assert!(error.amax() < 1e-13, "{error}");
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let (force, step) = (Vector3::new(6.0, -7.0, 2.0), 1e-6);
        let quantities = Axis::ALL.into_iter().flat_map(|axis| {
            let terms = NonlinearTerm::ALL.map(|term| Quantity::Nonlinear(term, axis));
            let matrix = Axis::ALL.map(|column| Quantity::CrossAxis(axis, column));
            [Quantity::Bias(axis), Quantity::Scale(axis)].into_iter().chain(terms).chain(matrix)
        });
        for quantity in quantities {
            let moved = |step: f64| {
                let mut moved = sensor();
                quantity.add_to(&mut moved, step);
                moved.reading(&force)
            };
            let difference = (moved(step) - moved(-step)) / (2.0 * step);
            let error = (difference - quantity.derivative(&sensor(), &force)).amax();
            assert!(error < 1e-8, "{}: {error:e}", quantity.name());
        }
        for column in 0..3 {
            let by = Vector3::ith(column, step);
            let difference =
                (sensor().reading(&(force + by)) - sensor().reading(&(force - by))) / (2.0 * step);
            assert!((difference - sensor().by_stimulus(&force).column(column)).amax() < 1e-8);
        }
    }

    #[test]
    fn a_turn_of_the_true_frame_leaves_the_coefficients() {
        let turn =
            nalgebra::UnitQuaternion::from_euler_angles(0.3, -0.2, 1.0).to_rotation_matrix().into_inner();
        let (force, mut turned) = (Vector3::new(6.0, -7.0, 2.0), sensor());
        turned.matrix *= turn;
        assert!((turned.reading(&(turn.transpose() * force)) - sensor().reading(&force)).amax() < 1e-13);
    }

    #[test]
    fn a_reading_that_no_stimulus_gives_ends_near_the_turning_point() {
        let mut sensor = SensorParameters::identity();
        sensor.nonlinearity.of_mut(NonlinearTerm::SecondOrder).x = -0.02;
        let found = Correction::of(&sensor).expect("regular").apply(&Vector3::new(20.0, 0.0, 0.0));
        assert!((23.0..25.0).contains(&found.x), "it turns at 25: {found}");
    }
}
