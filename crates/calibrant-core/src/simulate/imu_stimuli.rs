//! The stimuli of an IMU in a motion, and the recording that follows from them.

use super::{ImuSimulation, Rng};
use crate::sensor::{ImuParameters, ImuRecording, ReadingUnit, Recording};
use nalgebra::Vector3;
use rand_distr::{Distribution, StandardNormal};

/// The stimuli of both sensors, sample by sample.
#[derive(Default)]
pub(super) struct Stimuli {
    times_s: Vec<f64>,
    /// Specific force, m/s².
    forces: Vec<Vector3<f64>>,
    /// Angular rate, rad/s.
    rates: Vec<Vector3<f64>>,
}

impl Stimuli {
    pub(super) fn len(&self) -> usize {
        self.times_s.len()
    }

    pub(super) fn push(&mut self, time_s: f64, force: Vector3<f64>, rate: Vector3<f64>) {
        self.times_s.push(time_s);
        self.forces.push(force);
        self.rates.push(rate);
    }

    /// Adds to the forces in each of these intervals of time (start and end, s) a disturbance of its own.
    pub(super) fn disturb(&mut self, holds: impl Iterator<Item = (f64, f64)>, sd_mps2: f64, rng: &mut Rng) {
        if sd_mps2 <= 0.0 {
            return;
        }
        for (start_s, end_s) in holds {
            let disturbance = Vector3::from_fn(|_, _| {
                let z: f64 = StandardNormal.sample(rng);
                sd_mps2 * z
            });
            let first = self.times_s.partition_point(|t| *t < start_s);
            let end = self.times_s.partition_point(|t| *t < end_s);
            self.forces[first..end].iter_mut().for_each(|force| *force += disturbance);
        }
    }

    /// The readings of both sensors at the temperature of each sample. The noise of the accelerometer is
    /// drawn first, then that of the gyroscope.
    pub(super) fn record(self, imu: &ImuParameters, setup: &ImuSimulation, rng: &mut Rng) -> ImuRecording {
        let samples = 0..self.len();
        let last = self.len().saturating_sub(1).max(1) as f64;
        let temperature_c: Option<Vec<f64>> = setup
            .temperature_c
            .map(|[from, to]| samples.clone().map(|k| from + (to - from) * (k as f64 / last)).collect());
        let at = |k: usize| temperature_c.as_ref().map_or(*imu, |temperature| imu.at(temperature[k]));
        let mut noisy = |reading: Vector3<f64>, sd: f64| {
            reading
                + Vector3::from_fn(|_, _| {
                    let z: f64 = StandardNormal.sample(rng);
                    sd * z
                })
        };
        let accelerometer: Vec<_> = samples
            .clone()
            .map(|k| noisy(at(k).accelerometer.reading(&self.forces[k]), setup.accelerometer_noise))
            .collect();
        let gyroscope: Vec<_> = samples
            .map(|k| {
                let felt = imu.g_sensitivity * self.forces[k];
                noisy(at(k).gyroscope.reading(&self.rates[k]) + felt, setup.gyroscope_noise)
            })
            .collect();
        let recording = |times_s: Vec<f64>, readings, unit: ReadingUnit| {
            Some(Recording { times_s, readings, axes: 3, unit })
        };
        ImuRecording {
            accelerometer: recording(self.times_s.clone(), accelerometer, setup.accelerometer_unit),
            gyroscope: recording(self.times_s, gyroscope, setup.gyroscope_unit),
            temperature_c,
        }
    }
}
