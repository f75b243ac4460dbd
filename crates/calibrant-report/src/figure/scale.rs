//! The scale of an axis: where its values are drawn, and its ticks.

use super::panel::{AxisRange, round_above};
use crate::number_format::{fixed, tick};
use std::fmt;

/// About as many steps between ticks where their distance is not given.
const STEPS: f64 = 5.0;

/// A scale, between two coordinates of the drawing.
#[derive(Debug, Clone)]
pub(super) struct Scale {
    pub(super) low: f64,
    high: f64,
    log: bool,
    step: f64,
    /// Where its lower end is drawn.
    pub(super) from: f64,
    /// Where its upper end is drawn.
    pub(super) to: f64,
}

impl Scale {
    pub(super) fn new(axis: AxisRange, log: bool) -> Self {
        let (low, high) = axis.range;
        let step = axis.step.unwrap_or_else(|| round_above((high - low) / STEPS));
        Self { low, high, log, step, from: 0.0, to: 1.0 }
    }

    pub(super) fn drawn(self, from: f64, to: f64) -> Self {
        Self { from, to, ..self }
    }

    /// Where a value is drawn; not so far beyond the drawing that a browser rounds it.
    pub(super) fn at(&self, value: f64) -> f64 {
        let of = |value: f64| if self.log { value.max(f64::MIN_POSITIVE).log10() } else { value };
        let share = (of(value) - of(self.low)) / (of(self.high) - of(self.low));
        (self.from + share * (self.to - self.from)).clamp(-1e5, 1e5)
    }

    /// The values of the ticks, with their labels.
    pub(super) fn ticks(&self) -> Vec<(f64, String)> {
        let values: Vec<f64> = if self.log {
            let decades = self.low.log10().floor() as i32..=self.high.log10().ceil() as i32;
            let of_decade: &[f64] = if decades.clone().count() <= 4 { &[1.0, 2.0, 5.0] } else { &[1.0] };
            decades.flat_map(|decade| of_decade.iter().map(move |of| of * 10f64.powi(decade))).collect()
        } else {
            let (first, last) = (self.low / self.step, self.high / self.step);
            ((first - 1e-9).ceil() as i64..=(last + 1e-9).floor() as i64)
                .map(|k| k as f64 * self.step)
                .collect()
        };
        let shown = values.into_iter().filter(|&value| !self.log || (self.low..=self.high).contains(&value));
        shown.map(|value| (value, self.label(value))).collect()
    }

    /// Where the axis is far from zero, as in seconds since 1970, six digits do not distinguish its ticks.
    fn label(&self, value: f64) -> String {
        let span = self.high - self.low;
        if span > 1e-3 * self.low.abs().max(self.high.abs()) {
            return tick(value);
        }
        fixed(value, (1.0 - span.log10()).ceil().clamp(0.0, 9.0) as usize)
    }
}

/// Its ends, for the script of the page.
impl fmt::Display for Scale {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{} {}{}", self.low, self.high, if self.log { " 1" } else { "" })
    }
}

/// A coordinate in a drawing: two decimals.
pub(super) fn number(value: f64) -> f64 {
    (100.0 * value).round() / 100.0 + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(range: (f64, f64), step: Option<f64>, log: bool) -> Vec<String> {
        Scale::new(AxisRange { range, step }, log).ticks().into_iter().map(|tick| tick.1).collect()
    }

    #[test]
    fn ticks_are_round_and_those_far_from_zero_are_told_apart() {
        assert_eq!(labels((-0.21, 0.42), Some(0.2), false), ["−0.2", "0", "0.2", "0.4"]);
        assert_eq!(labels((-1.0, 1.0), None, false), ["−1", "−0.5", "0", "0.5", "1"]);
        assert_eq!(
            labels((1_700_000_000.0, 1_700_000_166.0), Some(80.0), false),
            ["1700000000", "1700000080", "1700000160"]
        );
        assert_eq!(labels((9.8, 9.802), Some(0.001), false), ["9.8000", "9.8010", "9.8020"]);
        assert_eq!(labels((0.4, 30.0), None, true), ["0.5", "1", "2", "5", "10", "20"]);
        assert_eq!(labels((0.02, 3e3), None, true).len(), 5);
    }

    #[test]
    fn values_stand_between_the_ends() {
        let scale = Scale::new(AxisRange { range: (0.1, 1000.0), step: None }, true).drawn(200.0, 100.0);
        assert!((scale.at(10.0) - 150.0).abs() < 1e-9 && (scale.at(0.1) - 200.0).abs() < 1e-9);
        assert!(scale.at(-1.0).is_finite());
    }
}
