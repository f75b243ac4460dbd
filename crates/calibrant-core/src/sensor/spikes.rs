//! Detection and removal of spikes and invalid samples in a recording: a lost bit, a loose contact; no
//! movement.
//!
//! One spike of 1000 standard deviations makes a stationary sensor look moved for the length of a window. It
//! divides a hold, shifts its mean, and turns a gyroscope that does not turn. So spikes are removed before
//! the search for holds. The line between the samples beside it replaces each.
//!
//! # What a spike is
//! In a hold, a spike is far from the median of the nine samples about it (Hampel, `hampel1974`). The
//! threshold is [`STILL_DEVIATIONS`] robust standard deviations of the difference of two successive samples.
//! The sensor must be stationary for [`REST_MARGIN_S`] on both sides. A knock while the sensor is put down is as
//! far off, but a movement is near.
//!
//! In a movement between holds, only the gyroscope is examined: an accelerometer's movements count for nothing. On a machine both are. A spike has
//! a large second difference that stands out among those of its neighbours. On each side, half of it appears
//! with the opposite sign. Only a single sample has that: neither the kink where a turn begins, nor a step,
//! nor a short turn has it. A pulse that the accelerometer shares is a knock, which is real motion.
//!
//! Noise of finite variance has at most a quarter as many samples beyond a distance as beyond half of it.
//! Where samples far off are not rarer by that much, they are noise. Only a sample still farther off is then
//! a spike.
//!
//! # Invalid readings
//! A remaining sample a thousand times as far from the median as everything else is invalid, if nothing lies
//! between. A movement passes through what lies between. Invalid samples are cut out, so they leave a gap.

use super::extremes::quantile;
use super::{Axis, Recording, SensorKind, greater, lesser};
use rayon::prelude::*;
use std::borrow::Cow;

/// Threshold in a hold: robust standard deviations of the difference of two successive samples. It is 10 of
/// white noise.
const STILL_DEVIATIONS: f64 = 7.0;
/// The threshold in a movement, which is rough by itself.
const MOVING_DEVIATIONS: f64 = 12.0;
/// A sample that is off the median of the samples about it is also off its neighbours by this share of that.
const CANDIDATE: f64 = 0.7;
/// Number of samples that are examined at once for standing out.
const AT_ONCE: usize = 64;
/// Number of samples, the examined one included, whose median is compared with it.
const WINDOW_SAMPLES: usize = 9;
/// Largest distance of a normal sample from its median, in deviations.
const NEAR_DEVIATIONS: f64 = 4.0;
/// A knock is several samples: one deviating sample beside it rules out a spike, unless the sample is this
/// many thresholds off. Two rule it out always.
const BEYOND_A_KNOCK: f64 = 3.0;
/// Time at rest before and after a spike: samples must be near the same median, s.
const REST_MARGIN_S: f64 = 0.8;
/// One in this number of the samples on both sides may be another spike.
const OTHER_SPIKES_ONE_IN: usize = 25;
/// Distances of the neighbours whose second differences measure the roughness of a movement. The two next to a
/// spike have half of its own.
const NEIGHBOUR_LAGS: std::ops::RangeInclusive<usize> = 2..=10;
/// Number of these neighbours on both sides.
const NEIGHBOURS: usize = 18;
/// The second difference of a spike exceeds all but three of those beside it by this factor: another spike
/// has three.
const STANDS_OUT: f64 = 4.0;
/// Both sensors show a knock within this time, s: one of them may be read or filtered later.
const APART_S: f64 = 0.02;
/// Number of samples on each side of a knock's time that its second difference is compared with.
const BESIDE_JOLT: usize = 10;
/// Second differences next to a spike, of opposite sign: least share of its own, less a number of deviations of noise. The
/// share is a half without noise, a third in a turn of three samples.
const FLANK_SHARE: (f64, f64) = (0.4, 1.5);
/// For noise of finite variance: ratio of samples between half a distance and the distance to samples beyond
/// it.
const HEAVY_TAIL: usize = 3;
/// Where more than one sample in this number is off, the sensor does not alternate between holds and turns.
const MOST_SPIKES_ONE_IN: usize = 50;
/// Standard deviation of normal noise over the median of its absolute deviations.
const SD_OVER_MAD: f64 = 1.4826;
/// Number of samples from which the usual size of steps and deviations is taken.
const MEDIAN_SAMPLES: usize = 2048;
/// Fewest powers of two between the valid readings and an invalid one, both measured from the median.
const BINARY_ORDERS: usize = 10;

/// The spikes and invalid samples that were removed from a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Spikes {
    /// Which samples were replaced, from 0, in order.
    pub samples: Vec<usize>,
    /// Which samples were cut out, in order: invalid readings, more than two in a row.
    pub cut: Vec<usize>,
    /// Axis of the sample that is farthest off.
    pub axis: Axis,
    /// Its time, s.
    pub time_s: f64,
    /// Its reading, in the unit of the readings.
    pub reading: f64,
    /// Its distance from its neighbours, in standard deviations of a sample's noise. Infinite without noise.
    pub deviations: f64,
}

impl Spikes {
    /// Index in the recording as it was read of a sample of the recording without spikes.
    pub(crate) fn place(&self, sample: usize) -> usize {
        self.cut.iter().fold(sample, |place, cut| place + usize::from(*cut <= place))
    }
}

impl Recording {
    /// The recording without spikes and invalid readings, and a list of them. The recording itself where
    /// there are none.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::sensor::{ReadingUnit, Recording, SensorKind};
    /// use nalgebra::Vector3;
    /// let times_s: Vec<f64> = (0..500).map(|k| f64::from(k) * 0.01).collect();
    /// let mut readings: Vec<Vector3<f64>> = times_s.iter().map(|t| Vector3::new((700.0 * t).sin(), (900.0 * t).cos(), 9.8)).collect();
    /// readings[123].y = -2_147_483_648.0;
    /// let recording = Recording::new(times_s, readings, 3, ReadingUnit::Counts)?;
    /// let (clean, spikes) = recording.without_spikes(SensorKind::Accelerometer);
    /// let spikes = spikes.expect("one");
    /// assert_eq!((spikes.samples.as_slice(), spikes.reading), (&[123][..], -2_147_483_648.0));
    /// assert!(clean.readings()[123].y.abs() < 1.0 && clean.readings()[123].x == recording.readings()[123].x);
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    #[must_use]
    pub fn without_spikes(&self, sensor_kind: SensorKind) -> (Cow<'_, Self>, Option<Spikes>) {
        self.without_spikes_beside(None, sensor_kind == SensorKind::Gyroscope)
    }

    /// The same with the recording of the other sensor, which shares real motion. `moves`: do movements count?
    pub(super) fn without_spikes_beside(
        &self,
        other: Option<&Self>,
        moves: bool,
    ) -> (Cow<'_, Self>, Option<Spikes>) {
        let axes = self.active_axes();
        // as a hold is measured: where the sensor pauses, the number of samples is the same
        let still = (REST_MARGIN_S * self.rate_hz()).round() as usize;
        let found: Vec<Found> = axes
            .par_iter()
            .map(|axis| AxisReadings::new((self, other), *axis, moves, still).found())
            .collect();
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

/// Does a sensor show a jolt at this time: a change of its reading that stands out among those beside it?
fn jolts(recording: &Recording, time_s: f64) -> bool {
    let step_s = recording.rate_hz().recip();
    let near = recording.between(time_s - APART_S - 1.5 * step_s, time_s + APART_S + 1.5 * step_s);
    let beside = near.start.saturating_sub(BESIDE_JOLT)..(near.end + BESIDE_JOLT).min(recording.len());
    let bends: Vec<(usize, f64)> = beside
        .filter(|k| (1..recording.len() - 1).contains(k))
        .map(|k| {
            let [before, here, after] = [k - 1, k, k + 1].map(|k| recording.readings[k]);
            (k, (here - 0.5 * (before + after)).norm())
        })
        .collect();
    let (inside, outside): (Vec<_>, Vec<_>) = bends.into_iter().partition(|(k, _)| near.contains(k));
    let most = inside.into_iter().map(|(_, bend)| bend).fold(0.0, greater);
    // another knock may be near
    let usual = quantile(outside.into_iter().map(|(_, bend)| bend).collect(), 0.8);
    usual.is_some_and(|usual| most > STANDS_OUT * usual)
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
    /// The value that replaces it.
    instead: f64,
}

/// The findings on an axis, in order.
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
    /// Robust standard deviation of the difference of two successive readings, at least the finest step.
    scale: f64,
    /// Number of samples on each side of a spike in which the sensor must be stationary.
    still: usize,
    moves: bool,
    other: Option<&'a Recording>,
}

impl<'a> AxisReadings<'a> {
    fn new(
        (recording, other): (&'a Recording, Option<&'a Recording>),
        axis: Axis,
        moves: bool,
        still: usize,
    ) -> Self {
        let values: Vec<f64> = recording.readings.iter().map(|reading| reading[axis.index()]).collect();
        let steps = || values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let finest = |least: f64, step: f64| if step > 0.0 { lesser(least, step) } else { least };
        let mut some: Vec<f64> = steps().step_by(values.len().div_ceil(MEDIAN_SAMPLES).max(1)).collect();
        let mut least = some.iter().copied().fold(f64::INFINITY, finest);
        let typical = middle(&mut some);
        // readings coarser than their noise mostly equal their neighbours
        if typical == 0.0 {
            least = steps().fold(f64::INFINITY, finest);
        }
        let scale = (SD_OVER_MAD * typical).max(if least.is_finite() { least } else { 0.0 });
        let times_s = recording.times_s.as_slice();
        Self { times_s, values, scale, still: still.max(WINDOW_SAMPLES / 2), moves, other }
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
            let is_shared =
                |spike: &Spike| self.other.is_some_and(|other| jolts(other, self.times_s[spike.sample]));
            found.extend(moving.into_iter().filter(|spike| spike.off > least && !is_shared(spike)));
            found.sort_unstable_by_key(|spike| spike.sample);
            found.dedup_by_key(|spike| spike.sample);
        }
        if found.len() > (n / MOST_SPIKES_ONE_IN).max(1) { Vec::new() } else { found }
    }

    /// The samples that are off by this much or more, and the threshold that was used. It is larger where
    /// these samples are not much rarer than samples that are off by half.
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

    /// The samples above both of their neighbours, or below both, by this much. Also pairs of samples above
    /// or below those beside the pair. Also the two samples at each end.
    ///
    /// Every sample is examined, many at once and without a branch.
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

    /// Distance of a sample in a hold from the median of the samples about it, if larger than this.
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

    /// Distance of a sample in a movement from the line between its neighbours, if larger than this.
    fn off_the_moving(&self, k: usize, least: f64) -> Option<f64> {
        let reach = NEIGHBOUR_LAGS.end() + 1;
        if k < reach || k + reach >= self.values.len() {
            return None;
        }
        let bend = |k: usize| self.values[k] - 0.5 * (self.values[k - 1] + self.values[k + 1]);
        let own = bend(k);
        let size = own.abs();
        let half = FLANK_SHARE.0 * size - FLANK_SHARE.1 * self.scale;
        if size <= least || [k - 1, k + 1].iter().any(|&beside| -bend(beside) * own.signum() < half) {
            return None;
        }
        let mut others = [0.0; NEIGHBOURS];
        let beside = NEIGHBOUR_LAGS.flat_map(|apart| [k - apart, k + apart]);
        others.iter_mut().zip(beside).for_each(|(other, k)| *other = bend(k).abs());
        let rough = *others.select_nth_unstable_by(NEIGHBOURS - 4, f64::total_cmp).1;
        (size > STANDS_OUT * rough).then_some(size)
    }

    /// Replaces each spike by the line between the nearest other samples.
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

    /// The invalid samples: values that no sensor gives.
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
        // a movement is larger, too: the gap between the values is examined only where it may be large enough
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
