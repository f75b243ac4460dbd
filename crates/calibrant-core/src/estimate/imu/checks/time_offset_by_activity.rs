//! When the sensors move: a first look at their clocks, that needs no calibration.
//!
//! An accelerometer that is turned reads another part of gravity from moment to moment, `|ḟ| = |ω × f|`, so that how fast it changes and the rate of the gyroscope rise and fall together. The offset
//! at which they do most is searched for, to a fraction of a second: where the clocks are so far apart no fit may be left to show it (`time_offset`).

use crate::diagnostic::{late, repair};
use crate::error::{Error, NotIdentifiable};
use crate::estimate::holds::median;
use crate::sensor::{ImuRecording, Recording, SensorKind};
use nalgebra::Vector3;
use rayon::prelude::*;

/// Width of a bin, s. It is more in a recording of more bins than [`MOST_BINS`].
const BIN_S: f64 = 0.1;

/// Largest number of bins.
const MOST_BINS: f64 = 20_000.0;

/// Largest offset that is looked for, s.
const LARGEST_OFFSET_S: f64 = 30.0;

/// Both sensors must move alike to this correlation.
const ALIKE: f64 = 0.6;

/// The correlation must be larger by this than that as recorded.
const BETTER: f64 = 0.2;

/// The correlation must be larger by this than at any far offset. Holds that follow each other evenly look alike a period later.
const UNIQUE: f64 = 0.05;

/// An offset is far from the best beyond this, s.
const FAR_S: f64 = 1.0;

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
        let (accelerometer, gyroscope) =
            (recording[SensorKind::Accelerometer].as_ref()?, recording[SensorKind::Gyroscope].as_ref()?);
        let rest = Vector3::from_fn(|axis, _| {
            median(gyroscope.readings.iter().step_by(16).map(|reading| reading[axis]).collect())
        });
        Some([
            Self::of(accelerometer, bin_s, |[before, _, after]| (after - before).norm())?,
            Self::of(gyroscope, bin_s, |[_, here, _]| (here - rest).norm())?,
        ])
    }

    /// Correlation with another sensor whose times are later by `offset_s`; −1 where they share less than half of the time.
    fn correlation(&self, other: &Self, offset_s: f64) -> f64 {
        let (mut both, mut own, mut others, mut count) = (0.0, 0.0, 0.0, 0);
        for (k, value) in self.values.iter().enumerate() {
            let place = (self.from_s + offset_s - other.from_s) / self.bin_s + k as f64 + 0.5;
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
fn shifted(recording: &ImuRecording) -> Option<String> {
    let ends = |recording: &Recording| Some((*recording.times_s.first()?, *recording.times_s.last()?));
    let (first, last) = ends(recording[SensorKind::Accelerometer].as_ref()?)?;
    let (other_first, other_last) = ends(recording[SensorKind::Gyroscope].as_ref()?)?;
    let bin_s = BIN_S.max((last - first).max(other_last - other_first) / MOST_BINS);
    if last - first < FAR_S || other_last - other_first < FAR_S {
        return None;
    }
    let [accelerometer, gyroscope] = MotionActivity::of_both(recording, bin_s)?;
    let count = (LARGEST_OFFSET_S / bin_s) as i32;
    let judged = |k: i32| {
        let offset_s = f64::from(k) * bin_s;
        (accelerometer.correlation(&gyroscope, offset_s), offset_s)
    };
    let judged: Vec<(f64, f64)> = (-count..=count).into_par_iter().map(judged).collect();
    let (alike, offset_s) = judged.iter().copied().max_by(|one, other| one.0.total_cmp(&other.0))?;
    let is_far = |other: &&(f64, f64)| (other.1 - offset_s).abs() > FAR_S;
    let is_unique = judged.iter().filter(is_far).all(|other| other.0 < alike - UNIQUE);
    let as_recorded = accelerometer.correlation(&gyroscope, 0.0);
    (is_unique && alike >= ALIKE.max(as_recorded + BETTER)).then(|| {
        let words = late(1e-3 * offset_s, 1).replace(" ms", " s");
        let repair = repair(offset_s, 0.0, 1);
        format!("by when they move, the gyroscope is about {words} than the accelerometer: {repair}")
    })
}

/// The same error, which came of the gyroscope and the accelerometer together, with what their clocks have to do with it.
pub(crate) fn with_time_offset(error: Error, recording: &ImuRecording) -> Error {
    let both = recording[SensorKind::Accelerometer].is_some() && recording[SensorKind::Gyroscope].is_some();
    match error {
        Error::Recording(input_error) if both => match shifted(recording) {
            Some(stated) => Error::recording(input_error.with_help(stated)),
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
