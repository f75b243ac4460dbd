//! A vector over time.

use super::{Degree, LARGEST_ORDER, UniformKnots, Weights};
use nalgebra::{UnitQuaternion, Vector3};

/// Control points that differ by less, rad or m, are at rest: files round.
const AT_REST: f64 = 2e-6;

/// A spline of a vector: the positions of joints, or a position in space.
#[derive(Debug, Clone, PartialEq)]
pub struct VectorSpline {
    /// The knots.
    pub knots: UniformKnots,
    /// Number of components.
    pub dimension: usize,
    /// Control points, one after the other, `dimension` numbers each.
    pub controls: Vec<f64>,
}

impl VectorSpline {
    /// A derivative (0 to 3) of component `j` with these weights.
    #[must_use]
    pub fn component(&self, weights: &Weights, derivative: usize, j: usize) -> f64 {
        let first = weights.interval * self.dimension + j;
        let of = |r: usize| weights.derivative[derivative][r] * self.controls[first + r * self.dimension];
        (0..weights.order).map(of).sum()
    }

    /// A derivative (0 to 3) of all components with these weights.
    pub fn write(&self, weights: &Weights, derivative: usize, values: &mut [f64]) {
        for (j, value) in values.iter_mut().enumerate() {
            *value = self.component(weights, derivative, j);
        }
    }

    /// The same motion with so many intervals of rest before and after it. `None` where a cubic spline does not begin and end at rest.
    #[must_use]
    pub fn with_rest(&self, intervals: usize) -> Option<Self> {
        let rows: Vec<&[f64]> = self.controls.chunks_exact(self.dimension).collect();
        let alike = |rows: &[&[f64]]| {
            let near = |pair: &[&[f64]]| pair[0].iter().zip(pair[1]).all(|(a, b)| (a - b).abs() <= AT_REST);
            rows.windows(2).all(near)
        };
        let (first, last) = (rows.get(..3)?, rows.get(rows.len().checked_sub(3)?..)?);
        if self.knots.degree != Degree::Cubic || !alike(first) || !alike(last) {
            return None;
        }
        let rest = |of: &[f64]| of.repeat(intervals);
        let knots = UniformKnots {
            start_s: self.knots.start_s - self.knots.step_s * intervals as f64,
            intervals: self.knots.intervals + 2 * intervals,
            ..self.knots
        };
        let controls = [rest(first[0]), self.controls.clone(), rest(last[2])].concat();
        Some(Self { knots, controls, ..*self })
    }

    /// A derivative (0 to 3) at a time.
    ///
    /// # Examples
    /// ```
    /// use calibrant_machine::spline::{Degree, UniformKnots, VectorSpline};
    /// let knots = UniformKnots { start_s: 0.0, step_s: 0.5, intervals: 4, degree: Degree::Cubic };
    /// // control points on a line give the line
    /// let controls = (0..knots.controls()).map(|i| 3.0 * knots.centre_s(i)).collect();
    /// let spline = VectorSpline { knots, dimension: 1, controls };
    /// assert!((spline.at(1.2, 0)[0] - 3.6).abs() < 1e-12);
    /// assert!((spline.at(1.2, 1)[0] - 3.0).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn at(&self, time_s: f64, derivative: usize) -> Vec<f64> {
        let weights = self.knots.weights(time_s);
        (0..self.dimension).map(|j| self.component(&weights, derivative, j)).collect()
    }
}

/// A cumulative spline of rotations (`sommer2020`).
#[derive(Debug, Clone, PartialEq)]
pub struct RotationSpline {
    /// The knots.
    pub knots: UniformKnots,
    /// Control points, `world_from_body`.
    pub controls: Vec<UnitQuaternion<f64>>,
}

/// Orientation and angular motion at one time. The vectors are in the axes of the body.
#[derive(Debug, Clone, Copy)]
pub struct RotationAt {
    /// Orientation `R` of the body in the world.
    pub world_from_body: UnitQuaternion<f64>,
    /// Angular rate `ω`, rad/s.
    pub rate: Vector3<f64>,
    /// `ω̇`, rad/s².
    pub acceleration: Vector3<f64>,
    /// `ω̈`, rad/s³.
    pub jerk: Vector3<f64>,
}

/// The cumulative weights `λ_j` (1 ≤ j < order) of a derivative: `λ_j = Σ_{r ≥ j} w_r`.
pub(super) fn cumulative(weights: &[f64; LARGEST_ORDER], order: usize) -> [f64; LARGEST_ORDER] {
    let mut sums = [0.0; LARGEST_ORDER];
    let mut sum = 0.0;
    for r in (1..order).rev() {
        sum += weights[r];
        sums[r] = sum;
    }
    sums
}

impl RotationSpline {
    /// The rotation vector from control point `j − 1` to `j`.
    pub(super) fn difference(&self, j: usize) -> Vector3<f64> {
        (self.controls[j - 1].inverse() * self.controls[j]).scaled_axis()
    }

    /// Orientation and angular motion with these weights.
    ///
    /// `ω ← Aᵀω + λ̇ d`, `ω̇ ← Aᵀω̇ + λ̇ ω×d + λ̈ d`, `ω̈ ← Aᵀω̈ + λ̇ (Aᵀω̇)×d + λ̈ ω×d + λ̇ ω̇×d + λ⃛ d` with `A = exp(λ d)`, from one control point to the next.
    #[must_use]
    pub fn with(&self, weights: &Weights) -> RotationAt {
        let lambda: [_; 4] = std::array::from_fn(|m| cumulative(&weights.derivative[m], weights.order));
        let zero = Vector3::zeros();
        let mut at = RotationAt {
            world_from_body: self.controls[weights.interval],
            rate: zero,
            acceleration: zero,
            jerk: zero,
        };
        for r in 1..weights.order {
            let [l0, l1, l2, l3] = lambda.map(|of| of[r]);
            let d = self.difference(weights.interval + r);
            let a = UnitQuaternion::from_scaled_axis(d * l0);
            let [rate, acceleration, jerk] =
                [at.rate, at.acceleration, at.jerk].map(|v| a.inverse_transform_vector(&v));
            at.world_from_body *= a;
            at.rate = rate + d * l1;
            at.acceleration = acceleration + at.rate.cross(&d) * l1 + d * l2;
            at.jerk = jerk
                + acceleration.cross(&d) * l1
                + at.rate.cross(&d) * l2
                + at.acceleration.cross(&d) * l1
                + d * l3;
        }
        at
    }

    /// Orientation and angular motion at a time.
    ///
    /// # Examples
    /// ```
    /// use calibrant_machine::spline::{Degree, RotationSpline, UniformKnots};
    /// use nalgebra::{UnitQuaternion, Vector3};
    /// let knots = UniformKnots { start_s: 0.0, step_s: 0.1, intervals: 10, degree: Degree::Cubic };
    /// let about_z = |angle| UnitQuaternion::from_scaled_axis(Vector3::z() * angle);
    /// let controls = (0..knots.controls()).map(|i| about_z(2.0 * knots.centre_s(i))).collect();
    /// let at = RotationSpline { knots, controls }.at(0.44);
    /// assert!((at.rate - Vector3::z() * 2.0).norm() < 1e-12);
    /// assert!(at.world_from_body.angle_to(&about_z(0.88)) < 1e-12);
    /// ```
    #[must_use]
    pub fn at(&self, time_s: f64) -> RotationAt {
        self.with(&self.knots.weights(time_s))
    }
}
