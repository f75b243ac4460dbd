//! The angular rate during a rotation, `ω = M (y − b − Γ f)` with `M = S_g⁻¹`, sample by sample.
//!
//! The gain is that at the mean temperature of the holds before and after; the bias goes from that at the one's to that at the other's.

use crate::sensor::{ImuParameters, times};
use nalgebra::{Matrix3, Vector3};

/// The readings of a rotation.
#[derive(Clone, Copy)]
pub(super) struct Samples<'a> {
    pub(super) times_s: &'a [f64],
    pub(super) readings: &'a [Vector3<f64>],
    /// Specific force at these times, where the gyroscope feels it.
    pub(super) forces: Option<&'a [Vector3<f64>]>,
    /// What the holds before and after say of the bias; in between it is taken to drift evenly.
    pub(super) drift: [LocalBias; 2],
}

/// The bias at one end of a rotation: `b + share ∘ (mean − b − Γ f − S ω)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LocalBias {
    /// Mean reading of the hold.
    pub(super) mean: Vector3<f64>,
    /// Specific force in it.
    pub(super) force: Vector3<f64>,
    /// Angular rate in it: the Earth's, rad/s.
    pub(super) rate: Vector3<f64>,
    /// How far it counts against the mean bias of all, 0 to 1: the share of its variance that is a true deviation.
    pub(super) share: Vector3<f64>,
    /// Variance of the mean from the noise of its samples.
    pub(super) variance: Vector3<f64>,
    /// Temperature of the hold, °C.
    pub(super) temperature_c: f64,
}

impl LocalBias {
    /// The bias is that of all holds.
    pub(super) fn none(temperature_c: f64) -> Self {
        Self {
            temperature_c,
            mean: Vector3::zeros(),
            force: Vector3::zeros(),
            rate: Vector3::zeros(),
            share: Vector3::zeros(),
            variance: Vector3::zeros(),
        }
    }

    fn of(&self, imu: &ImuParameters) -> Vector3<f64> {
        let gyroscope = imu.at(self.temperature_c).gyroscope;
        let deviation = self.mean - gyroscope.reading(&self.rate) - imu.g_sensitivity * self.force;
        gyroscope.bias + self.share.component_mul(&deviation)
    }
}

impl Samples<'_> {
    /// Mean temperature of the holds before and after, °C.
    pub(super) fn temperature_c(&self) -> f64 {
        middle(&self.drift)
    }

    /// How long it lasts, s.
    pub(super) fn duration_s(&self) -> f64 {
        self.times_s[self.times_s.len() - 1] - self.times_s[0]
    }

    /// How far and how fast it went by an IMU.
    pub(super) fn path(&self, imu: &ImuParameters) -> Path {
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

/// How far and how fast an IMU was turned.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Path {
    /// `∫ |ω| dt`, rad.
    pub(super) length_rad: f64,
    /// Largest rate, rad/s.
    pub(super) peak_radps: f64,
}

/// The corrected rate at each sample, `M (y − b − Γ f)`, with the constant parts multiplied out.
pub(super) struct Rates<'a> {
    samples: &'a Samples<'a>,
    pub(super) correction: Matrix3<f64>,
    by_force: Matrix3<f64>,
    /// `M b` at the start, and how much more it is at the end.
    at_start: Vector3<f64>,
    drifted: Vector3<f64>,
    from_s: f64,
    per_s: f64,
}

impl<'a> Rates<'a> {
    /// `None` where the gyroscope's matrix is singular.
    pub(super) fn of(samples: &'a Samples<'a>, imu: &ImuParameters) -> Option<Self> {
        let correction = imu.at(samples.temperature_c()).gyroscope.matrix.try_inverse()?;
        let ends = samples.drift.map(|end| end.of(imu));
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

    /// How far from the start to the end a sample is, 0 to 1.
    #[inline]
    pub(super) fn part(&self, k: usize) -> f64 {
        (self.samples.times_s[k] - self.from_s) * self.per_s
    }

    #[inline]
    pub(super) fn force(&self, k: usize) -> Vector3<f64> {
        self.samples.forces.map_or_else(Vector3::zeros, |forces| forces[k])
    }

    #[inline]
    pub(super) fn at(&self, k: usize, part: f64, force: &Vector3<f64>) -> Vector3<f64> {
        let reading = times(&self.correction, &self.samples.readings[k]);
        reading - self.at_start - self.drifted * part - times(&self.by_force, force)
    }

    /// Time that a sample stands for, s.
    #[inline]
    pub(super) fn step_after(&self, k: usize) -> f64 {
        let times = &self.samples.times_s;
        times.get(k + 1).map_or(0.0, |next| next - times[k])
    }
}

pub(super) fn middle(ends: &[LocalBias; 2]) -> f64 {
    0.5 * (ends[0].temperature_c + ends[1].temperature_c)
}
