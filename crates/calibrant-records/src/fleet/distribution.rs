//! How a quantity differs from sensor to sensor.

use schemars::JsonSchema;
use serde::Serialize;

/// The distribution of the values of many sensors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Distribution {
    /// Number of sensors.
    pub sensors: usize,
    /// Mean.
    pub mean: f64,
    /// Standard deviation from sensor to sensor; zero for one.
    pub sd: f64,
    /// Least value.
    pub least: f64,
    /// 5 % quantile.
    pub quantile_05: f64,
    /// Median.
    pub median: f64,
    /// 95 % quantile.
    pub quantile_95: f64,
    /// Greatest value.
    pub greatest: f64,
}

impl Distribution {
    /// That of these values. `None` without values; values that are not finite do not count.
    ///
    /// # Examples
    /// ```
    /// use calibrant_records::Distribution;
    /// let of = Distribution::of([1.0, 2.0, 3.0, 4.0, f64::NAN]).unwrap();
    /// assert_eq!((of.sensors, of.mean, of.median), (4, 2.5, 2.5));
    /// assert!((of.sd - (5.0f64 / 3.0).sqrt()).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        values.sort_unstable_by(f64::total_cmp);
        let (sensors, last) = (values.len(), values.len().checked_sub(1)?);
        let mean = values.iter().sum::<f64>() / sensors as f64;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let sd = if sensors > 1 { (squares / (sensors - 1) as f64).sqrt() } else { 0.0 };
        // between two values, the quantile is linear
        let at = |share: f64| {
            let place = share * last as f64;
            let (below, part) = (place.floor() as usize, place.fract());
            values[below] + part * (values[last.min(below + 1)] - values[below])
        };
        let [least, quantile_05, median, quantile_95, greatest] = [0.0, 0.05, 0.5, 0.95, 1.0].map(at);
        Some(Self { sensors, mean, sd, least, quantile_05, median, quantile_95, greatest })
    }

    /// How far a value is from the median, in units of the distance that a normal distribution of the same 5 % and 95 % quantiles calls a standard deviation. So a few sensors that
    /// are far off do not hide themselves. `None` where all values are the same.
    #[must_use]
    pub fn distance(&self, value: f64) -> Option<f64> {
        /// Standard deviations between the two quantiles of a normal distribution.
        const BETWEEN: f64 = 3.289_707_253_902_945;
        let robust_sd = (self.quantile_95 - self.quantile_05) / BETWEEN;
        (robust_sd > 0.0).then(|| (value - self.median) / robust_sd)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sensor_that_is_far_off_does_not_hide_itself() {
        let values = (0..100).map(|k| f64::from(k) / 100.0).chain([1000.0]);
        let of = Distribution::of(values).expect("values");
        let distance = of.distance(1000.0).expect("a spread");
        assert!(distance > 3000.0 && (1000.0 - of.mean) / of.sd < 11.0, "{of:?} {distance}");
        assert_eq!(Distribution::of([]), None);
        let same = Distribution::of([2.0, 2.0]).expect("values");
        assert_eq!((same.sd, same.distance(3.0)), (0.0, None));
    }
}
