//! Hold detection without a threshold.
//!
//! On a logarithmic scale, the variance within a sliding window has a sharp peak at rest, for any noise. In a movement it spreads over decades.
//! The lowest peak gives the noise. The emptiest place above it separates rest from movement. This needs no threshold in absolute units, and
//! finds holds in trembling hands too.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::holds::HoldBeyondRecording;
use crate::error::{Error, InputError, Refusal, Result};
use crate::motion::{Hold, to_ms};
use crate::sensor::{MeanReading, Recording, SensorKind, Spikes, gap_s, greater, lesser};
use nalgebra::Vector3;
use std::f64::consts::LOG10_2;
use std::ops::Range;

/// Longest window, s. It is else half the shortest hold. Rotations between holds must show.
const LONGEST_WINDOW_S: f64 = 0.5;
/// Width of a bin of log₁₀ variance.
const BIN: f64 = 0.05;
/// Range of the search for the limit between rest and movement, in decades of variance above the peak of rest.
const VALLEY: (f64, f64) = (0.4, 1.2);
/// The lowest peak counts as rest if it has this share of the highest.
const PEAK: f64 = 0.2;
/// Share of a given hold that may lie outside the recording, since times may be rounded.
const ROUNDED_TIME_SHARE: f64 = 0.02;
/// Times are equal within this share of a step: times since 1970, or moved by an offset, are rounded elsewhere than times from 0.
pub(in crate::estimate) const ROUNDED_TIME_STEPS: f64 = 1e-3;
/// How far the mean may wander within a hold, in standard deviations of a sample.
const WANDER: f64 = 2.0;

/// The holds of a recording, at least `minimum_s` long, in order of time.
///
/// Spikes neither divide a hold nor count in its mean. Consecutive invalid samples end it, as a gap does ([`Recording::without_spikes`]).
///
/// # Errors
/// [`Error::Recording`] where the sample rate is too low for the shortest hold.
///
/// # Examples
/// ```
/// use calibrant_core::estimate::find_holds;
/// use calibrant_core::sensor::{ReadingUnit, SensorParameters};
/// use calibrant_core::simulate::{HoldsSimulation, Purpose, simulate_holds, stream};
/// use nalgebra::Vector3;
///
/// let setup = HoldsSimulation { poses: 12, hold_s: 4.0, turn_s: 1.5, rate_hz: 100.0, gravity_mps2: 9.81, between_holds_sd_mps2: 0.0 };
/// let sensor = SensorParameters::identity();
/// let unit = ReadingUnit::MetrePerSecondSquared;
/// let (recording, _) = simulate_holds(&sensor, &Vector3::repeat(0.01), unit, &setup, &mut stream(1, Purpose::Sensor, 0));
/// assert_eq!(find_holds(&recording, 1.0)?.len(), 12);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn find_holds(recording: &Recording, minimum_s: f64) -> Result<Vec<Hold>> {
    let (clean, spikes) = recording.without_spikes(SensorKind::Accelerometer);
    Ok(as_recorded(find_clean_holds(&clean, minimum_s)?, spikes.as_ref()))
}

/// The same holds in the recording before samples were removed from it.
pub(in crate::estimate) fn as_recorded(mut holds: Vec<Hold>, spikes: Option<&Spikes>) -> Vec<Hold> {
    if let Some(spikes) = spikes {
        for hold in &mut holds {
            (hold.first, hold.end) = (spikes.place(hold.first), spikes.place(hold.end - 1) + 1);
        }
    }
    holds
}

/// [`find_holds`] in a recording whose spikes were removed before ([`Recording::without_spikes`]).
///
/// # Errors
/// As [`find_holds`].
pub fn find_clean_holds(recording: &Recording, minimum_s: f64) -> Result<Vec<Hold>> {
    let rate = recording.rate_hz();
    if minimum_s * rate < 8.0 {
        return Err(Error::recording(InputError::new(
            Refusal::HoldsMissing,
            format!(
                "the samples are {:.3} s apart: a hold of {minimum_s} s has fewer than 8 of them",
                1.0 / rate
            ),
            "is the time column in seconds? if so, give the holds yourself (holds.intervals_s), or raise holds.minimum_hold_s; where each row is the mean of a hold, say option `rows_are_holds`",
        )));
    }
    let (segments, window) = still_segments(recording, minimum_s, rate);
    let long = segments.into_iter().filter(|(from, to)| (to - from) as f64 >= minimum_s * rate);
    Ok(long.filter_map(|(from, to)| steady(recording, from + window / 2, to - window / 2, window)).collect())
}

/// The stationary segments, of any length: first sample and one past the last. Also the number of samples in a window.
pub(super) fn still_segments(
    recording: &Recording,
    minimum_s: f64,
    rate_hz: f64,
) -> (Vec<(usize, usize)>, usize) {
    let window = (((minimum_s / 2.0).min(LONGEST_WINDOW_S) * rate_hz).round() as usize).max(5);
    let mut segments = Vec::new();
    // of absurd times a window has more samples than can be counted twice
    if recording.len() / 2 < window {
        return (segments, window);
    }
    let mean = recording.readings.iter().sum::<Vector3<f64>>() / recording.len() as f64;
    let variance = window_variance(recording, &mean, window, gap_s(rate_hz));
    let Some(threshold) = threshold(&variance, resolution(recording, &mean)) else {
        return (segments, window);
    };
    let mut k = 0;
    while k < variance.len() {
        if variance[k] > threshold {
            k += 1;
            continue;
        }
        let start = k;
        while k < variance.len() && variance[k] <= threshold {
            k += 1;
        }
        // the stationary windows reach from sample `start` to `k − 1 + window`; a sample belongs to a hold if the window around it is stationary
        segments.push((start, k - 1 + window));
    }
    (segments, window)
}

/// Sum over the axes of the variance within each window of `window` samples. Infinite for windows across a gap.
///
/// `mean`: rough mean of the samples, which keeps digits.
fn window_variance(recording: &Recording, mean: &Vector3<f64>, window: usize, gap_s: f64) -> Vec<f64> {
    let n = recording.len();
    let (mut sum, mut squares) = (Vector3::zeros(), 0.0);
    let mut gaps = 0_usize;
    // of a sample in the mean of a window: a division for each would take longer than all else
    let share = 1.0 / window as f64;
    let gap = |k: usize| usize::from(recording.times_s[k + 1] - recording.times_s[k] > gap_s);
    let mut variance = Vec::with_capacity(n - window + 1);
    for k in 0..n {
        let y = recording.readings[k] - mean;
        sum += y;
        squares += y.norm_squared();
        if k > 0 {
            gaps += gap(k - 1);
        }
        if k >= window {
            let old = recording.readings[k - window] - mean;
            sum -= old;
            squares -= old.norm_squared();
            gaps -= gap(k - window);
        }
        if k + 1 >= window {
            let v = (squares - sum.norm_squared() * share) * share;
            variance.push(if gaps > 0 { f64::INFINITY } else { v.max(0.0) });
        }
        // a fresh start now and then keeps rounding from accumulating
        if k % 4096 == 4095 {
            (sum, squares) = (Vector3::zeros(), 0.0);
            for reading in &recording.readings[(k + 1).saturating_sub(window)..=k] {
                sum += reading - mean;
                squares += (reading - mean).norm_squared();
            }
        }
    }
    variance
}

/// The smallest meaningful variance: that of the quantisation, `q²/12` for each axis with the smallest step `q` between samples,
/// or of a millionth of the range, where the running sums round.
fn resolution(recording: &Recording, mean: &Vector3<f64>) -> f64 {
    let range = recording.readings.iter().map(|y| (y - mean).norm_squared()).fold(0.0, greater);
    let mut steps = Vector3::repeat(f64::INFINITY);
    for pair in recording.readings.windows(2) {
        let step = (pair[1] - pair[0]).abs();
        // without a branch, which would be unpredictable
        steps =
            steps.zip_map(&step, |least, step| lesser(least, if step > 0.0 { step } else { f64::INFINITY }));
    }
    let quantisation: f64 = steps.iter().filter(|step| step.is_finite()).map(|step| step * step / 12.0).sum();
    // without noise, the smallest step is a movement
    (quantisation.min(1e-4 * range) + 1e-12 * range).max(f64::MIN_POSITIVE)
}

/// The variance that separates rest from movement. `None` if the sensor is never at rest. Variances below `floor` count as equal.
fn threshold(variance: &[f64], floor: f64) -> Option<f64> {
    let finite = || variance.iter().copied().filter(|v| v.is_finite());
    let (least, largest) = finite().fold((f64::INFINITY, 0.0), |(a, b), v| (lesser(a, v), greater(b, v)));
    if least > largest {
        return None;
    }
    // the logarithm to base 2 is the faster one
    let decade = |v: f64| v.max(floor).log2() * LOG10_2;
    let lowest = decade(least);
    let bins = ((decade(largest) - lowest) / BIN).ceil() as usize + 1;
    let mut histogram = vec![0.0; bins];
    for v in finite() {
        histogram[((decade(v) - lowest) / BIN) as usize] += 1.0;
    }
    let density = smooth(&histogram);
    let highest = density.iter().copied().fold(0.0, f64::max);
    let peak = (0..bins).find(|&k| {
        density[k] >= PEAK * highest
            && density[k] >= *density.get(k + 1).unwrap_or(&0.0)
            && (k == 0 || density[k] >= density[k - 1])
    })?;
    let bin = |decades: f64| ((peak as f64 + decades / BIN) as usize).min(bins);
    let (from, to) = (bin(VALLEY.0), bin(VALLEY.1));
    let valley = (from..to).min_by(|&a, &b| density[a].total_cmp(&density[b])).unwrap_or(from);
    Some(10.0_f64.powf(lowest + (valley as f64 + 0.5) * BIN))
}

/// Binomial smoothing, about 0.1 decade wide.
fn smooth(histogram: &[f64]) -> Vec<f64> {
    let at = |k: isize| if k < 0 { 0.0 } else { histogram.get(k as usize).copied().unwrap_or(0.0) };
    (0..histogram.len() as isize)
        .map(|k| (at(k - 2) + 4.0 * at(k - 1) + 6.0 * at(k) + 4.0 * at(k + 1) + at(k + 2)) / 16.0)
        .collect()
}

/// The hold from `first` to `end`, its ends cut off where the mean wanders; `None` if it wanders throughout (a slow rotation).
fn steady(recording: &Recording, first: usize, end: usize, window: usize) -> Option<Hold> {
    let block = (window / 2).max(2).min(end - first);
    let starts: Vec<usize> = (first..=end - block).step_by(block).collect();
    let blocks: Vec<Hold> = starts.iter().map(|&k| summarise(recording, k, (k + block).min(end))).collect();
    let center = Vector3::from_fn(|axis, _| median(blocks.iter().map(|block| block.mean[axis]).collect()));
    let spread = Vector3::from_fn(|axis, _| median(blocks.iter().map(|block| block.sd[axis]).collect()));
    let limit = WANDER * spread.norm();
    let calm = |block: &&Hold| (block.mean - center).norm() <= limit.max(1e-9 * center.norm());
    let from = blocks.iter().find(calm)?.first;
    let to = blocks.iter().rev().find(calm)?.end;
    let restless =
        blocks.iter().filter(|block| block.first >= from && block.end <= to && !calm(block)).count();
    if restless * 10 > blocks.len() {
        return None;
    }
    let to = if to + block > end { end } else { to };
    (to > from + window / 2).then(|| summarise(recording, from, to))
}

/// The median of at least one value: of an even number, the larger of the middle two.
pub(in crate::estimate) fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Mean and standard deviation of the samples `first..end`.
fn summarise(recording: &Recording, first: usize, end: usize) -> Hold {
    let segment = MeanReading::of(&recording.readings[first..end]).unwrap_or_default();
    Hold {
        first,
        end,
        start_s: recording.times_s[first],
        end_s: recording.times_s[end - 1],
        mean: segment.mean,
        sd: MeanReading::pooled_sd([&segment]),
    }
}

/// Given holds that reach beyond the recording. Only their samples in the recording count.
pub(in crate::estimate) fn beyond(recording: &Recording, intervals_s: &[(f64, f64)]) -> Vec<Diagnostic> {
    let (Some(&first), Some(&last), [_, ..]) =
        (recording.times_s.first(), recording.times_s.last(), intervals_s)
    else {
        return Vec::new();
    };
    let step = 1.0 / recording.rate_hz();
    let outside = |(_, (start, end)): &(usize, &(f64, f64))| {
        let missing = (first - start).max(0.0) + (end - last).max(0.0);
        missing > (ROUNDED_TIME_SHARE * (end - start)).max(2.0 * step)
    };
    let beyond = |(k, &(start_s, end_s)): (usize, &(f64, f64))| {
        Diagnostic::from(HoldBeyondRecording {
            hold: k + 1,
            start_s,
            end_s,
            recording_start_s: first,
            recording_end_s: last,
            common_s: end_s.min(last) - start_s.max(first),
        })
    };
    intervals_s.iter().enumerate().filter(outside).map(beyond).collect()
}

/// The holds between these (start, end) times in s. Where each has one sample, these are means.
///
/// # Errors
/// [`Error::Recording`] names an interval with fewer than two samples, or that overlaps another.
pub fn holds_between(recording: &Recording, intervals_s: &[(f64, f64)]) -> Result<Vec<Hold>> {
    let mut holds: Vec<Hold> = Vec::with_capacity(intervals_s.len());
    let slack_s = ROUNDED_TIME_STEPS / recording.rate_hz();
    let samples = |&(start, stop): &(f64, f64)| {
        let first = recording.times_s.partition_point(|&t| t < start - slack_s);
        first..recording.times_s.partition_point(|&t| t <= stop + slack_s)
    };
    // rows that are means
    let fewest = if intervals_s.iter().all(|interval| samples(interval).len() == 1) { 1 } else { 2 };
    for (k, &(start, stop)) in intervals_s.iter().enumerate() {
        let Range { start: first, end } = samples(&(start, stop));
        if end < first + fewest {
            return Err(Error::recording(InputError::new(
                Refusal::HoldsInvalid,
                format!(
                    "hold {} from {} to {} s has {} samples; the recording spans {} to {} s",
                    k + 1,
                    to_ms(start),
                    to_ms(stop),
                    end.saturating_sub(first),
                    to_ms(recording.times_s[0]),
                    to_ms(recording.times_s[recording.len() - 1])
                ),
                "correct holds.intervals_s",
            )));
        }
        if let Some(other) = holds.iter().position(|hold| first < hold.end && hold.first < end) {
            return Err(Error::recording(InputError::new(
                Refusal::HoldsInvalid,
                format!("holds {} and {} overlap", other + 1, k + 1),
                "correct holds.intervals_s: no sample may count twice",
            )));
        }
        holds.push(summarise(recording, first, end));
    }
    holds.sort_by_key(|hold| hold.first);
    Ok(holds)
}
