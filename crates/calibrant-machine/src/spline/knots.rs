//! Knots at equal distances, and the weights of the control points between them.

/// Uniform knots: `intervals` intervals of `step_s` from `start_s` on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct UniformKnots {
    /// First knot, s.
    pub start_s: f64,
    /// Distance between knots, s.
    pub step_s: f64,
    /// Number of intervals.
    pub intervals: usize,
    /// Degree of the spline on them.
    pub degree: Degree,
}

impl UniformKnots {
    /// Knots of at most this distance from `start_s` to `end_s`.
    #[must_use]
    pub fn covering(start_s: f64, end_s: f64, step_s: f64, degree: Degree) -> Self {
        let intervals = ((end_s - start_s) / step_s - 1e-9).ceil().max(1.0);
        Self { start_s, step_s: (end_s - start_s) / intervals, intervals: intervals as usize, degree }
    }

    /// Number of control points.
    #[must_use]
    pub fn controls(&self) -> usize {
        self.intervals + self.degree.number()
    }

    /// Last knot, s.
    #[must_use]
    pub fn end_s(&self) -> f64 {
        self.start_s + self.step_s * self.intervals as f64
    }

    /// Time from the first knot to the last, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.step_s * self.intervals as f64
    }

    /// The interval that a time lies in; the first or the last for times outside.
    #[must_use]
    pub fn interval(&self, time_s: f64) -> usize {
        self.interval_after(time_s - self.start_s)
    }

    /// The interval that lies this time after the first knot.
    pub(crate) fn interval_after(&self, after_s: f64) -> usize {
        ((after_s / self.step_s).max(0.0) as usize).min(self.intervals - 1)
    }

    /// Time of interval `i`'s beginning, s.
    #[must_use]
    pub fn knot_s(&self, i: usize) -> f64 {
        self.start_s + self.step_s * i as f64
    }

    /// The weights of the control points at a time. Outside the knots the polynomial of the first or last interval continues.
    #[must_use]
    pub fn weights(&self, time_s: f64) -> Weights {
        self.weights_after(time_s - self.start_s)
    }

    /// The weights this time after the first knot. Times since 1970 are steps of 0.24 µs; the difference of two of them is exact.
    pub(crate) fn weights_after(&self, after_s: f64) -> Weights {
        let interval = self.interval_after(after_s);
        let u = (after_s - self.step_s * interval as f64) / self.step_s;
        Weights::at(interval, u, self.step_s, self.degree)
    }

    /// Time at which control point `i` has most weight (its Greville abscissa), s.
    #[must_use]
    pub fn centre_s(&self, i: usize) -> f64 {
        self.start_s + self.step_s * (i as f64 - 0.5 * (self.degree.number() as f64 - 1.0))
    }
}

/// Degree of a spline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Degree {
    /// Piecewise constant third derivative.
    Cubic,
    /// Continuous fourth derivative.
    Quintic,
}

impl Degree {
    /// The number.
    #[must_use]
    pub fn number(self) -> usize {
        match self {
            Self::Cubic => 3,
            Self::Quintic => 5,
        }
    }

    /// Number of control points that an interval depends on.
    #[must_use]
    pub fn order(self) -> usize {
        self.number() + 1
    }
}

/// Most control points that an interval depends on.
pub const LARGEST_ORDER: usize = 6;

/// Weights of the control points `interval … interval + order − 1`, for the value and three derivatives.
#[derive(Debug, Clone, Copy)]
pub struct Weights {
    /// The interval, which is the first control point, too.
    pub interval: usize,
    /// Number of control points.
    pub order: usize,
    /// `derivative[d][r]`: weight of control point `interval + r` in the `d`-th derivative, 1/sᵈ.
    pub derivative: [[f64; LARGEST_ORDER]; 4],
}

impl Weights {
    /// The weights at `u` (0 to 1) in an interval of `step_s`.
    #[must_use]
    pub fn at(interval: usize, u: f64, step_s: f64, degree: Degree) -> Self {
        match degree {
            Degree::Cubic => Self::of_degree::<3>(interval, u, step_s.recip()),
            Degree::Quintic => Self::of_degree::<5>(interval, u, step_s.recip()),
        }
    }

    /// The degree is known when this is compiled, so that the loops unroll. `rate` is the number of intervals a second.
    fn of_degree<const DEGREE: usize>(interval: usize, u: f64, rate: f64) -> Self {
        let mut derivative = [[0.0; LARGEST_ORDER]; 4];
        let mut basis = [0.0; LARGEST_ORDER];
        basis[0] = 1.0;
        for d in 0..=DEGREE {
            if d > 0 {
                basis = raised(&basis, d, u);
            }
            // the m-th derivative is made of differences of the basis of degree − m
            if let Some(order) = (DEGREE - d < 4).then_some(DEGREE - d) {
                derivative[order] = differenced(basis, d, order, rate);
            }
        }
        Self { interval, order: DEGREE + 1, derivative }
    }
}

/// The basis of degree `d` from that of `d − 1`.
#[inline(always)]
fn raised(lower: &[f64; LARGEST_ORDER], d: usize, u: f64) -> [f64; LARGEST_ORDER] {
    let (mut basis, share) = ([0.0; LARGEST_ORDER], (d as f64).recip());
    for r in 0..=d {
        let left = if r > 0 { (u + (d - r) as f64) * lower[r - 1] } else { 0.0 };
        let right = if r < d { ((r + 1) as f64 - u) * lower[r] } else { 0.0 };
        basis[r] = (left + right) * share;
    }
    basis
}

/// The derivative of this order, of weights that begin with a basis of degree `d`.
#[inline(always)]
fn differenced(mut weights: [f64; LARGEST_ORDER], d: usize, order: usize, rate: f64) -> [f64; LARGEST_ORDER] {
    for m in 1..=order {
        let lower = weights;
        for r in 0..=d + m {
            let left = if r > 0 { lower[r - 1] } else { 0.0 };
            let right = if r < d + m { lower[r] } else { 0.0 };
            weights[r] = (left - right) * rate;
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubic_weights_are_those_of_the_textbook() {
        let u: f64 = 0.3;
        let weights = Weights::at(4, u, 0.5, Degree::Cubic);
        let v = 1.0 - u;
        let expected = [
            v * v * v / 6.0,
            (3.0 * u.powi(3) - 6.0 * u * u + 4.0) / 6.0,
            (-3.0 * u.powi(3) + 3.0 * u * u + 3.0 * u + 1.0) / 6.0,
            u.powi(3) / 6.0,
        ];
        for (weight, expected) in weights.derivative[0].iter().zip(expected) {
            assert!((weight - expected).abs() < 1e-15);
        }
        // third derivative of u³/6 with du/dt = 2
        assert!((weights.derivative[3][3] - 8.0).abs() < 1e-12);
        assert!((weights.derivative[3][1] - 24.0).abs() < 1e-12);
    }

    #[test]
    fn each_derivative_is_that_of_the_one_before() {
        for degree in [Degree::Cubic, Degree::Quintic] {
            let (step_s, eps) = (0.2, 1e-6);
            let [before, at, after] = [-eps, 0.0, eps].map(|e| Weights::at(0, 0.6 + e, step_s, degree));
            for d in 0..3 {
                for r in 0..degree.order() {
                    let slope = (after.derivative[d][r] - before.derivative[d][r]) / (2.0 * eps * step_s);
                    let exact = at.derivative[d + 1][r];
                    assert!(
                        (slope - exact).abs() < 1e-6 * (1.0 + exact.abs()),
                        "{degree:?} {d} {r}: {slope} {exact}"
                    );
                }
            }
            assert!((at.derivative[0].iter().sum::<f64>() - 1.0).abs() < 1e-14);
        }
    }
}
