//! The noise of an IMU in the longest hold: what a sample's noise is taken for where the experiment does not say, and a section of the report.

use calibrant::estimate::{HoldsSetup, ImuCalibration, WhiteNoise, find_imu_holds, holds_between};
use calibrant::io::ImuFile;
use calibrant::noise::TriadNoise;
use calibrant::sensor::{ImuRecording, Triad};
use nalgebra::Vector3;

/// A hold shorter than this says too little of the noise, s.
const LONG_HOLD_S: f64 = 20.0;

/// What the longest hold shows, in the unit of the readings.
#[derive(Default)]
pub(super) struct HoldNoise {
    /// The hold, from 0.
    hold: usize,
    triads: Vec<TriadNoise>,
}

impl HoldNoise {
    /// Examines the longest hold where it is long enough. Holds that cannot be found are the calibration's to complain about.
    pub(super) fn of(setup: &HoldsSetup, recording: &ImuRecording) -> Self {
        let holds = recording.accelerometer.as_ref().and_then(|accelerometer| {
            match &setup.intervals_s {
                Some(intervals) => holds_between(accelerometer, intervals),
                None => find_imu_holds(recording, setup.minimum_hold_s),
            }
            .ok()
        });
        let Some((number, hold)) = holds.as_ref().and_then(|holds| {
            holds
                .iter()
                .enumerate()
                .max_by(|(_, one), (_, other)| one.duration_s().total_cmp(&other.duration_s()))
        }) else {
            return Self::default();
        };
        if hold.duration_s() < LONG_HOLD_S {
            return Self::default();
        }
        Self { hold: number, triads: TriadNoise::of_imu(recording, hold.start_s, hold.end_s) }
    }

    /// The gyroscope's white noise, where it is determined on all axes and the noise is understood.
    pub(super) fn gyroscope(&self) -> Option<WhiteNoise> {
        let noise = self.triads.iter().find(|noise| noise.triad == Triad::Gyroscope)?;
        let sd = noise.white_noise_per_sample().filter(|_| noise.explains())?;
        Some(WhiteNoise { sd, hold: self.hold, duration_s: noise.stretch.duration_s() })
    }

    /// The noise of both sensors in m/s² and rad/s.
    pub(super) fn physical(
        self,
        calibration: &ImuCalibration,
        file: &ImuFile,
    ) -> calibrant::Result<Vec<TriadNoise>> {
        let of = |noise: TriadNoise| {
            let matrix = calibration.imu.triad(noise.triad).matrix;
            let gain = Vector3::from_fn(|axis, _| matrix.row(axis).norm());
            let recording = file.recording.triad(noise.triad)?;
            Some(noise.with_gain(recording, &gain))
        };
        self.triads.into_iter().filter_map(of).collect()
    }
}
