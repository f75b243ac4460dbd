//! The noise of another recording beside that of the calibration's: another range, bandwidth or filter makes it another, and the parameters no worse.
//!
//! What the calibration took for the noise of a sample, from a datasheet or an Allan deviation, goes with the scatter of the samples about the mean of their hold, `s' / s` of both recordings.

use super::covariance_verdict::CLOSE;
use crate::estimate::coarse_axes_in;
use crate::motion::Hold;
use crate::sensor::{ReadingUnit, Recording, SensorKind};
use nalgebra::Vector3;

/// How the samples of a sensor scatter within the holds of another recording, over how they do in the calibration's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NoiseRatio {
    /// The sensor.
    pub sensor_kind: SensorKind,
    /// The ratio of each axis; 1 where a recording shows no noise.
    pub axes: Vector3<f64>,
    /// Where it is another noise, and the recording's readings come in steps coarser than what they show beside them: the coarsest step.
    pub coarse: Option<CoarseStep>,
}

/// A step of readings that is coarse beside their noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoarseStep {
    /// The step, in the unit of the readings.
    pub step: f64,
    /// That unit.
    pub unit: ReadingUnit,
}

impl NoiseRatio {
    /// `sd`: standard deviation of a sample within holds.
    pub(super) fn of(sensor_kind: SensorKind, sd: &Vector3<f64>, calibrated_sd: &Vector3<f64>) -> Self {
        let shows = |axis: usize| sd[axis] > 0.0 && calibrated_sd[axis] > 0.0;
        let ratio = |axis: usize| if shows(axis) { sd[axis] / calibrated_sd[axis] } else { 1.0 };
        Self { sensor_kind, axes: Vector3::from_fn(|axis, _| ratio(axis)), coarse: None }
    }

    /// That of a recording with the calibration's own noise.
    pub(super) fn one(sensor_kind: SensorKind) -> Self {
        Self { sensor_kind, axes: Vector3::repeat(1.0), coarse: None }
    }

    /// With the step of the recording, where it makes the noise another.
    pub(super) fn with_steps<'a>(self, recording: &Recording, holds: impl Iterator<Item = &'a Hold>) -> Self {
        if !self.differs() {
            return self;
        }
        let steps = coarse_axes_in(recording, holds).into_iter().map(|found| found.step);
        let coarsest = steps.max_by(f64::total_cmp);
        Self { coarse: coarsest.map(|step| CoarseStep { step, unit: recording.unit }), ..self }
    }

    /// Of all axes: the geometric mean.
    #[must_use]
    pub fn overall(&self) -> f64 {
        self.axes.product().cbrt()
    }

    /// Is it another noise, by a quarter or more?
    #[must_use]
    pub fn differs(&self) -> bool {
        !(1.0 / CLOSE..=CLOSE).contains(&self.overall())
    }
}
