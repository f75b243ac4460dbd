//! Stationary intervals, in which neither sensor of an IMU shows a movement.
//!
//! An accelerometer does not see a rotation about the vertical, nor the first milliradians of any other. Its holds then include parts of rotations,
//! in which the gyroscope's mean is not its bias. The same detection finds calm segments of the gyroscope. A calm segment whose mean is far from
//! that of the others is a rotation at a steady rate.

use crate::error::{Error, InputError, Refusal, Result};
use crate::estimate::holds::{ROUNDED_TIME_STEPS, as_recorded, find_clean_holds, holds_between, median};
use crate::motion::Hold;
use crate::sensor::{ImuRecording, Recording, SensorKind};
use nalgebra::Vector3;

/// The gyroscope turns in a calm segment if its mean differs from the median of the others by more than this share of the recording's range.
const TURNING_SHARE: f64 = 0.02;

/// Finds the holds of at least `minimum_s` in the recording of an IMU: holds of the accelerometer, shortened to those parts in which the
/// gyroscope is calm too.
///
/// Spikes neither divide a hold nor count in its mean. A hold is not shortened if the gyroscope is never calm in it for long enough, or has no samples.
///
/// # Errors
/// [`Error::Recording`] where there is no accelerometer, or its rate is too low for holds this short.
pub fn find_imu_holds(recording: &ImuRecording, minimum_s: f64) -> Result<Vec<Hold>> {
    let (clean, spikes) = recording.without_spikes();
    let holds = find_clean_imu_holds(&clean, minimum_s)?;
    let of_accelerometer = spikes.iter().find(|(sensor_kind, _)| *sensor_kind == SensorKind::Accelerometer);
    Ok(as_recorded(holds, of_accelerometer.map(|(_, spikes)| spikes)))
}

/// [`find_imu_holds`] in a recording whose spikes were removed before ([`ImuRecording::without_spikes`]).
///
/// # Errors
/// As [`find_imu_holds`].
pub fn find_clean_imu_holds(recording: &ImuRecording, minimum_s: f64) -> Result<Vec<Hold>> {
    let Some(accelerometer) = &recording[SensorKind::Accelerometer] else {
        return Err(Error::recording(InputError::new(
            Refusal::SensorMissing,
            format!("the recording has no {}", SensorKind::Accelerometer),
            "holds are found with it",
        )));
    };
    let Some(gyroscope) = &recording[SensorKind::Gyroscope] else {
        return find_clean_holds(accelerometer, minimum_s);
    };
    let (holds, calm) =
        rayon::join(|| find_clean_holds(accelerometer, minimum_s), || find_clean_holds(gyroscope, minimum_s));
    let (holds, calm) = (holds?, calm.unwrap_or_default());
    let turning = turning(gyroscope, &calm);
    let mut intervals = Vec::with_capacity(holds.len());
    let shortest_s = minimum_s - ROUNDED_TIME_STEPS / accelerometer.rate_hz();
    for hold in &holds {
        let mut is_calm = false;
        for (segment, turning) in calm.iter().zip(&turning) {
            let (start_s, end_s) = (segment.start_s.max(hold.start_s), segment.end_s.min(hold.end_s));
            if end_s - start_s >= shortest_s {
                is_calm = true;
                intervals.extend((!turning).then_some((start_s, end_s)));
            }
        }
        if !is_calm {
            intervals.push((hold.start_s, hold.end_s));
        }
    }
    holds_between(accelerometer, &intervals)
}

/// In which of its calm segments does the gyroscope turn?
fn turning(gyroscope: &Recording, calm: &[Hold]) -> Vec<bool> {
    let [low, high] = gyroscope.extremes();
    if calm.is_empty() {
        return Vec::new();
    }
    let middle = Vector3::from_fn(|axis, _| median(calm.iter().map(|segment| segment.mean[axis]).collect()));
    let far = TURNING_SHARE * (high - low).amax();
    calm.iter().map(|segment| (segment.mean - middle).amax() > far).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::ReadingUnit;
    use crate::simulate::{Purpose, stream};
    use rand_distr::{Distribution, StandardNormal};

    /// Twenty seconds on a table, turned about the vertical from 8 to 11 s; then ten seconds in which it is shaken.
    #[test]
    fn a_turn_about_the_vertical_ends_a_hold() {
        let mut rng = stream(1, Purpose::Sensor, 0);
        let mut sensor = |rate: &dyn Fn(f64) -> Vector3<f64>, sd: f64, unit: ReadingUnit| {
            let times_s: Vec<f64> = (0..3000).map(|k| f64::from(k) * 0.01).collect();
            let mut noise = |_, _| {
                let normal: f64 = StandardNormal.sample(&mut rng);
                sd * normal
            };
            let readings = times_s.iter().map(|&t| rate(t) + Vector3::from_fn(&mut noise)).collect();
            Recording { times_s, readings, axes: 3, unit }
        };
        let shaken = |t: f64| if t > 20.0 { (30.0 * t).sin() } else { 0.0 };
        let force = |t: f64| Vector3::new(shaken(t), 2.0 * shaken(t), 9.8);
        let rate = |t: f64| Vector3::new(shaken(t), 0.0, if (8.0..11.0).contains(&t) { 0.5 } else { 0.0 });
        let recording = ImuRecording {
            sensors: [
                Some(sensor(&force, 0.01, ReadingUnit::MetrePerSecondSquared)),
                Some(sensor(&rate, 1e-3, ReadingUnit::RadianPerSecond)),
            ]
            .into(),
            temperature_c: None,
        };
        let alone = recording.clone().with(SensorKind::Gyroscope, None);
        assert_eq!(find_imu_holds(&alone, 1.0).expect("found").len(), 1);
        let holds = find_imu_holds(&recording, 1.0).expect("found");
        let ends: Vec<[f64; 2]> = holds.iter().map(|hold| [hold.start_s, hold.end_s]).collect();
        let expected = [[0.0, 8.0], [11.0, 20.0]];
        assert_eq!(ends.len(), 2, "{ends:?}");
        for (found, expected) in ends.iter().flatten().zip(expected.iter().flatten()) {
            assert!((found - expected).abs() < 0.5, "{ends:?}");
        }
    }
}
