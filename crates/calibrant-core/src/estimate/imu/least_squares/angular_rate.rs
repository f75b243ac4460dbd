//! The corrected angular rate at each sample of a rotation, and the angle travelled and largest rate that follow from it.
//!
//! `ω = M (y − b − Γ f)` with `M = S_g⁻¹`: reading y, bias b, g-sensitivity Γ, specific force f.
//!
//! The gain is that at the mean temperature of the holds before and after. The bias is linear in time from the hold before to the hold after.

use crate::estimate::imu::model::Samples;
use crate::sensor::{ImuParameters, SensorKind, times};
use nalgebra::{Matrix3, Vector3};

impl Samples<'_> {
    /// The angle travelled and the largest rate, corrected with the parameters of an IMU.
    pub(crate) fn path(&self, imu: &ImuParameters) -> Path {
        let Some(rates) = Rates::of(self, imu) else { return Path::default() };
        let mut path = Path::default();
        let mut before = 0.0;
        for k in 0..self.times_s.len() {
            let (after, speed) = (rates.step_after(k), rates.at(k, rates.part(k), &rates.force(k)).norm());
            path.length_rad += 0.5 * (before + after) * speed;
            path.peak_radps = path.peak_radps.max(speed);
            before = after;
        }
        path
    }
}

/// The path and the largest rate of a rotation.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Path {
    /// `∫ |ω| dt`, rad.
    pub(crate) length_rad: f64,
    /// Largest rate, rad/s.
    pub(crate) peak_radps: f64,
}

/// The corrected rate at each sample, `M (y − b − Γ f)`. Constant products are computed once.
pub(crate) struct Rates<'a> {
    samples: &'a Samples<'a>,
    pub(crate) correction: Matrix3<f64>,
    by_force: Matrix3<f64>,
    /// `M b` at the start, and its increase until the end.
    at_start: Vector3<f64>,
    drifted: Vector3<f64>,
    from_s: f64,
    per_s: f64,
}

impl<'a> Rates<'a> {
    /// `None` where the gyroscope's matrix is singular.
    pub(crate) fn of(samples: &'a Samples<'a>, imu: &ImuParameters) -> Option<Self> {
        let correction = imu.at(samples.temperature_c())[SensorKind::Gyroscope].matrix.try_inverse()?;
        let ends = samples.drift.map(|end| end.at(imu));
        let (from_s, to_s) = (samples.times_s[0], samples.times_s[samples.times_s.len() - 1]);
        Some(Self {
            samples,
            correction,
            by_force: correction * imu.g_sensitivity,
            at_start: correction * ends[0],
            drifted: correction * (ends[1] - ends[0]),
            from_s,
            per_s: 1.0 / (to_s - from_s),
        })
    }

    /// The place of a sample between start and end, 0 to 1.
    #[inline]
    pub(crate) fn part(&self, k: usize) -> f64 {
        (self.samples.times_s[k] - self.from_s) * self.per_s
    }

    #[inline]
    pub(crate) fn force(&self, k: usize) -> Vector3<f64> {
        self.samples.forces.map_or_else(Vector3::zeros, |forces| forces[k])
    }

    #[inline]
    pub(crate) fn at(&self, k: usize, part: f64, force: &Vector3<f64>) -> Vector3<f64> {
        let reading = times(&self.correction, &self.samples.readings[k]);
        reading - self.at_start - self.drifted * part - times(&self.by_force, force)
    }

    /// Weight of a sample in time, s.
    #[inline]
    pub(crate) fn step_after(&self, k: usize) -> f64 {
        let times = &self.samples.times_s;
        times.get(k + 1).map_or(0.0, |next| next - times[k])
    }
}
