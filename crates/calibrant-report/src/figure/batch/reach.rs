//! The part of an axis that shows a batch, whatever a few of its sensors read.

/// Robust standard deviations about the median that are shown, of many sensors.
const SHOWN_SD: f64 = 4.5;
/// The same grows by this over the number of sensors, since the scale of few is not known well.
const OF_FEW: f64 = 12.0;
/// A limit is shown where it makes the axis at most this many times longer.
const MOST_LONGER: f64 = 6.0;
/// Of a normal distribution, standard deviation over median absolute deviation.
const SD_OVER_MAD: f64 = 1.4826;

/// A part of an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reach {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Reach {
    /// All values but those far from the median, in robust standard deviations; `least_width` is its least width. `None` for no values.
    pub(super) fn of(values: &[f64], least_width: f64) -> Option<Self> {
        let centre = median(values)?;
        let distances: Vec<f64> = values.iter().map(|value| (value - centre).abs()).collect();
        let scale = SD_OVER_MAD * median(&distances)?;
        // half of the values are the same: there is no robust scale
        let most = match scale > 0.0 {
            true => (SHOWN_SD + OF_FEW / values.len() as f64) * scale,
            false => f64::INFINITY,
        };
        let near =
            || values.iter().copied().filter(|value| (value - centre).abs() <= most.max(0.5 * least_width));
        let (low, high) = near().fold((centre, centre), |(low, high), v| (low.min(v), high.max(v)));
        let missing = 0.5 * (least_width - (high - low)).max(0.0);
        Some(Self { low: low - missing, high: high + missing })
    }

    pub(super) fn width(self) -> f64 {
        self.high - self.low
    }

    pub(super) fn contains(self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// The reach with these values, where that does not make it much longer.
    pub(super) fn with(self, values: &[f64]) -> Option<Self> {
        let (low, high) =
            values.iter().fold((self.low, self.high), |(low, high), v| (low.min(*v), high.max(*v)));
        (high - low <= MOST_LONGER * self.width()).then_some(Self { low, high })
    }
}

/// The least width of an axis: where all sensors agree, their standard deviations show.
pub(super) fn least_width(values: &[f64], sds: &[f64]) -> f64 {
    let rounding = 1e-9 * values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    (2.0 * median(sds).unwrap_or(0.0)).max(rounding).max(f64::MIN_POSITIVE)
}

/// The median of finite values.
fn median(values: &[f64]) -> Option<f64> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => None,
        odd if odd % 2 == 1 => Some(sorted[middle]),
        _ => Some(0.5 * (sorted[middle - 1] + sorted[middle])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_far_value_does_not_flatten_the_others() {
        let mut values: Vec<f64> = (0..20).map(|k| f64::from(k) / 19.0).collect();
        assert_eq!(Reach::of(&values, 0.0), Some(Reach { low: 0.0, high: 1.0 }));
        values.push(1e6);
        assert_eq!(Reach::of(&values, 0.0), Some(Reach { low: 0.0, high: 1.0 }));
        assert_eq!(Reach::of(&[2.0], 1.0), Some(Reach { low: 1.5, high: 2.5 }));
        assert_eq!(Reach::of(&[], 1.0), None);
    }

    #[test]
    fn limits_are_shown_where_they_are_near() {
        let reach = Reach { low: 0.0, high: 1.0 };
        assert_eq!(reach.with(&[-1.0, 2.0]), Some(Reach { low: -1.0, high: 2.0 }));
        assert_eq!(reach.with(&[-9.0, 9.0]), None);
    }
}
