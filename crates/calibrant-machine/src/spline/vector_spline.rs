//! A vector over time.

use super::{UniformKnots, Weights};

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
