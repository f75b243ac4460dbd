//! The noise of an IMU in the longest hold: what a sample's noise is taken for where the experiment does not say, and a section of the report.

use calibrant::estimate::{ImuCalibration, ImuSetup, WhiteNoise, holds_between};
use calibrant::motion::Hold;
use calibrant::noise::{Moments, Segment, SensorNoise};
use calibrant::sensor::{ImuRecording, Recording, SensorKind};
use nalgebra::Vector3;

/// A hold, or what is left of it between gaps, that is shorter than this says too little of the noise, s.
const LONG_HOLD_S: f64 = 20.0;

/// The longest hold, where it is long enough.
pub(super) struct LongestHold {
    /// Its number, from 0.
    number: usize,
    hold: Hold,
    /// For the samples of a sensor in it: most often the other has as many.
    moments: Moments,
}

impl LongestHold {
    /// Holds that are not there are the calibration's to complain about.
    pub(super) fn of(setup: &ImuSetup, recording: &ImuRecording) -> Option<Self> {
        let given = setup
            .holds
            .intervals_s
            .as_ref()
            .and_then(|intervals| holds_between(recording.accelerometer.as_ref()?, intervals).ok());
        let mut holds = given.or_else(|| setup.found.clone())?;
        let number = Hold::longest(&holds)?;
        let hold = holds.swap_remove(number);
        let segment = |sensor_kind| long_segment(recording.sensor(sensor_kind)?, &hold);
        let segment = segment(SensorKind::Gyroscope).or_else(|| segment(SensorKind::Accelerometer))?;
        Some(Self { number, moments: Moments::of(segment.samples()), hold })
    }

    /// The noise of a sensor in it; `None` where its samples do not determine it.
    pub(super) fn noise(&self, sensor_kind: SensorKind, recording: &ImuRecording) -> Option<SensorNoise> {
        let recording = recording.sensor(sensor_kind)?;
        let segment = long_segment(recording, &self.hold)?;
        if segment.samples() == self.moments.samples() {
            SensorNoise::with_moments(sensor_kind, recording, segment, &self.moments).ok()
        } else {
            SensorNoise::of(sensor_kind, recording, segment).ok()
        }
    }

    /// A gyroscope's white noise, where it is determined on all axes and the noise is understood.
    pub(super) fn white_noise(&self, gyroscope: &SensorNoise) -> Option<WhiteNoise> {
        let sd = gyroscope
            .white_noise_per_sample()
            .filter(|_| gyroscope.explains() && gyroscope.caveat.is_none())?;
        Some(WhiteNoise { sd, hold: self.number, duration_s: gyroscope.segment.duration_s() })
    }
}

/// The samples of a hold without a gap, where they last long enough.
fn long_segment(recording: &Recording, hold: &Hold) -> Option<Segment> {
    let segment = Segment::between(recording, hold.start_s, hold.end_s).ok()?;
    (segment.duration_s() + segment.interval_s >= LONG_HOLD_S).then_some(segment)
}

/// The noise of a sensor in m/s² or rad/s.
pub(super) fn physical(
    noise: SensorNoise,
    calibration: &ImuCalibration,
    recording: &ImuRecording,
) -> calibrant::Result<SensorNoise> {
    let matrix = calibration.imu.sensor(noise.sensor_kind).matrix;
    let gain = Vector3::from_fn(|axis, _| matrix.row(axis).norm());
    match recording.sensor(noise.sensor_kind) {
        Some(recording) => noise.with_gain(recording, &gain),
        None => Ok(noise),
    }
}
