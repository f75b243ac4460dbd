//! Spikes: single samples far off those beside them, and readings that no sensor gives. A lost bit, a loose contact; no movement.
//!
//! One spike of 1000 standard deviations makes a still sensor look moved for as long as a window is, divides a hold, shifts its mean, and turns a gyroscope that does not turn. So spikes are
//! taken out before holds are looked for, each replaced by the line between the samples beside it.
//!
//! # What is one
//! In a hold: a sample off the median of the nine about it by more than [`STILL_DEVIATIONS`] robust standard deviations of the difference of two successive samples, with stillness for [`STILL_S`] on both
//! sides. A knock while the sensor is put down is as far off, but a movement is near.
//!
//! In a movement, of a gyroscope (an accelerometer's movements count for nothing): a sample whose second difference is large, stands out among those of its neighbours, and has half of itself
//! with the opposite sign on each side, as one sample alone has: neither the kink where a turn begins, nor a step, nor a short turn has.
//!
//! A noise of finite variance has at most a quarter beyond any distance of what it has beyond half of it. Where what is far off is not that much fewer than what is half as far off, it is noise,
//! and only what is farther off is a spike.
//!
//! # Invalid readings
//! What is left and a thousand times as far from the median as everything else, with nothing in between, is no reading: a movement passes through what lies between. These samples are cut
//! out, so that a gap is where they were.

use super::{Axis, Recording, SensorKind, greater, lesser};
use rayon::prelude::*;
use std::borrow::Cow;

/// Robust standard deviations of the difference of two successive samples, in a hold: 10 of white noise.
const STILL_DEVIATIONS: f64 = 7.0;
/// The same in a movement, which is rough by itself.
const MOVING_DEVIATIONS: f64 = 12.0;
/// A sample that is off the median of those about it stands out of those beside it by this share of that.
const CANDIDATE: f64 = 0.7;
/// So many samples are asked at once whether they stand out.
const AT_ONCE: usize = 64;
/// Samples about one, itself included, with which it is compared.
const WINDOW_SAMPLES: usize = 9;
/// Samples near their median are off it by fewer deviations than this.
const NEAR_DEVIATIONS: f64 = 4.0;
/// A knock is several samples: one beside it that is not near either makes it none, unless it is so many times as far off as it must be; two do always.
const BEYOND_A_KNOCK: f64 = 3.0;
/// So long on both sides samples are near the same median, s,
const STILL_S: f64 = 0.8;
/// Of these samples one in so many may be another spike.
const OTHER_SPIKES_ONE_IN: usize = 25;
/// Neighbours on each side whose second differences tell how rough a movement is; the two next to a spike have half of its own.
const BESIDE: std::ops::RangeInclusive<usize> = 2..=10;
/// Number of these neighbours on both sides.
const NEIGHBOURS: usize = 18;
/// The second difference of a spike is larger by this factor than all but three of those beside it: another spike has three.
const STANDS_OUT: f64 = 4.0;
/// The second differences next to it are this share of its own, less this many deviations of noise; half without noise, a third in a turn of three samples.
const OPPOSITE: (f64, f64) = (0.4, 1.5);
/// Of a noise of finite variance, as many times as many are between half a distance and the distance as beyond it.
const HEAVY_TAIL: usize = 3;
/// Where more than one sample in so many is off, the sensor is not one that is still and turned.
const MOST_SPIKES_ONE_IN: usize = 50;
/// Median of the absolute deviations of normal noise, times this, is its standard deviation.
const MAD: f64 = 1.4826;
/// So many samples tell about how large steps and deviations usually are.
const MEDIAN_SAMPLES: usize = 2048;
/// Binary orders of magnitude between readings and what is none.
const BINARY_ORDERS: usize = 10;

/// What was taken out of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Spikes {
    /// Which samples were replaced, from 0, in order.
    pub samples: Vec<usize>,
    /// Which were cut out, in order: invalid readings, more than two in a row.
    pub cut: Vec<usize>,
    /// Axis of the one that is farthest off.
    pub axis: Axis,
    /// Its time, s.
    pub time_s: f64,
    /// Its reading, in the unit of the readings.
    pub reading: f64,
    /// How far it is off, in standard deviations of a sample's noise; infinite where there is none.
    pub deviations: f64,
}

impl Spikes {
    /// Place in the recording as it was read of a sample of the one without.
    pub(crate) fn place(&self, sample: usize) -> usize {
        self.cut.iter().fold(sample, |place, cut| place + usize::from(*cut <= place))
    }
}

impl Recording {
    /// The recording without spikes and invalid readings, and what they were; the recording itself where there are none.
    ///
    /// # Examples
    /// ```
    /// use calibrant::sensor::{ReadingUnit, Recording, SensorKind};
    /// use nalgebra::Vector3;
    /// let times_s: Vec<f64> = (0..500).map(|k| f64::from(k) * 0.01).collect();
    /// let mut readings: Vec<Vector3<f64>> = times_s.iter().map(|t| Vector3::new((700.0 * t).sin(), (900.0 * t).cos(), 9.8)).collect();
    /// readings[123].y = -2_147_483_648.0;
    /// let recording = Recording { times_s, readings, axes: 3, unit: ReadingUnit::Counts };
    /// let (clean, spikes) = recording.without_spikes(SensorKind::Accelerometer);
    /// let spikes = spikes.expect("one");
    /// assert_eq!((spikes.samples.as_slice(), spikes.reading), (&[123][..], -2_147_483_648.0));
    /// assert!(clean.readings[123].y.abs() < 1.0 && clean.readings[123].x == recording.readings[123].x);
    /// ```
    #[must_use]
    pub fn without_spikes(&self, sensor_kind: SensorKind) -> (Cow<'_, Self>, Option<Spikes>) {
        let axes = self.active_axes();
        // as a hold is: where the sensor pauses, samples are as many
        let still = (STILL_S * self.rate_hz()).round() as usize;
        let found: Vec<Found> =
            axes.par_iter().map(|axis| AxisReadings::new(self, *axis, sensor_kind, still).found()).collect();
        let every = found.iter().zip(axes);
        let every = every.flat_map(|(found, axis)| found.all().map(move |spike| (*axis, spike)));
        let Some((axis, farthest)) =
            every.reduce(|one, other| if other.1.off > one.1.off { other } else { one })
        else {
            return (Cow::Borrowed(self), None);
        };
        let places = |of: &dyn Fn(&Found) -> &[Spike]| {
            let mut places: Vec<usize> =
                found.iter().flat_map(|found| of(found).iter().map(|spike| spike.sample)).collect();
            places.sort_unstable();
            places.dedup();
            places
        };
        let spikes = Spikes {
            samples: places(&|found| &found.spikes),
            cut: places(&|found| &found.invalid),
            axis,
            time_s: self.times_s[farthest.sample],
            reading: self.readings[farthest.sample][axis.index()],
            deviations: farthest.off * std::f64::consts::SQRT_2,
        };
        let mut clean = self.clone();
        for (axis, found) in axes.iter().zip(&found) {
            for spike in &found.spikes {
                clean.readings[spike.sample][axis.index()] = spike.instead;
            }
        }
        without(&mut clean.times_s, &spikes.cut);
        without(&mut clean.readings, &spikes.cut);
        (Cow::Owned(clean), Some(spikes))
    }
}

/// Takes these places, in order, out of a list.
pub(super) fn without<T>(list: &mut Vec<T>, places: &[usize]) {
    let (mut k, mut next) = (0, places.iter().peekable());
    list.retain(|_| {
        let is_one = next.next_if(|place| **place == k).is_some();
        k += 1;
        !is_one
    });
}

/// A sample that is off.
#[derive(Clone, Copy)]
struct Spike {
    sample: usize,
    /// By how many robust standard deviations of the difference of two samples.
    off: f64,
    /// What takes its place.
    instead: f64,
}

/// What was found on an axis, in order.
struct Found {
    spikes: Vec<Spike>,
    invalid: Vec<Spike>,
}

impl Found {
    fn all(&self) -> impl Iterator<Item = &Spike> {
        self.spikes.iter().chain(&self.invalid)
    }
}

/// The readings of one axis.
struct AxisReadings<'a> {
    times_s: &'a [f64],
    values: Vec<f64>,
    /// Robust standard deviation of the difference of two successive ones, no less than the finest step.
    scale: f64,
    /// Samples on each side of a spike in which the sensor is still.
    still: usize,
    moves: bool,
}

impl<'a> AxisReadings<'a> {
    fn new(recording: &'a Recording, axis: Axis, sensor_kind: SensorKind, still: usize) -> Self {
        let values: Vec<f64> = recording.readings.iter().map(|reading| reading[axis.index()]).collect();
        let steps = || values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let finest = |least: f64, step: f64| if step > 0.0 { lesser(least, step) } else { least };
        let mut some: Vec<f64> = steps().step_by(values.len().div_ceil(MEDIAN_SAMPLES).max(1)).collect();
        let mut least = some.iter().copied().fold(f64::INFINITY, finest);
        let typical = middle(&mut some);
        // of readings coarser than their noise, most are like those beside them
        if typical == 0.0 {
            least = steps().fold(f64::INFINITY, finest);
        }
        let scale = (MAD * typical).max(if least.is_finite() { least } else { 0.0 });
        let (times_s, moves) = (recording.times_s.as_slice(), sensor_kind == SensorKind::Gyroscope);
        Self { times_s, values, scale, still: still.max(WINDOW_SAMPLES / 2), moves }
    }

    fn found(mut self) -> Found {
        let mut spikes = self.spikes();
        self.bridge(&mut spikes);
        Found { invalid: self.invalid(), spikes }
    }

    /// The spikes, in order.
    fn spikes(&self) -> Vec<Spike> {
        let n = self.values.len();
        if n < 2 * WINDOW_SAMPLES || self.scale <= 0.0 {
            return Vec::new();
        }
        let candidates = self.standing_out(CANDIDATE * STILL_DEVIATIONS * self.scale);
        let (mut found, least) =
            self.far_off(&candidates, STILL_DEVIATIONS, |k, least| self.off_the_still(k, least));
        if self.moves {
            let off_the_moving = |k, least| self.off_the_moving(k, least);
            let (moving, _) = self.far_off(&candidates, MOVING_DEVIATIONS, off_the_moving);
            // noise of a heavy tail has it in a movement, too
            found.extend(moving.into_iter().filter(|spike| spike.off > least));
            found.sort_unstable_by_key(|spike| spike.sample);
            found.dedup_by_key(|spike| spike.sample);
        }
        if found.len() > (n / MOST_SPIKES_ONE_IN).max(1) { Vec::new() } else { found }
    }

    /// The samples that are off by so much and more; by more where these are not much fewer than those that are off by half. And by how much that is.
    fn far_off(
        &self,
        candidates: &[usize],
        far: f64,
        off: impl Fn(usize, f64) -> Option<f64>,
    ) -> (Vec<Spike>, f64) {
        let beyond = |least: f64, candidates: &[usize]| -> Vec<Spike> {
            let spike = |&sample: &usize| {
                let off = off(sample, least * self.scale)? / self.scale;
                Some(Spike { sample, off, instead: 0.0 })
            };
            candidates.iter().filter_map(spike).collect()
        };
        let mut found = beyond(far, candidates);
        if found.is_empty() {
            return (found, far);
        }
        let half = beyond(far / 2.0, &self.standing_out(CANDIDATE * far / 2.0 * self.scale));
        let mut least = far;
        loop {
            let beyond = |least: f64| half.iter().filter(|spike| spike.off > least).count();
            let (farther, half_as_far) = (beyond(least), beyond(least / 2.0) - beyond(least));
            if farther == 0 || half_as_far < HEAVY_TAIL * farther {
                break;
            }
            least *= 2.0;
        }
        found.retain(|spike| spike.off > least);
        (found, least)
    }

    /// The samples above both of their neighbours, or below both, by so much; or with the one before or after, above or below those beside the two. And the two at each end.
    ///
    /// This is asked of every sample, so of many at once and without a branch.
    fn standing_out(&self, least: f64) -> Vec<usize> {
        let stands_out = |[a, b, here, d, e]: &[f64; 5]| {
            let (low, high) = (here - least, here + least);
            let above = ((*b < low) & ((*d < low) | (*e < low))) | ((*a < low) & (*d < low));
            let below = ((*b > high) & ((*d > high) | (*e > high))) | ((*a > high) & (*d > high));
            above | below
        };
        let last = self.values.len() - 2;
        let mut found = vec![0, 1];
        for first in (2..last).step_by(AT_ONCE) {
            let block = &self.values[first - 2..(first + AT_ONCE).min(last) + 2];
            let places = || block.array_windows().zip(first..);
            if places().fold(false, |any, (five, _)| any | stands_out(five)) {
                found.extend(places().filter(|(five, _)| stands_out(five)).map(|(_, k)| k));
            }
        }
        found.extend([last, last + 1]);
        found
    }

    /// By how much a sample in a hold is off the median of those about it, if by more than this.
    fn off_the_still(&self, k: usize, least: f64) -> Option<f64> {
        let first = k.saturating_sub(WINDOW_SAMPLES / 2).min(self.values.len() - WINDOW_SAMPLES);
        let about = &self.values[first..first + WINDOW_SAMPLES];
        let mut sorted = [0.0; WINDOW_SAMPLES];
        sorted.copy_from_slice(about);
        let median = middle(&mut sorted);
        let not_near = |values: &[f64]| {
            values.iter().filter(|value| (*value - median).abs() > NEAR_DEVIATIONS * self.scale).count()
        };
        let own = (self.values[k] - median).abs();
        let others = if own > BEYOND_A_KNOCK * STILL_DEVIATIONS * self.scale { 1 } else { 0 };
        if own <= least || not_near(about) > 1 + others {
            return None;
        }
        let sides = [
            &self.values[k.saturating_sub(self.still)..k],
            &self.values[k + 1..][..self.still.min(self.values.len() - k - 1)],
        ];
        let is_still = |side: &&[f64]| not_near(side) <= 2 + side.len() / OTHER_SPIKES_ONE_IN;
        sides.iter().all(is_still).then_some(own)
    }

    /// By how much a sample in a movement is off the line between its neighbours, if by more than this.
    fn off_the_moving(&self, k: usize, least: f64) -> Option<f64> {
        let reach = BESIDE.end() + 1;
        if k < reach || k + reach >= self.values.len() {
            return None;
        }
        let bend = |k: usize| self.values[k] - 0.5 * (self.values[k - 1] + self.values[k + 1]);
        let own = bend(k);
        let size = own.abs();
        let half = OPPOSITE.0 * size - OPPOSITE.1 * self.scale;
        if size <= least || [k - 1, k + 1].iter().any(|&beside| -bend(beside) * own.signum() < half) {
            return None;
        }
        let mut others = [0.0; NEIGHBOURS];
        let beside = BESIDE.flat_map(|apart| [k - apart, k + apart]);
        others.iter_mut().zip(beside).for_each(|(other, k)| *other = bend(k).abs());
        let rough = *others.select_nth_unstable_by(NEIGHBOURS - 4, f64::total_cmp).1;
        (size > STANDS_OUT * rough).then_some(size)
    }

    /// Puts the line between the nearest others in the place of each spike.
    fn bridge(&mut self, spikes: &mut [Spike]) {
        let places: Vec<usize> = spikes.iter().map(|spike| spike.sample).collect();
        let is_good = |k: &usize| places.binary_search(k).is_err();
        for spike in spikes {
            let k = spike.sample;
            let before = (0..k).rev().find(is_good);
            let after = (k + 1..self.values.len()).find(is_good);
            spike.instead = match (before, after) {
                (Some(i), Some(j)) => {
                    let part = (self.times_s[k] - self.times_s[i]) / (self.times_s[j] - self.times_s[i]);
                    self.values[i] + part * (self.values[j] - self.values[i])
                }
                (Some(other), None) | (None, Some(other)) => self.values[other],
                (None, None) => self.values[k],
            };
            self.values[k] = spike.instead;
        }
    }

    /// What no sensor gives.
    fn invalid(&self) -> Vec<Spike> {
        let mut some: Vec<f64> =
            self.values.iter().step_by(self.values.len().div_ceil(MEDIAN_SAMPLES).max(1)).copied().collect();
        if some.is_empty() {
            return Vec::new();
        }
        let median = middle(&mut some);
        some.iter_mut().for_each(|value| *value = (*value - median).abs());
        let nearly_most = some.len() * 19 / 20;
        let usual = *some.select_nth_unstable_by(nearly_most, f64::total_cmp).1;
        let usual = if usual.is_finite() { usual } else { 0.0 };
        let size = |value: &f64| (value - median).abs();
        let most = self
            .values
            .iter()
            .map(size)
            .fold(0.0, |most, size| if size.is_nan() { f64::INFINITY } else { greater(most, size) });
        // a movement is larger, too: whether something lies between is asked only where it may be worth it
        if usual <= 0.0 || most <= (1 << BINARY_ORDERS) as f64 * usual {
            return Vec::new();
        }
        let order = |size: f64| (size.to_bits() >> 52) as usize;
        let mut counts = [0_usize; 2048];
        self.values.iter().for_each(|value| counts[order(size(value))] += 1);
        let mut occupied = (order(usual)..counts.len()).filter(|&k| counts[k] > 0);
        let mut last = order(usual);
        let far = |k: &usize| *k - std::mem::replace(&mut last, *k) > BINARY_ORDERS;
        let Some(least) = occupied.find(far) else { return Vec::new() };
        let is_invalid = |value: &f64| order(size(value)) >= least;
        if self.values.iter().filter(|value| is_invalid(value)).count()
            > self.values.len() / MOST_SPIKES_ONE_IN
        {
            return Vec::new();
        }
        let off = |value: &f64| if size(value).is_nan() { f64::INFINITY } else { size(value) / self.scale };
        let all = self.values.iter().enumerate().filter(|(_, value)| is_invalid(value));
        all.map(|(sample, value)| Spike { sample, off: off(value), instead: 0.0 }).collect()
    }
}

/// The larger of the middle two of some values; 0 of none.
fn middle(values: &mut [f64]) -> f64 {
    let half = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(half, f64::total_cmp).1 }
}
