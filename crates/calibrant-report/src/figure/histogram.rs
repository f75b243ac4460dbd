//! Bars of equal width, and the normal curve beside them.

use super::panel::Points;
use std::f64::consts::TAU;

/// Bars of equal width.
#[derive(Debug)]
pub(super) struct Histogram {
    pub(super) low: f64,
    pub(super) width: f64,
    pub(super) counts: Vec<usize>,
}

impl Histogram {
    /// Counts of finite values in equal bins over their range; `None` for no values.
    pub(super) fn of(values: &[f64], bins: usize) -> Option<Self> {
        let low = values.iter().copied().reduce(f64::min)?;
        let high = values.iter().copied().reduce(f64::max)?;
        let (low, high) = if high > low { (low, high) } else { (low - 0.5, high + 0.5) };
        Some(Self::within(values, low, high, bins.max(1)))
    }

    /// Counts in equal bins between these ends; values beyond them join the outer bins.
    pub(super) fn within(values: &[f64], low: f64, high: f64, bins: usize) -> Self {
        let width = (high - low) / bins as f64;
        let mut counts = vec![0; bins];
        for value in values {
            let bin = ((value - low) / width).floor().clamp(0.0, (bins - 1) as f64);
            counts[bin as usize] += 1;
        }
        Self { low, width, counts }
    }

    pub(super) fn most(&self) -> usize {
        self.counts.iter().copied().max().unwrap_or(1)
    }

    /// The outline of the bars, from zero to zero.
    pub(super) fn outline(&self) -> Points {
        let edge = |i: usize| self.low + self.width * i as f64;
        let mut outline = vec![(edge(0), 0.0)];
        for (i, &count) in self.counts.iter().enumerate() {
            outline.extend([(edge(i), count as f64), (edge(i + 1), count as f64), (edge(i + 1), 0.0)]);
        }
        outline
    }
}

/// Number of histogram bins for n values: Rice's rule, 2 ∛n, from 5 to 60.
pub(super) fn bin_count(n: usize) -> usize {
    ((2.0 * (n as f64).cbrt()).ceil() as usize).clamp(5, 60)
}

/// The normal curve of this area and standard deviation, from `−reach` to `reach`.
pub(super) fn normal_curve(area: f64, sd: f64, reach: f64) -> Points {
    let density = |x: f64| area * (-0.5 * (x / sd).powi(2)).exp() / (sd * TAU.sqrt());
    (0..=120).map(|i| reach * (f64::from(i) / 60.0 - 1.0)).map(|x| (x, density(x))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn histogram_counts_every_value_once() {
        let values: Vec<f64> = (0..1000).map(|i| f64::from(i) / 999.0).collect();
        let bins = Histogram::of(&values, 10).expect("values");
        assert_eq!(bins.counts.iter().sum::<usize>(), 1000);
        assert_eq!(Histogram::of(&[2.0; 7], 5).expect("values").counts.iter().sum::<usize>(), 7);
        assert!(Histogram::of(&[], 5).is_none());
    }
}
