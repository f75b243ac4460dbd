//! The noise of a sensor at rest: which part of a recording is examined, and what it shows of each sensor.

mod holds;
mod options;
mod read;

pub use options::NoiseOptions;
pub use read::read_for_noise;

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::repeated_readings;
use calibrant_core::noise::{Moments, Segment, SensorNoise, filled};
use calibrant_core::sensor::{ImuRecording, Recording, SensorKind};
use std::borrow::Cow;

/// The noise of each sensor in one interval at rest.
#[derive(Debug)]
pub struct NoiseAtRest {
    /// The noise, by sensor: one at least.
    pub sensors: Vec<SensorNoise>,
    /// The examined part of the recording, in words; `None` where it is nearly all of it, or was given.
    pub examined: Option<String>,
    /// A sensor whose noise is not determined, and why.
    pub failed: Option<(SensorKind, Error)>,
}

/// Examines the longest hold of a recording, or a given interval.
///
/// # Errors
/// [`Error::Recording`] where the sensor was not recorded, where there is no hold of a second, or where no sensor has its noise determined.
/// [`Error::Experiment`] where a gain makes no sense, or the work was interrupted.
///
/// # Examples
/// ```
/// use calibrant::io::{Experiment, Plan, preset};
/// use calibrant::{NoiseOptions, SimulationOptions, noise, simulate};
///
/// let mut experiment = Experiment::parse(preset("imu").expect("built in"), None)?;
/// if let Plan::Holds(holds) = &mut experiment.plan {
///     (holds.poses, holds.hold_s) = (2, 60.0);
/// }
/// let found = noise(&simulate(&experiment, &SimulationOptions::default())?.recording, &NoiseOptions::default())?;
/// assert_eq!(found.sensors.len(), 2, "accelerometer and gyroscope");
/// # Ok::<(), calibrant::Error>(())
/// ```
pub fn noise(recording: &ImuRecording, options: &NoiseOptions) -> Result<NoiseAtRest> {
    let (distinct, repeats) = match recording.without_repeats() {
        Some((distinct, repeats)) => (Cow::Owned(distinct), repeats),
        None => (Cow::Borrowed(recording), Vec::new()),
    };
    let mut whole = distinct;
    let mut gaps: Vec<(SensorKind, Diagnostic)> = Vec::new();
    for sensor_kind in SensorKind::ALL {
        if let Some((without, found)) = whole.sensor(sensor_kind).and_then(filled) {
            whole.to_mut()[sensor_kind] = Some(without);
            gaps.push((sensor_kind, found.into()));
        }
    }
    let recording = whole.as_ref();
    let is_asked = |sensor_kind: &SensorKind| options.sensor.is_none_or(|asked| asked == *sensor_kind);
    let there: Vec<(SensorKind, &Recording)> = SensorKind::ALL
        .into_iter()
        .filter(is_asked)
        .filter_map(|sensor_kind| Some((sensor_kind, recording.sensor(sensor_kind)?)))
        .collect();
    if there.is_empty() {
        return Err(no_sensor(options.sensor.unwrap_or(SensorKind::Accelerometer)));
    }
    let found = holds::holds(recording);
    let (holds, interval) = match options.hold_s {
        Some(given) => (found.unwrap_or_default(), given),
        None => {
            let holds = found?;
            let interval = holds::longest(&holds).map(|hold| (hold.start_s, hold.end_s))?;
            (holds, interval)
        }
    };
    let mut of_one_length: Option<Moments> = None;
    let mut of_sensor = |&(sensor_kind, recording): &(SensorKind, &Recording)| -> Result<SensorNoise> {
        let segment = Segment::between(recording, interval.0, interval.1)?;
        let samples = segment.samples();
        let moments = of_one_length.take().filter(|moments| moments.samples() == samples);
        let moments = &*of_one_length.insert(moments.unwrap_or_else(|| Moments::of(samples)));
        let mut found = SensorNoise::until(&options.interruption, sensor_kind, recording, segment, moments)?;
        if let Some((_, gain)) = options.gains.iter().find(|(of, _)| *of == sensor_kind) {
            found = found.with_gain(recording, gain)?;
        }
        let repeats = repeats.iter().filter(|(of, _)| *of == sensor_kind);
        found.warnings.extend(repeats.flat_map(|(of, repeats)| repeated_readings(repeats, *of)));
        let gaps = gaps.iter().filter(|(of, _)| *of == sensor_kind);
        found.warnings.extend(gaps.map(|(_, gap)| gap.clone()));
        let moving = options.hold_s.and_then(|_| holds::moves(&holds, &found.segment));
        if let Some(moving) = moving {
            found.caveat = Some(moving.clone());
            found.warnings.push(moving);
        }
        Ok(found)
    };
    let (mut sensors, mut failed) = (Vec::new(), None);
    for sensor in &there {
        match of_sensor(sensor) {
            Ok(found) => sensors.push(found),
            Err(error) if error.code() == Refusal::Interrupted => return Err(error),
            // the other sensor may still have its noise
            Err(error) if there.len() > 1 && failed.is_none() => failed = Some((sensor.0, error)),
            Err(error) => return Err(error),
        }
    }
    let first = &sensors[0];
    let examined = match options.hold_s {
        Some(_) => None,
        None => {
            let examined = |of| holds::examined(&holds, &first.segment, of);
            recording.sensor(first.sensor_kind).and_then(examined)
        }
    };
    Ok(NoiseAtRest { sensors, examined, failed })
}

fn no_sensor(sensor_kind: SensorKind) -> Error {
    let message = format!("the file has no {sensor_kind}");
    Error::recording(InputError::new(
        Refusal::SensorMissing,
        message,
        "choose the other with option `sensor`",
    ))
}
