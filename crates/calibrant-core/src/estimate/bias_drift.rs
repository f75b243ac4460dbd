//! The drift of the accelerometer's bias over a recording.

use crate::motion::Hold;
use crate::sensor::Recording;
use nalgebra::{Matrix3, Vector3};

/// The drift of the accelerometer's bias from the first hold to the last, in the unit of its readings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BiasDrift {
    /// Its estimate.
    pub value: Vector3<f64>,
    /// Its covariance.
    pub covariance: Matrix3<f64>,
    /// Degrees of freedom that the data give to it and not the prior, 0 to 3.
    pub degrees_of_freedom: f64,
    /// Middle of the first hold and of the last, s.
    pub span_s: (f64, f64),
}

impl BiasDrift {
    /// Standard deviation per axis.
    #[must_use]
    pub fn sd(&self) -> Vector3<f64> {
        self.covariance.diagonal().map(|variance| variance.max(0.0).sqrt())
    }

    /// `τ` at a time: −½ in the first hold, ½ in the last.
    fn part(&self, time_s: f64) -> f64 {
        let (first, last) = self.span_s;
        (time_s - first) / (last - first).max(f64::MIN_POSITIVE) - 0.5
    }

    /// `τ` of a hold.
    pub(in crate::estimate) fn part_of(&self, hold: &Hold) -> f64 {
        self.part(middle(hold))
    }

    /// The recording as it would be without it.
    pub(in crate::estimate) fn taken_out_of(&self, recording: &Recording) -> Recording {
        let readings = recording.times_s.iter().zip(&recording.readings);
        let readings = readings.map(|(time_s, reading)| reading - self.value * self.part(*time_s)).collect();
        Recording { readings, times_s: recording.times_s.clone(), ..*recording }
    }

    /// The holds as they would be without it.
    pub(in crate::estimate) fn taken_out(&self, holds: &[Hold]) -> Vec<Hold> {
        let of_hold =
            |hold: &Hold| Hold { mean: hold.mean - self.value * self.part_of(hold), ..hold.clone() };
        holds.iter().map(of_hold).collect()
    }
}

fn middle(hold: &Hold) -> f64 {
    0.5 * (hold.start_s + hold.end_s)
}

/// Middle of the first hold and of the last, s.
pub(in crate::estimate) fn span(holds: &[Hold]) -> (f64, f64) {
    (holds.first().map_or(0.0, middle), holds.last().map_or(0.0, middle))
}
