//! Readings that repeat bit by bit while the times go on: a sensor or logger that is stuck, or one that is read more often than it measures.
//!
//! # What repeats
//! The samples are first joined to runs of equal readings. What their noise is shows where successive readings go up and down: a smooth motion without noise hardly
//! turns back. With `R` such reversals and `n` samples, of which `N₂` begin a run of two or more, an ordinary reading is that of the sample before with probability of
//! at most `h = 2 N₂ / R`. Runs of `L` samples with `n h^(L−1) < 10⁻³` are impossible: there the sensor is stuck. Readings so coarse that equal neighbours
//! are normal (`h` above one half) tell nothing, nor does a recording that repeats more often than it shows its noise.
//!
//! Where nearly all runs are of one length, each reading occurs so often: the sensor gives fewer readings than samples were taken.
//!
//! An axis may be stuck by itself. It is not where it stays at the end of its range: that is saturation.

use super::spikes::without;
use super::{Axis, ImuRecording, Recording, SensorKind, greater, lesser};

/// A run counts as stuck where chance would make fewer than this many in the recording.
const EXPECTED: f64 = 1e-3;
/// Probability of an equal neighbour that is never excluded: a recording shows no smaller one.
const LEAST_CHANCE: f64 = 0.005;
/// Equal neighbours are normal above this probability.
const MOST_CHANCE: f64 = 0.5;
/// At rest, neighbours are equal more often than on the average, by this factor.
const AT_REST: f64 = 2.0;
/// A sensor is read more often than it measures if each reading occurs this often.
const POLLED: f64 = 1.15;
/// Fewest readings that tell how often each occurs.
const FEWEST: f64 = 50.0;
/// Share of the runs whose length is that of the others, within a quarter or one sample.
const ALIKE: f64 = 0.95;
/// Share of reversals from which on readings show noise.
const NOISY: f64 = 0.1;
/// A run is stuck if it is longer by this factor than the usual one, and by as many samples.
const LONGER: usize = 4;

/// Where the readings of a sensor repeat.
#[derive(Debug, Clone, PartialEq)]
pub struct Repeats {
    /// How often each reading occurs, where that is more than once.
    pub each: Option<f64>,
    /// Rate of the distinct readings, Hz.
    pub rate_hz: f64,
    /// Where the sensor is stuck, on all axes or on some.
    pub stuck: Vec<Stuck>,
    /// Number of samples of the recording.
    pub of_samples: usize,
}

/// Runs of readings that repeat, though the noise forbids it.
#[derive(Debug, Clone, PartialEq)]
pub struct Stuck {
    /// The axis; `None`: all.
    pub axis: Option<Axis>,
    /// Number of the runs.
    pub runs: usize,
    /// Number of their samples.
    pub samples: usize,
    /// First sample of the longest, s.
    pub start_s: f64,
    /// Its last sample, s.
    pub end_s: f64,
}

/// Successive samples of equal readings.
struct Run {
    first: usize,
    /// One past its last sample.
    end: usize,
    /// Number of its samples that count.
    length: usize,
}

impl Recording {
    /// The samples whose readings only repeat, in order, and what they are. `None` where no reading repeats but by chance.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::sensor::{ReadingUnit, Recording};
    /// use nalgebra::Vector3;
    /// let noise = |k: usize| Vector3::new((k as f64).sin(), (1.7 * k as f64).sin(), (2.3 * k as f64).cos());
    /// let times_s: Vec<f64> = (0..400).map(|k| k as f64 * 0.01).collect();
    /// let stuck: Vec<Vector3<f64>> = (0..400).map(|k| noise(k.min(349))).collect();
    /// let recording = Recording::new(times_s, stuck, 3, ReadingUnit::MetrePerSecondSquared)?;
    /// let (samples, repeats) = recording.repeats().expect("the end");
    /// assert_eq!((samples.len(), repeats.stuck[0].samples, repeats.each), (51, 51, None));
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    #[must_use]
    pub fn repeats(&self) -> Option<(Vec<usize>, Repeats)> {
        let axes = self.active_axes();
        let all = |one: usize, other: usize| self.readings[one] == self.readings[other];
        let every: Vec<usize> = (0..self.len()).collect();
        let runs = runs_of(&every, all);
        let each = self.each(&runs);
        let usual = each.map_or(0, |each| LONGER * each.ceil() as usize + LONGER);
        let shortest = match each {
            Some(_) => Some(usual),
            None => shortest_stuck(&runs, self.reversals(&runs, axes), self.len()),
        };
        let mut left_out = vec![false; self.len()];
        let mut stuck = Vec::new();
        let is_stuck = |run: &Run| shortest.is_some_and(|shortest| run.length >= shortest);
        stuck.extend(self.take_out(runs.iter().filter(|run| is_stuck(run)), None, &mut left_out));
        // each reading once: what an axis does by itself shows in these
        let distinct: Vec<usize> = runs.iter().filter(|run| !is_stuck(run)).map(|run| run.first).collect();
        if each.is_some() {
            let others = runs.iter().filter(|run| !is_stuck(run));
            others.for_each(|run| left_out[run.first + 1..run.end].fill(true));
        }
        for axis in axes.iter().filter(|_| axes.len() > 1) {
            stuck.extend(self.stuck_axis(*axis, &distinct, &mut left_out));
        }
        let samples: Vec<usize> = (0..self.len()).filter(|k| left_out[*k]).collect();
        (!samples.is_empty()).then(|| {
            let rate_hz = self.rate_hz() / each.unwrap_or(1.0);
            (samples, Repeats { each, rate_hz, stuck, of_samples: self.len() })
        })
    }

    /// Where an axis is stuck by itself. `distinct`: the samples that count.
    fn stuck_axis(&self, axis: Axis, distinct: &[usize], left_out: &mut [bool]) -> Option<Stuck> {
        let value = |k: usize| self.readings[k][axis.index()];
        let of_axis = runs_of(distinct, |one, other| value(one) == value(other));
        let [low, high] = distinct.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], k| {
            [lesser(low, value(*k)), greater(high, value(*k))]
        });
        let shortest = shortest_stuck(&of_axis, self.reversals(&of_axis, &[axis]), distinct.len())?;
        let is_stuck = |run: &&Run| {
            let (value, is_long) = (value(run.first), run.length >= shortest);
            is_long && value > low && value < high
        };
        self.take_out(of_axis.iter().filter(is_stuck), Some(axis), left_out)
    }

    /// Marks the samples of runs, and says what they are.
    fn take_out<'r>(
        &self,
        runs: impl Iterator<Item = &'r Run>,
        axis: Option<Axis>,
        left_out: &mut [bool],
    ) -> Option<Stuck> {
        let mut found: Option<Stuck> = None;
        for run in runs {
            let samples = run.first..run.end;
            let (start_s, end_s) = (self.times_s[samples.start], self.times_s[samples.end - 1]);
            left_out[samples.clone()].fill(true);
            let found = found.get_or_insert(Stuck { axis, runs: 0, samples: 0, start_s, end_s });
            found.runs += 1;
            found.samples += samples.len();
            if end_s - start_s > found.end_s - found.start_s {
                (found.start_s, found.end_s) = (start_s, end_s);
            }
        }
        found
    }

    /// How often each reading occurs, where a sensor is read more often than it measures.
    fn each(&self, runs: &[Run]) -> Option<f64> {
        let mut lengths: Vec<usize> = runs.iter().map(|run| run.length).collect();
        if lengths.is_empty() {
            return None;
        }
        let middle = lengths.len() / 2;
        let usual = *lengths.select_nth_unstable(middle).1;
        let ordinary = || runs.iter().map(|run| run.length).filter(|length| *length <= LONGER * (usual + 1));
        let count = ordinary().count() as f64;
        let each = ordinary().sum::<usize>() as f64 / count;
        let alike = |length: &usize| (*length as f64 - each).abs() <= (0.25 * each).max(1.0);
        let longer = |than: usize| ordinary().filter(|length| *length > than).count() as f64;
        // equal by chance, runs of three were as frequent among those of two as those of two among all
        let by_chance = each < 2.0 && 4.0 * longer(2) * count > longer(1).powi(2);
        let is_polled = count >= FEWEST
            && each > POLLED
            && ordinary().filter(alike).count() as f64 > ALIKE * count
            && !by_chance
            && self.reversals(runs, self.active_axes()) as f64 > NOISY * count;
        is_polled.then_some(each)
    }

    /// Number of the runs at which the reading of one of these axes turns back.
    fn reversals(&self, runs: &[Run], axes: &[Axis]) -> usize {
        let turns_back = |three: &&[Run; 3]| {
            let value = |run: usize, axis: &Axis| self.readings[three[run].first][axis.index()];
            axes.iter()
                .any(|axis| (value(1, axis) - value(0, axis)) * (value(2, axis) - value(1, axis)) < 0.0)
        };
        runs.array_windows().filter(turns_back).count()
    }
}

/// The runs of equal readings among these samples, in order. They go on over samples that do not count.
fn runs_of(samples: &[usize], equal: impl Fn(usize, usize) -> bool) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for &k in samples {
        match runs.last_mut() {
            Some(run) if equal(run.first, k) => (run.end, run.length) = (k + 1, run.length + 1),
            _ => runs.push(Run { first: k, end: k + 1, length: 1 }),
        }
    }
    runs
}

/// The shortest run that is impossible; `None` where equal neighbours are normal.
fn shortest_stuck(runs: &[Run], reversals: usize, samples: usize) -> Option<usize> {
    let repeating = runs.iter().filter(|run| run.length > 1).count();
    let chance = (AT_REST * repeating as f64 / reversals as f64).max(LEAST_CHANCE);
    if reversals == 0 || chance > MOST_CHANCE {
        return None;
    }
    let shortest = 2 + ((EXPECTED / samples as f64).ln() / chance.ln()) as usize;
    let stuck: usize = runs.iter().map(|run| run.length).filter(|length| *length >= shortest).sum();
    (stuck <= reversals).then_some(shortest)
}

impl ImuRecording {
    /// The recording without readings that only repeat ([`Recording::repeats`]), and what was left out of each sensor. `None` where nothing was.
    #[must_use]
    pub fn without_repeats(&self) -> Option<(Self, Vec<(SensorKind, Repeats)>)> {
        let mut clean: Option<Self> = None;
        let mut found = Vec::new();
        for sensor_kind in SensorKind::ALL {
            let Some((samples, repeats)) = self.sensor(sensor_kind).and_then(Recording::repeats) else {
                continue;
            };
            let clean = clean.get_or_insert_with(|| self.clone());
            clean.cut(sensor_kind, &samples);
            found.push((sensor_kind, repeats));
        }
        clean.map(|clean| (clean, found))
    }

    /// Takes samples of a sensor out, with their temperatures: there is one for each sample of the accelerometer.
    fn cut(&mut self, sensor_kind: SensorKind, samples: &[usize]) {
        let of_temperature =
            sensor_kind == SensorKind::Accelerometer || self[SensorKind::Accelerometer].is_none();
        if let Some(temperatures) = self.temperature_c.as_mut().filter(|_| of_temperature) {
            without(temperatures, samples);
        }
        if let Some(recording) = &mut self[sensor_kind] {
            without(&mut recording.times_s, samples);
            without(&mut recording.readings, samples);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::ReadingUnit;
    use crate::simulate::{Purpose, stream};
    use nalgebra::Vector3;
    use rand_distr::{Distribution, StandardNormal};

    /// Holds of 4 s at 100 Hz in 20 orientations with turns of 1.5 s between them, and noise of this standard deviation.
    fn held(sd: f64) -> Vec<Vector3<f64>> {
        let mut rng = stream(7, Purpose::Sensor, 0);
        let reading = |k: usize| {
            let part = ((k % 550) as f64 / 150.0 - 400.0 / 150.0).max(0.0);
            let angle = 0.9 * ((k / 550) as f64 + part * part * (3.0 - 2.0 * part));
            let noise = Vector3::from_fn(|_, _| -> f64 { StandardNormal.sample(&mut rng) });
            9.8 * Vector3::new(angle.cos(), angle.sin() * (0.7 * angle).cos(), angle.sin()) + noise * sd
        };
        (0..11_000).map(reading).collect()
    }

    fn recorded(readings: Vec<Vector3<f64>>) -> Recording {
        let times_s = (0..readings.len()).map(|k| k as f64 * 0.01).collect();
        Recording { times_s, readings, axes: 3, unit: ReadingUnit::MetrePerSecondSquared }
    }

    #[test]
    fn what_is_normal_is_no_repeat() {
        let step = |of: &Vector3<f64>, step: f64| of.map(|value| (value / step).round() * step);
        // without noise a hold is constant, and so it is where the steps are coarse
        assert_eq!(recorded(held(0.0)).repeats(), None);
        // eight bits of ±2 g are steps of 0.15 m/s²
        for coarse in [0.002, 0.01, 0.03, 0.1, 0.3] {
            let readings = held(0.02).iter().map(|of| step(of, coarse)).collect();
            assert_eq!(recorded(readings).repeats(), None, "{coarse}");
        }
        // an axis that saturates
        let clipped = held(0.02).iter().map(|of| of.map(|value| value.clamp(-8.0, 8.0))).collect();
        assert_eq!(recorded(clipped).repeats(), None);
    }

    #[test]
    fn a_sensor_or_an_axis_that_is_stuck_is_found() {
        let mut readings = held(0.02);
        for first in (500..10_000).step_by(1000) {
            let stuck = readings[first];
            readings[first..first + 10].fill(stuck);
            let stuck = readings[first + 300].y;
            readings[first + 300..first + 330].iter_mut().for_each(|of| of.y = stuck);
        }
        readings[9_900..].fill(Vector3::repeat(-6e-4));
        let (samples, found) = recorded(readings).repeats().expect("some");
        let stuck: Vec<_> = found.stuck.iter().map(|of| (of.axis, of.runs, of.samples)).collect();
        assert_eq!(stuck, [(None, 11, 100 + 1100), (Some(Axis::Y), 10, 300)]);
        assert_eq!((samples.len(), found.each), (1500, None));
        let ends = [found.stuck[0].start_s - 99.0, found.stuck[0].end_s - 109.99];
        assert!(ends.iter().all(|of| of.abs() < 1e-9), "{found:?}");
    }

    #[test]
    fn of_a_sensor_that_is_polled_each_reading_is_kept_once() {
        for times in [2, 5, 20] {
            let mut readings: Vec<_> = held(0.02).into_iter().flat_map(|of| vec![of; times]).collect();
            // and stuck for a while
            let stuck = readings[500 * times];
            readings[500 * times..520 * times].fill(stuck);
            let (samples, found) = recorded(readings).repeats().expect("some");
            assert!((found.each.expect("polled") - times as f64).abs() < 0.01, "{found:?}");
            assert_eq!(found.stuck.len(), 1, "{found:?}");
            assert_eq!(samples.len(), (11_000 - 20) * (times - 1) + 20 * times, "{times}");
        }
    }
}
