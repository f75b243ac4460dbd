//! Missing specific force: samples of a gyroscope near which the accelerometer has no data. The force that
//! acts on the g-sensitivity is then unknown.
//!
//! The sensor may have been turned since the last known force `f`. With gravity in any direction, the missing
//! force has the mean square `f fᵀ + I g²/3`.

use super::Recording;
use nalgebra::{Matrix3, Vector3};

/// A force is known within this number of sample intervals of the accelerometer.
const INTERVALS: f64 = 2.0;
/// Gravity, m/s²: accurate enough for a force that is not known.
const GRAVITY_MPS2: f64 = 9.81;

/// Where a gyroscope's g-sensitivity was corrected with a specific force that is not known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MissingSpecificForce {
    /// Number of samples of the gyroscope.
    pub samples: usize,
    /// Time of the first and of the last of them, s. Other samples may lie between.
    pub span_s: (f64, f64),
    /// Largest error of the correction if gravity points the other way, along the worst axis, rad/s.
    pub most_radps: f64,
}

/// The samples of a gyroscope without a known force.
pub(super) struct MissingForce(Vec<bool>);

impl MissingForce {
    /// `forces` is the accelerometer's recording, where the correction needs it.
    pub(super) fn of(readings: &Recording, forces: Option<&Recording>) -> Self {
        let Some(forces) = forces else { return Self(Vec::new()) };
        let step = forces.rate_hz().recip();
        let mut after = 0;
        let is_unknown = |t: &f64| {
            // both clocks go forwards
            after += forces.times_s[after..].iter().take_while(|time| *time < t).count();
            let near = |k: Option<usize>| {
                k.and_then(|k| forces.times_s.get(k)).is_some_and(|time| (time - t).abs() <= INTERVALS * step)
            };
            !near(Some(after)) && !near(after.checked_sub(1))
        };
        Self(readings.times_s.iter().map(is_unknown).collect())
    }

    pub(super) fn has(&self, sample: usize) -> bool {
        self.0.get(sample).copied().unwrap_or(false)
    }

    /// `by_force` is the matrix from an error of the force to an error of the rate.
    pub(super) fn summary(
        &self,
        readings: &Recording,
        by_force: &Matrix3<f64>,
    ) -> Option<MissingSpecificForce> {
        let mut times =
            self.0.iter().zip(&readings.times_s).filter(|(unknown, _)| **unknown).map(|(_, t)| *t);
        let first = times.next()?;
        let (samples, last) = times.fold((1, first), |(samples, _), t| (samples + 1, t));
        let most = by_force.row_iter().map(|row| row.norm()).fold(0.0, f64::max);
        Some(MissingSpecificForce { samples, span_s: (first, last), most_radps: 2.0 * GRAVITY_MPS2 * most })
    }
}

/// Variance of the rate along each axis, from a force whose last value alone is known.
pub(super) fn unknown_force_variance(by_force: &Matrix3<f64>, force: &Vector3<f64>) -> Vector3<f64> {
    let of_last = by_force * force;
    let of_gravity =
        Vector3::from_fn(|axis, _| by_force.row(axis).norm_squared() * GRAVITY_MPS2.powi(2) / 3.0);
    of_last.component_mul(&of_last) + of_gravity
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::gauge_change::tests::imu;
    use crate::sensor::{ImuCorrection, ImuRecording, ReadingUnit};
    use crate::simulate::{Purpose, stream};
    use rand_distr::{Distribution, UnitSphere};

    fn recording(times_s: &[f64], reading: Vector3<f64>) -> Recording {
        Recording {
            times_s: times_s.to_vec(),
            readings: vec![reading; times_s.len()],
            axes: 3,
            unit: ReadingUnit::Counts,
        }
    }

    /// Draws forces of gravity in any direction and compares the scatter of the rate.
    #[test]
    fn the_uncertainty_has_the_unknown_force_in_it() {
        let imu = imu();
        let force = Vector3::new(1.0, -5.0, 8.0);
        let correction = ImuCorrection::of(&imu).expect("regular");
        let recording = ImuRecording {
            accelerometer: Some(recording(
                &[0.0, 1.0, 2.0, 9.0, 10.0],
                imu.parameters.accelerometer.reading(&force),
            )),
            gyroscope: Some(recording(
                &[0.0, 3.9, 4.1, 5.0, 6.9, 7.1, 12.0, 12.1, 20.0],
                imu.parameters.gyroscope.bias,
            )),
            temperature_c: None,
        };
        let found = correction.apply(&imu, &recording).expect("both there");
        let unknown = found.missing_specific_force.expect("a gap and the end");
        assert_eq!((unknown.samples, unknown.span_s), (5, (4.1, 20.0)));
        let sd = found.gyroscope.expect("there").sd.expect("known");
        let known = [1, 5, 6].map(|k| (sd[k] - sd[0]).amax());
        assert!(known.iter().all(|by| *by < 1e-12), "{sd:?}");
        let by_force =
            imu.parameters.gyroscope.matrix.try_inverse().expect("regular") * imu.parameters.g_sensitivity;
        let mut rng = stream(1, Purpose::Sensor, 0);
        let count = 40_000;
        let mut squares = Vector3::zeros();
        let mut most = 0.0_f64;
        for _ in 0..count {
            let missed = by_force * (Vector3::from(UnitSphere.sample(&mut rng)) * GRAVITY_MPS2 - force);
            squares += missed.component_mul(&missed) / f64::from(count);
            most = most.max(missed.amax());
        }
        for k in [2, 3, 4, 7, 8] {
            let by_unknown = sd[k].component_mul(&sd[k]) - sd[0].component_mul(&sd[0]);
            // 4 standard deviations of a mean of 40 000 squares
            let ratios = by_unknown.component_div(&squares);
            assert!(ratios.iter().all(|ratio| (ratio - 1.0).abs() < 0.03), "{by_unknown:?} {squares:?}");
        }
        assert!(most <= unknown.most_radps, "{most} {unknown:?}");
    }

    #[test]
    fn a_spike_of_the_accelerometer_is_no_force_that_is_felt() {
        let imu = imu();
        let correction = ImuCorrection::of(&imu).expect("regular");
        let times_s: Vec<f64> = (0..600).map(|k| f64::from(k) * 0.01).collect();
        let force = |t: &f64| Vector3::new(0.01 * (700.0 * t).sin(), -5.0, 8.0 + 0.01 * (900.0 * t).cos());
        let reading = |t: &f64| imu.parameters.accelerometer.reading(&force(t));
        let whole = ImuRecording {
            accelerometer: Some(Recording {
                readings: times_s.iter().map(reading).collect(),
                ..recording(&times_s, Vector3::zeros())
            }),
            gyroscope: Some(recording(&times_s, imu.parameters.gyroscope.bias)),
            temperature_c: None,
        };
        let rates = |of: &ImuRecording| {
            let (clean, _) = of.without_spikes();
            let found = correction.apply_feeling(&imu, of, clean.accelerometer.as_ref());
            found.expect("both there").gyroscope.expect("there").values
        };
        let clean = rates(&whole);
        for invalid in [-2_147_483_648.0, 1e12] {
            let mut spiked = whole.clone();
            spiked.accelerometer.as_mut().expect("there").readings[300].x = invalid;
            let by_force = imu.parameters.g_sensitivity.norm();
            for (one, other) in rates(&spiked).iter().zip(&clean) {
                assert!((one - other).norm() < 0.1 * by_force, "{one} {other}");
            }
        }
    }
}
