//! Readings of a sensor over time.

use super::{Axis, ReadingUnit};
use nalgebra::Vector3;

/// A recording: times in seconds, strictly increasing, and a reading for each. A uniaxial sensor uses x, the others are zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Sample times, s.
    pub times_s: Vec<f64>,
    /// Readings, in [`unit`](Recording::unit).
    pub readings: Vec<Vector3<f64>>,
    /// Number of axes, 1 or 3.
    pub axes: usize,
    /// Unit of the readings.
    pub unit: ReadingUnit,
}

/// So many steps tell about where the median of all is.
const SOME: usize = 512;
/// Steps that differ from the median by this share are looked at,
const UNEVEN: f64 = 0.01;
/// first in eight blocks of so many samples.
const BLOCK: usize = 64;
/// The share of the steps that is near the median where there is a usual one.
const MOST: f64 = 0.48;
/// A step of so many medians is a pause.
const PAUSE: f64 = 20.0;
/// A step of so many usual ones is a gap,
const GAP: f64 = 5.0;
/// unless nothing moves in so short a time, s.
const MOVED_S: f64 = 0.05;

impl Recording {
    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.times_s.len()
    }

    /// Is there no sample?
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.times_s.is_empty()
    }

    /// The one value of an axis that never changes; `None` where it does.
    #[must_use]
    pub fn constant(&self, axis: Axis) -> Option<f64> {
        let value = self.readings.first()?[axis.index()];
        self.readings.iter().all(|reading| reading[axis.index()] == value).then_some(value)
    }

    /// Least and largest reading of each axis; ∞ and −∞ where there is no sample.
    #[must_use]
    pub(crate) fn extremes(&self) -> [Vector3<f64>; 2] {
        let infinite = Vector3::repeat(f64::INFINITY);
        self.readings.iter().fold([infinite, -infinite], |[least, most], y| {
            [least.zip_map(y, lesser), most.zip_map(y, greater)]
        })
    }

    /// The axes that were recorded.
    #[must_use]
    pub fn active_axes(&self) -> &'static [Axis] {
        &Axis::ALL[..self.axes]
    }

    /// Sample rate in Hz: the inverse of the usual time between samples, so that gaps do not matter; 0 for fewer than two samples.
    ///
    /// That is the median step. Where steps come in coarse units, as at 400 Hz in whole milliseconds, it is the mean of those within half of the median of it; where fewer than half
    /// are, as in times of arrival, that of all but pauses.
    #[must_use]
    pub fn rate_hz(&self) -> f64 {
        rate_hz(&self.times_s)
    }

    /// A time between samples longer than this, s, is a gap that parts what is before from what is after: of five usual steps, but no less than a sensor needs to be moved.
    #[must_use]
    pub(crate) fn gap_s(&self) -> f64 {
        (GAP / self.rate_hz()).max(MOVED_S)
    }
}

/// The lesser of two numbers, the first if they cannot be compared. For what is done with every sample: `f64::min` minds NaN and takes thrice as long.
#[inline]
pub(crate) fn lesser(one: f64, other: f64) -> f64 {
    if other < one { other } else { one }
}

/// The greater of two numbers, as [`lesser`].
#[inline]
pub(crate) fn greater(one: f64, other: f64) -> f64 {
    if other > one { other } else { one }
}

/// The inverse of the usual step between times in s, Hz; 0 for fewer than two.
pub(crate) fn rate_hz(times_s: &[f64]) -> f64 {
    if times_s.len() < 2 {
        return 0.0;
    }
    let median = median_step(times_s);
    let steps = || times_s.array_windows().map(|[one, next]| next - one);
    let mean = |is_meant: &dyn Fn(f64) -> bool| {
        let (sum, count) = steps()
            .filter(|step| is_meant(*step))
            .fold((0.0, 0), |(sum, count), step| (sum + step, count + 1));
        (sum / f64::from(count), count)
    };
    let is_uneven =
        |block: &[f64]| block.array_windows().any(|[one, next]| ((next - one) / median - 1.0).abs() > UNEVEN);
    let blocks = times_s.chunks((times_s.len() / 8).max(1)).map(|part| &part[..part.len().min(BLOCK)]);
    if times_s.len() < BLOCK || !blocks.into_iter().any(is_uneven) {
        return 1.0 / median;
    }
    let (near, count) = mean(&|step| (0.5..=1.5).contains(&(step / median)));
    let usual = match f64::from(count) < MOST * steps().len() as f64 {
        true => mean(&|step| step <= PAUSE * median).0,
        false => near,
    };
    if (usual / median - 1.0).abs() > UNEVEN { 1.0 / usual } else { 1.0 / median }
}

/// The median step between at least two times, s.
fn median_step(times_s: &[f64]) -> f64 {
    let steps = || times_s.array_windows().map(|[one, next]| next - one);
    let count = steps().len();
    let middle = count / 2;
    // some of the steps tell about where the median is: the others need only be compared with that
    let mut some: Vec<f64> = steps().step_by(count.div_ceil(SOME)).collect();
    some.sort_unstable_by(f64::total_cmp);
    let (low, high) = (some[some.len() * 2 / 5], some[some.len() * 3 / 5]);
    let (mut lower, mut not_higher) = (0, 0);
    for step in steps() {
        lower += usize::from(step < low);
        not_higher += usize::from(step <= high);
    }
    let is_between = (lower..not_higher).contains(&middle);
    if is_between && low == high {
        return low;
    }
    let (mut left, lower) = match is_between {
        true => (steps().filter(|step| (low..=high).contains(step)).collect(), lower),
        false => (steps().collect::<Vec<f64>>(), 0),
    };
    *left.select_nth_unstable_by(middle - lower, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rate_of_uneven_times_is_the_true_one() {
        let at = |time: &dyn Fn(usize) -> f64| -> Vec<f64> { (0..40_000).map(time).collect() };
        // at 400 Hz in whole milliseconds, and at 240 Hz
        for true_hz in [400.0, 240.0, 128.0] {
            let whole = at(&|k| (1e3 * k as f64 / true_hz).floor() / 1e3);
            let rate = rate_hz(&whole);
            assert!((rate / true_hz - 1.0).abs() < 1e-3, "{rate} {true_hz}");
            // three in ten samples lost, and one long pause
            let kept = |k: &usize| (k * 7919) % 10 >= 3;
            let some: Vec<f64> =
                (0..40_000).filter(kept).map(|k| whole[k] + if k > 20_000 { 60.0 } else { 0.0 }).collect();
            assert!((rate_hz(&some) / true_hz - 1.0).abs() < 0.01, "{} {true_hz}", rate_hz(&some));
        }
        // times of arrival: later by up to four steps, in order
        let mut late = at(&|k| (k as f64 + 4.0 * ((k * 7919 % 1009) as f64 / 1009.0).powi(2)) * 0.0025);
        late.sort_by(f64::total_cmp);
        assert!((rate_hz(&late) / 400.0 - 1.0).abs() < 0.02, "{}", rate_hz(&late));
        let recording = |times_s| Recording {
            times_s,
            readings: Vec::new(),
            axes: 3,
            unit: ReadingUnit::RadianPerSecond,
        };
        assert_eq!(recording(at(&|k| k as f64 * 0.0625)).gap_s(), 0.3125);
        assert_eq!(recording(at(&|k| k as f64 / 1024.0)).gap_s(), 0.05);
    }

    #[test]
    fn the_rate_is_that_of_the_median_step() {
        assert_eq!((rate_hz(&[]), rate_hz(&[1.0])), (0.0, 0.0));
        // steps of -1, 0, 0.25, 0.5 and 8
        assert_eq!(rate_hz(&[0.0, 0.5, 8.5, 7.5, 7.5, 7.75]), 4.0);
        // each step its own; all the same; some that stand for all the others badly
        let irregular = |k: usize| 0.01 + 1e-3 * (k as f64).sin();
        let every_64th = |k: usize| if k.is_multiple_of(64) { 0.5 } else { 0.01 + 1e-9 * k as f64 };
        for (count, step) in [
            (1000, &irregular as &dyn Fn(usize) -> f64),
            (50_001, &irregular),
            (50_000, &|_| 0.25),
            (512 * 64, &every_64th),
        ] {
            let mut times = vec![0.0];
            (0..count).for_each(|k| times.push(times[k] + step(k)));
            let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
            steps.sort_by(f64::total_cmp);
            assert_eq!(rate_hz(&times), 1.0 / steps[steps.len() / 2]);
        }
    }
}
