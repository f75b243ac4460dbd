//! The noise of an IMU in the longest hold: what a sample's noise is taken for where the experiment does not say, and a section of the report.

use calibrant::estimate::{ImuCalibration, ImuSetup, WhiteNoise, holds_between};
use calibrant::motion::Hold;
use calibrant::noise::{Moments, Stretch, TriadNoise};
use calibrant::sensor::{ImuRecording, Triad};
use nalgebra::Vector3;

/// A hold shorter than this says too little of the noise, s.
const LONG_HOLD_S: f64 = 20.0;

/// The longest hold, where it is long enough.
pub(super) struct LongestHold {
    /// Its number, from 0.
    number: usize,
    hold: Hold,
}

/// The noise of a sensor in it, in the unit of the readings.
pub(super) struct HoldNoise {
    noise: TriadNoise,
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
        (hold.duration_s() >= LONG_HOLD_S).then_some(Self { number, hold })
    }

    /// The noise of a sensor in it; `None` where its samples do not determine it. Most often `other` has as many samples.
    pub(super) fn noise(
        &self,
        triad: Triad,
        recording: &ImuRecording,
        other: Option<&HoldNoise>,
    ) -> Option<HoldNoise> {
        let recording = recording.triad(triad)?;
        let stretch = Stretch::between(recording, self.hold.start_s, self.hold.end_s).ok()?;
        let same = other.filter(|other| other.moments.samples() == stretch.samples());
        let moments = same.map_or_else(|| Moments::of(stretch.samples()), |other| other.moments.clone());
        let noise = TriadNoise::with_moments(triad, recording, stretch, &moments).ok()?;
        Some(HoldNoise { noise, moments })
    }

    /// A gyroscope's white noise, where it is determined on all axes and the noise is understood.
    pub(super) fn white_noise(&self, gyroscope: &HoldNoise) -> Option<WhiteNoise> {
        let noise = &gyroscope.noise;
        let sd = noise.white_noise_per_sample().filter(|_| noise.explains())?;
        Some(WhiteNoise { sd, hold: self.number, duration_s: noise.stretch.duration_s() })
    }
}

impl HoldNoise {
    /// The noise in m/s² or rad/s.
    pub(super) fn physical(
        self,
        calibration: &ImuCalibration,
        recording: &ImuRecording,
    ) -> calibrant::Result<TriadNoise> {
        let triad = self.noise.triad;
        let matrix = calibration.imu.triad(triad).matrix;
        let gain = Vector3::from_fn(|axis, _| matrix.row(axis).norm());
        match recording.triad(triad) {
            Some(recording) => self.noise.with_gain(recording, &gain),
            None => Ok(self.noise),
        }
    }
}
