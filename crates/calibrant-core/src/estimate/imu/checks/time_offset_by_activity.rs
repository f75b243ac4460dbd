//! When the sensors move: a first look at their clocks, that needs no calibration.
//!
//! An accelerometer that is turned reads another part of gravity from moment to moment, `|ḟ| = |ω × f|`, so that how fast it changes and the rate of the gyroscope rise and fall together. The lag and the
//! growth at which they do most are searched for, to a fraction of a second: where the clocks are so far apart no fit may be left to tell (`time_offset`).

use crate::diagnostic::{late, repair};
use crate::error::{Error, InputError, NotIdentifiable};
use crate::estimate::holds::median;
use crate::sensor::{ImuRecording, Recording};
use nalgebra::Vector3;
use rayon::prelude::*;

/// Width of a bin in the first search, s. It is more in a recording of more bins than [`MOST_BINS`].
const BIN_S: f64 = 0.2;

/// Largest number of bins.
const MOST_BINS: f64 = 2000.0;

/// Largest offset that is looked for, s.
const LARGEST_OFFSET_S: f64 = 30.0;

/// Largest skew that is looked for.
const LARGEST_SKEW: f64 = 0.03;

/// Both sensors must move alike to this correlation.
const ALIKE: f64 = 0.6;

/// The correlation must be larger by this than that as recorded.
const BETTER: f64 = 0.2;

/// The correlation must be larger by this than at any far offset. Holds that follow each other evenly look alike a period later.
const UNIQUE: f64 = 0.05;

/// An offset is far from the best beyond this, s.
const FAR_S: f64 = 1.0;

/// The second search is this many times as fine.
const FINER: f64 = 4.0;

/// How a sensor moves in each bin of the time.
struct MotionActivity {
    from_s: f64,
    bin_s: f64,
    /// Less their mean.
    values: Vec<f64>,
}

impl MotionActivity {
    /// `of`: how it moves, from the mean readings of a bin before, the bin itself and one after.
    fn of(recording: &Recording, bin_s: f64, of: impl Fn([&Vector3<f64>; 3]) -> f64) -> Option<Self> {
        let from_s = *recording.times_s.first()?;
        let count = ((recording.times_s.last()? - from_s) / bin_s) as usize + 1;
        let mut sums = vec![(Vector3::zeros(), 0.0); count];
        for (t, reading) in recording.times_s.iter().zip(&recording.readings) {
            let (sum, samples) = &mut sums[((t - from_s) / bin_s) as usize];
            *sum += reading;
            *samples += 1.0;
        }
        let mut before = recording.readings[0];
        let mean = |(sum, samples): (Vector3<f64>, f64)| {
            before = if samples > 0.0 { sum / samples } else { before };
            before
        };
        let means: Vec<Vector3<f64>> = sums.into_iter().map(mean).collect();
        let mut values: Vec<f64> =
            means.array_windows().map(|[before, here, after]| of([before, here, after])).collect();
        // what is fast is fast: how fast depends on how gravity lies
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        let fast = *sorted.get(sorted.len() * 49 / 50)?;
        values.iter_mut().for_each(|value| *value = (*value / fast).min(1.0));
        let middle = values.iter().sum::<f64>() / values.len() as f64;
        values.iter_mut().for_each(|value| *value -= middle);
        Some(Self { from_s: from_s + 1.5 * bin_s, bin_s, values })
    }

    fn of_both(recording: &ImuRecording, bin_s: f64) -> Option<[Self; 2]> {
        let (accelerometer, gyroscope) = (recording.accelerometer.as_ref()?, recording.gyroscope.as_ref()?);
        let rest = Vector3::from_fn(|axis, _| {
            median(gyroscope.readings.iter().step_by(16).map(|reading| reading[axis]).collect())
        });
        Some([
            Self::of(accelerometer, bin_s, |[before, _, after]| (after - before).norm())?,
            Self::of(gyroscope, bin_s, |[_, here, _]| (here - rest).norm())?,
        ])
    }

    /// Correlation with another sensor whose times are later by `offset_s + skew (t − at_s)`; −1 where they share less than half of the time.
    fn correlation(&self, other: &Self, at_s: f64, offset_s: f64, skew: f64) -> f64 {
        let (mut both, mut own, mut others, mut count) = (0.0, 0.0, 0.0, 0);
        for (k, value) in self.values.iter().enumerate() {
            let t = self.from_s + k as f64 * self.bin_s;
            let place = (t + offset_s + skew * (t - at_s) - other.from_s) / other.bin_s + 0.5;
            if place < 0.0 {
                continue;
            }
            let Some(there) = other.values.get(place as usize) else { break };
            both += value * there;
            own += value * value;
            others += there * there;
            count += 1;
        }
        let alike = both / (own * others).sqrt();
        if 2 * count >= self.values.len().min(other.values.len()) && alike.is_finite() { alike } else { -1.0 }
    }
}

/// Says by how much the gyroscope's times are off, where the sensors move alike at another lag and not as recorded.
pub(crate) fn shifted(recording: &ImuRecording) -> Option<String> {
    let ends = |recording: &Recording| Some((*recording.times_s.first()?, *recording.times_s.last()?));
    let (first, last) = ends(recording.accelerometer.as_ref()?)?;
    let (other_first, other_last) = ends(recording.gyroscope.as_ref()?)?;
    let bin_s = BIN_S.max((last - first).max(other_last - other_first) / MOST_BINS);
    if last - first < FAR_S || other_last - other_first < FAR_S {
        return None;
    }
    let at_s = 0.5 * (first + last);
    let [accelerometer, gyroscope] = MotionActivity::of_both(recording, bin_s)?;
    let step = 2.0 * bin_s / (last - first);
    let all = |most: f64, step: f64| {
        let count = (most / step) as i32;
        move || (-count..=count).map(move |k| f64::from(k) * step)
    };
    let (offsets, skews) = (all(LARGEST_OFFSET_S, bin_s), all(LARGEST_SKEW, step));
    let tries: Vec<(f64, f64)> =
        skews().flat_map(|skew| offsets().map(move |offset_s| (offset_s, skew))).collect();
    let judged = |[one, other]: [&MotionActivity; 2], tries: Vec<(f64, f64)>| -> Vec<(f64, f64, f64)> {
        let alike =
            |(offset_s, skew): (f64, f64)| (one.correlation(other, at_s, offset_s, skew), offset_s, skew);
        tries.into_par_iter().map(alike).collect()
    };
    let best =
        |judged: &[(f64, f64, f64)]| judged.iter().copied().max_by(|one, other| one.0.total_cmp(&other.0));
    let roughly = judged([&accelerometer, &gyroscope], tries);
    let (most, offset_s, skew) = best(&roughly)?;
    let is_far = |other: &&(f64, f64, f64)| (other.1 - offset_s).abs() > FAR_S;
    let is_unique = roughly.iter().filter(is_far).all(|other| other.0 < most - UNIQUE);
    let fine = bin_s / FINER;
    let [accelerometer, gyroscope] = MotionActivity::of_both(recording, fine)?;
    let as_recorded = accelerometer.correlation(&gyroscope, at_s, 0.0, 0.0);
    let (offsets, skews) = (all(bin_s, fine), all(step, step / FINER));
    let near = skews().flat_map(|by| offsets().map(move |more_s| (offset_s + more_s, skew + by))).collect();
    let (alike, offset_s, skew) = best(&judged([&accelerometer, &gyroscope], near))?;
    if !is_unique || alike < ALIKE.max(as_recorded + BETTER) {
        return None;
    }
    let ends = [first, last].map(|t| offset_s + skew * (t - at_s));
    let grows = (ends[1] - ends[0]).abs() > 2.0 * bin_s;
    let words = |offset_s: f64| late(1e-3 * offset_s, 1).replace(" ms", " s");
    Some(match grows {
        true => format!(
            "by when they move, the gyroscope is about {} than the accelerometer at the beginning and {} at the end: {}",
            words(ends[0]),
            words(ends[1]),
            repair(ends[0], skew, 1)
        ),
        false => format!(
            "by when they move, the gyroscope is about {} than the accelerometer: {}",
            words(offset_s),
            repair(offset_s, 0.0, 1)
        ),
    })
}

/// The same error, which came of the gyroscope and the accelerometer together, with what their clocks have to do with it.
pub(crate) fn with_time_offset(error: Error, recording: &ImuRecording) -> Error {
    let both = recording.accelerometer.is_some() && recording.gyroscope.is_some();
    match error {
        Error::Recording(input_error) if both => match shifted(recording) {
            Some(stated) => Error::recording(InputError { help: stated, ..*input_error }),
            None => Error::Recording(input_error),
        },
        Error::NotIdentifiable(undetermined) if both => {
            let mut groups = undetermined.groups;
            if let Some(stated) = shifted(recording) {
                groups.iter_mut().for_each(|group| group.reason = format!("{}; {stated}", group.reason));
            }
            Error::NotIdentifiable(Box::new(NotIdentifiable { groups }))
        }
        error => error,
    }
}
