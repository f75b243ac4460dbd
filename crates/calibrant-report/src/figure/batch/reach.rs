//! The part of an axis that shows a batch, whatever a few of its sensors read.
//!
//! Values far from the median are left out, but not a second lot: far values that agree, of more than a few sensors, are reached.

/// Robust standard deviations about the median that are shown, of many sensors.
const SHOWN_SD: f64 = 4.5;
/// The same grows by this over the number of sensors, since the scale of few is not known well.
const OF_FEW: f64 = 12.0;
/// Far values agree where each is at most this many times as far from the median as the one before it.
const AGREE: f64 = 1.3;
/// The fewest sensors of a second lot, and the share of all sensors that it exceeds.
const FEWEST_OF_LOT: usize = 2;
const SHARE_OF_LOT: f64 = 0.05;
/// A limit is shown where it makes the axis at most this many times longer.
const MOST_LONGER: f64 = 6.0;
/// Of a normal distribution, standard deviation over median absolute deviation.
const SD_OVER_MAD: f64 = 1.4826;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reach {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Reach {
    /// The values near the median, in robust standard deviations, and every second lot; `least_width` is its least width. `None` for no values.
    pub(super) fn of(values: &[f64], least_width: f64) -> Option<Self> {
        let centre = median(values)?;
        let distances: Vec<f64> = values.iter().map(|value| (value - centre).abs()).collect();
        let scale = SD_OVER_MAD * median(&distances)?;
        // half of the values are the same: there is no robust scale
        let most = match scale > 0.0 {
            true => (SHOWN_SD + OF_FEW / values.len() as f64) * scale,
            false => f64::INFINITY,
        };
        let near = most.max(0.5 * least_width);
        let [below, above] = [-1.0, 1.0].map(|side| farthest(values, |value| side * (value - centre), near));
        let shown = || values.iter().copied().filter(|v| (-below..=above).contains(&(v - centre)));
        let (low, high) = shown().fold((centre, centre), |(low, high), v| (low.min(v), high.max(v)));
        let missing = 0.5 * (least_width - (high - low)).max(0.0);
        Some(Self { low: low - missing, high: high + missing })
    }

    pub(super) fn width(self) -> f64 {
        self.high - self.low
    }

    pub(super) fn contains(self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// The reach with room on both sides.
    pub(super) fn widened(self, by: f64) -> Self {
        Self { low: self.low - by, high: self.high + by }
    }

    /// The reach with this value.
    pub(super) fn including(self, value: f64) -> Self {
        Self { low: self.low.min(value), high: self.high.max(value) }
    }

    /// The reach with these values, where that does not make it much longer.
    pub(super) fn with(self, values: &[f64]) -> Option<Self> {
        let longer = values.iter().copied().fold(self, Self::including);
        (longer.width() <= MOST_LONGER * self.width()).then_some(longer)
    }
}

/// The largest distance to one side of the median at which a value is near, or belongs to a second lot.
fn farthest(values: &[f64], distance: impl Fn(f64) -> f64, near: f64) -> f64 {
    let fewest = FEWEST_OF_LOT.max((SHARE_OF_LOT * values.len() as f64) as usize + 1);
    let mut outwards: Vec<f64> = values.iter().map(|value| distance(*value)).filter(|d| *d >= 0.0).collect();
    outwards.sort_by(f64::total_cmp);
    let (near, far) = outwards.split_at(outwards.partition_point(|d| *d <= near));
    let lots = far.chunk_by(|one, next| *next <= AGREE * one).filter(|lot| lot.len() >= fewest);
    lots.chain([near]).filter_map(|lot| lot.last().copied()).fold(0.0, f64::max)
}

/// The least width of an axis: where all sensors agree, their standard deviations show.
pub(super) fn least_width(values: &[f64], sds: &[f64]) -> f64 {
    let rounding = 1e-9 * values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    (2.0 * median(sds).unwrap_or(0.0)).max(rounding).max(f64::MIN_POSITIVE)
}

/// A step of 1, 2, 5, 10, … that makes at most five of them.
pub(super) fn whole_step(most: usize) -> f64 {
    let steps = (0..).flat_map(|decade| [1.0, 2.0, 5.0].map(|step| step * 10f64.powi(decade)));
    steps.into_iter().find(|step| 5.0 * step >= most as f64).unwrap_or(1.0)
}

pub(super) fn median(values: &[f64]) -> Option<f64> {
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

    /// Good sensors: evenly from 0 to 1.
    fn good(count: i32) -> impl Iterator<Item = f64> {
        (0..count).map(move |k| f64::from(k) / f64::from(count - 1))
    }

    #[test]
    fn a_second_lot_is_reached() {
        let lots: Vec<f64> = good(14).chain(good(7).map(|value| 12.0 + value)).collect();
        assert_eq!(Reach::of(&lots, 0.0), Some(Reach { low: 0.0, high: 13.0 }));
        let below: Vec<f64> = lots.iter().map(|value| -value).collect();
        assert_eq!(Reach::of(&below, 0.0), Some(Reach { low: -13.0, high: 0.0 }));
        let five = [0.0, 0.5, 1.0, 50.0, 51.0];
        assert_eq!(Reach::of(&five, 0.0), Some(Reach { low: 0.0, high: 51.0 }), "two of five");
    }

    #[test]
    fn faults_of_a_few_sensors_do_not_flatten_the_others() {
        let faults = [-40.0, -9.0, -8.5, 7.0, 8.0, 9.8, 98.0, 99.0, 1e3, 1e6];
        let batch: Vec<f64> = good(190).chain(faults).collect();
        assert_eq!(Reach::of(&batch, 0.0), Some(Reach { low: 0.0, high: 1.0 }));
        let few: Vec<f64> = good(17).chain([20.0, 90.0, -300.0]).collect();
        assert_eq!(Reach::of(&few, 0.0), Some(Reach { low: 0.0, high: 1.0 }), "three do not agree");
    }

    #[test]
    fn limits_are_shown_where_they_are_near() {
        let reach = Reach { low: 0.0, high: 1.0 };
        assert_eq!(reach.with(&[-1.0, 2.0]), Some(Reach { low: -1.0, high: 2.0 }));
        assert_eq!(reach.with(&[-9.0, 9.0]), None);
    }
}
