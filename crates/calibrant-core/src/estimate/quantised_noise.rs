//! Quantised noise: the noise of readings before rounding, from the frequencies of their values.
//!
//! In holds with mean `μ_j` (in steps) and noise `σ`, the value k has the probability `Φ((k + ½ − μ_j)/σ) − Φ((k − ½ − μ_j)/σ)`. The likelihood of all counts is that of interval-censored
//! normal numbers. It is log-concave in `μ_j/σ` and `1/σ`, and has one maximum. A hold with only two values shows that the noise is small, and counts as such.
//! Without these holds, the estimate would be too large if a third value is rare.
//!
//! If all holds have only two values, the likelihood grows towards zero noise.

use statrs::function::erf::erfc;
use std::f64::consts::SQRT_2;

/// Lower end of the search, in steps.
const LEAST_NOISE: f64 = 0.02;
/// Upper end of the search, in steps.
const MOST_NOISE: f64 = 1.5;
/// Number of golden-section steps of a coarse search, which reduces the interval to a thousandth.
const COARSE_STEPS: usize = 16;
/// Number of golden-section steps of a fine search, which reduces the interval to a millionth.
const FINE_STEPS: usize = 30;
/// Least probability. A smaller one is rounding.
const LEAST_PROBABILITY: f64 = 1e-300;

/// The counts of each value in a hold: its number of steps above the smallest one, and the count.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Counts(Vec<(f64, f64)>);

impl Counts {
    /// The counts of readings, in steps.
    pub(super) fn of(values: &[f64], step: f64) -> Self {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let mut counts: Vec<(f64, f64)> = Vec::new();
        for value in values {
            let steps = ((value - least) / step).round();
            match counts.iter_mut().find(|(seen, _)| *seen == steps) {
                Some((_, count)) => *count += 1.0,
                None => counts.push((steps, 1.0)),
            }
        }
        Self(counts)
    }

    /// From the least value to the largest, in steps.
    fn span(&self) -> f64 {
        self.0.iter().map(|(steps, _)| *steps).fold(0.0, f64::max)
    }

    /// The largest log-likelihood with this noise, whatever the mean.
    fn log_likelihood(&self, noise: f64) -> f64 {
        // the mean is within a step of the values
        let of = |mean: f64| {
            let terms = self.0.iter().map(|(steps, count)| {
                let (low, high) = ((steps - 0.5 - mean) / noise, (steps + 0.5 - mean) / noise);
                count * between(low, high).max(LEAST_PROBABILITY).ln()
            });
            terms.sum::<f64>()
        };
        of(largest((-1.0, self.span() + 1.0), FINE_STEPS, &of))
    }
}

/// The noise before rounding, in steps, or 0 if it is too small to be seen. Holds with more than one step beyond the usual span have moved, and do not count.
pub(super) fn noise_in_steps(holds: &[Counts]) -> f64 {
    let mut spans: Vec<f64> = holds.iter().map(Counts::span).collect();
    spans.sort_by(f64::total_cmp);
    let Some(usual) = spans.get(spans.len() / 2) else { return 0.0 };
    let still: Vec<&Counts> = holds.iter().filter(|counts| counts.span() <= usual + 1.0).collect();
    if still.iter().all(|counts| counts.span() < 2.0) {
        return 0.0;
    }
    let of = |noise: f64| still.iter().map(|counts| counts.log_likelihood(noise)).sum::<f64>();
    largest((LEAST_NOISE, MOST_NOISE), COARSE_STEPS, &of)
}

/// Probability of a standard normal number between two.
fn between(low: f64, high: f64) -> f64 {
    let above = |z: f64| 0.5 * erfc(z / SQRT_2);
    // the difference of the smaller tails
    if low > 0.0 { above(low) - above(high) } else { above(-high) - above(-low) }
}

/// The maximum of a function with one maximum (golden section).
fn largest((mut low, mut high): (f64, f64), reductions: usize, of: &dyn Fn(f64) -> f64) -> f64 {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    let inner = |low: f64, high: f64| [high - golden * (high - low), low + golden * (high - low)];
    let [mut left, mut right] = inner(low, high);
    let (mut at_left, mut at_right) = (of(left), of(right));
    for _ in 0..reductions {
        if at_left < at_right {
            low = left;
            (left, at_left) = (right, at_right);
            right = inner(low, high)[1];
            at_right = of(right);
        } else {
            high = right;
            (right, at_right) = (left, at_left);
            left = inner(low, high)[0];
            at_left = of(left);
        }
    }
    0.5 * (low + high)
}
