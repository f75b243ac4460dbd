//! How a parameter scatters over the sensors: control limits of an individuals chart, and capability.
//!
//! The limits are `x̄ ± 2.66 MR̄`, with `MR̄` the mean of `|x_k − x_{k−1}|`: three standard deviations as neighbours show them, since
//! `3 / 1.128 = 2.66` (`iso7870_2`). A slow drift widens the spread of all sensors, but not that of neighbours. Figure, sentence and table take them from here.

use super::sensors::{Batch, BatchSensor};
use calibrant_core::diagnostic::acceptance::LimitBroken;
use calibrant_core::diagnostic::{Check, Usability};

/// Half the width of the control limits over the mean moving range.
const OVER_MOVING_RANGE: f64 = 2.66;
/// The fewest sensors that give control limits.
const FEWEST: usize = 5;

/// Limits within which sensors scatter at random.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Control {
    pub(crate) mean: f64,
    /// Three standard deviations.
    pub(crate) half_width: f64,
    /// The sensors that give them.
    pub(crate) sensors: usize,
}

impl Control {
    /// Of a parameter; `None` for too few sensors.
    pub(crate) fn of(batch: &Batch, place: usize) -> Option<Self> {
        Self::of_values(&values(batch, place).map(|(_, value)| value).collect::<Vec<f64>>())
    }

    /// Of values in their order.
    fn of_values(values: &[f64]) -> Option<Self> {
        if values.len() < FEWEST {
            return None;
        }
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let ranges = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let half_width = OVER_MOVING_RANGE * ranges.sum::<f64>() / (values.len() - 1) as f64;
        (half_width > 0.0).then_some(Self { mean, half_width, sensors: values.len() })
    }

    pub(crate) fn ends(self) -> [f64; 2] {
        [self.mean - self.half_width, self.mean + self.half_width]
    }

    /// The sensors beyond the limits, by their places in the batch.
    pub(crate) fn beyond(self, batch: &Batch, place: usize) -> Vec<usize> {
        let far = |(_, value): &(usize, f64)| (value - self.mean).abs() > self.half_width;
        values(batch, place).filter(far).map(|(number, _)| number).collect()
    }

    /// The distance from the mean to the nearer acceptance limit, in three standard deviations: Cpk, with its standard deviation.
    ///
    /// # References
    /// `iso22514`
    pub(crate) fn capability(self, (low, high): (f64, f64)) -> (f64, f64) {
        /// Degrees of freedom of a standard deviation from moving ranges, for each sensor.
        const FREEDOM: f64 = 0.62;
        let index = (self.mean - low).min(high - self.mean) / self.half_width;
        let count = self.sensors as f64;
        (index, (1.0 / (9.0 * count) + index * index / (2.0 * FREEDOM * (count - 1.0))).sqrt())
    }
}

/// The sensors that show how a parameter scatters, with their values: all but those whose calibration is bad by itself. A broken acceptance limit takes none out: what is
/// outside belongs to the scatter.
fn values(batch: &Batch, place: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
    let sensors = batch.sensors.iter().enumerate().filter(|(_, sensor)| !is_defective(sensor));
    sensors.filter_map(move |(number, sensor)| Some((number, sensor.estimate(place)?.0)))
}

fn is_defective(sensor: &BatchSensor) -> bool {
    let by_itself = |verdict: &calibrant_core::diagnostic::Verdict| {
        verdict.usability == Usability::Bad && verdict.codes.iter().any(|code| *code != LimitBroken::CODE)
    };
    sensor.verdict.as_ref().is_ok_and(by_itself)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_limits_are_those_of_the_individuals_chart() {
        // mean 59/6, moving ranges 2, 2, 1, 1, 2: mean 1.6
        let control = Control::of_values(&[9.0, 11.0, 9.0, 10.0, 11.0, 9.0]).expect("six values");
        assert!((control.mean - 59.0 / 6.0).abs() < 1e-12);
        assert!((control.half_width - 2.66 * 1.6).abs() < 1e-12);
        assert_eq!(Control::of_values(&[1.0; 4]), None, "too few");
        assert_eq!(Control::of_values(&[1.0; 9]), None, "no scatter");
    }

    #[test]
    fn capability_is_the_distance_to_the_nearer_limit() {
        let control = Control { mean: 1.0, half_width: 0.5, sensors: 101 };
        let (index, sd) = control.capability((-1.0, 1.8));
        assert!((index - 1.6).abs() < 1e-12 && (sd - 0.148).abs() < 1e-3, "{index} {sd}");
        assert!(control.capability((1.2, 3.0)).0 < 0.0, "the mean is outside");
    }
}
