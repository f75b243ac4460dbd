//! The noise of an IMU in the longest hold: what a sample's noise is taken for where the experiment does not say, and a section of the report.

use calibrant::estimate::{ImuCalibration, ImuSetup, WhiteNoise, holds_between};
use calibrant::motion::Hold;
use calibrant::noise::{Moments, Stretch, TriadNoise};
use calibrant::sensor::{ImuRecording, Recording, Triad};
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
        let stretch = |triad| long_stretch(recording.triad(triad)?, &hold);
        let stretch = stretch(Triad::Gyroscope).or_else(|| stretch(Triad::Accelerometer))?;
        Some(Self { number, moments: Moments::of(stretch.samples()), hold })
    }

    /// The noise of a sensor in it; `None` where its samples do not determine it.
    pub(super) fn noise(&self, triad: Triad, recording: &ImuRecording) -> Option<TriadNoise> {
        let recording = recording.triad(triad)?;
        let stretch = long_stretch(recording, &self.hold)?;
        if stretch.samples() == self.moments.samples() {
            TriadNoise::with_moments(triad, recording, stretch, &self.moments).ok()
        } else {
            TriadNoise::of(triad, recording, stretch).ok()
        }
    }

    /// A gyroscope's white noise, where it is determined on all axes and the noise is understood.
    pub(super) fn white_noise(&self, gyroscope: &TriadNoise) -> Option<WhiteNoise> {
        let sd = gyroscope
            .white_noise_per_sample()
            .filter(|_| gyroscope.explains() && gyroscope.doubt.is_none())?;
        Some(WhiteNoise { sd, hold: self.number, duration_s: gyroscope.stretch.duration_s() })
    }
}

/// The samples of a hold without a gap, where they last long enough.
fn long_stretch(recording: &Recording, hold: &Hold) -> Option<Stretch> {
    let stretch = Stretch::between(recording, hold.start_s, hold.end_s).ok()?;
    (stretch.duration_s() + stretch.interval_s >= LONG_HOLD_S).then_some(stretch)
}

/// The noise of a sensor in m/s² or rad/s.
pub(super) fn physical(
    noise: TriadNoise,
    calibration: &ImuCalibration,
    recording: &ImuRecording,
) -> calibrant::Result<TriadNoise> {
    let matrix = calibration.imu.triad(noise.triad).matrix;
    let gain = Vector3::from_fn(|axis, _| matrix.row(axis).norm());
    match recording.triad(noise.triad) {
        Some(recording) => noise.with_gain(recording, &gain),
        None => Ok(noise),
    }
}
