//! The drift of the accelerometer's bias over a recording. Where recordings are calibrated together and their biases differ, each drifts alike.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::change::BiasDrifts;
use crate::estimate::recording_biases::recording_at;
use crate::motion::Hold;
use crate::sensor::{ReadingUnit, Recording};
use nalgebra::{Matrix3, Vector3};

/// The drift of the accelerometer's bias from the first hold to the last, in the unit of its readings.
#[derive(Debug, Clone, PartialEq)]
pub struct BiasDrift {
    /// Its estimate.
    pub value: Vector3<f64>,
    /// Its covariance.
    pub covariance: Matrix3<f64>,
    /// Degrees of freedom that the data give to it and not the prior, 0 to 3.
    pub degrees_of_freedom: f64,
    /// Middle of the first hold and of the last, s; of each recording that has a bias of its own.
    pub spans_s: Vec<(f64, f64)>,
    /// Standard deviation that was expected of it, per axis.
    pub expected_sd: Vector3<f64>,
}

/// A drift of more than this many expected standard deviations is not the one that was allowed for.
const FAR: f64 = 3.0;

impl BiasDrift {
    /// Standard deviation per axis.
    #[must_use]
    pub fn sd(&self) -> Vector3<f64> {
        self.covariance.diagonal().map(|variance| variance.max(0.0).sqrt())
    }

    /// The time of which the biases are, s.
    #[must_use]
    pub fn biases_at_s(&self) -> f64 {
        let (start_s, end_s) = self.last_span_s();
        0.5 * (start_s + end_s)
    }

    fn last_span_s(&self) -> (f64, f64) {
        self.spans_s.last().copied().unwrap_or_default()
    }

    /// The warning about a drift beyond what was expected.
    pub(in crate::estimate) fn beyond_expected(&self, unit: ReadingUnit) -> Option<Diagnostic> {
        let deviations = self.value.abs().component_div(&self.expected_sd).max();
        let (drift, (start_s, end_s), biases_at_s) = (self.value, self.last_span_s(), self.biases_at_s());
        (deviations > FAR).then(|| BiasDrifts { drift, unit, deviations, start_s, end_s, biases_at_s }.into())
    }

    /// `τ` at a time: −½ in the first hold, ½ in the last.
    fn part(&self, time_s: f64) -> f64 {
        // a pause between two recordings belongs to that before it
        let begun = self.spans_s.iter().rposition(|(first, _)| *first <= time_s).unwrap_or_default();
        match self.spans_s.get(begun) {
            Some((first, last)) if last > first => (time_s - first) / (last - first) - 0.5,
            _ => 0.0,
        }
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

/// Middle of the first hold and of the last, s; of each recording that has holds, where further ones begin at these times.
pub(in crate::estimate) fn spans(holds: &[Hold], further_from_s: &[f64]) -> Vec<(f64, f64)> {
    let of = |r: usize| {
        let mut of_recording =
            holds.iter().filter(|hold| recording_at(further_from_s, hold.start_s) == r).map(middle);
        let first = of_recording.next()?;
        Some((first, of_recording.next_back().unwrap_or(first)))
    };
    (0..=further_from_s.len()).filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drift_of_more_than_three_expected_ones_is_a_warning_with_the_time_of_the_biases() {
        let of = |z: f64| BiasDrift {
            value: Vector3::new(0.01, -0.02, z),
            covariance: Matrix3::identity() * 1e-8,
            degrees_of_freedom: 3.0,
            spans_s: vec![(10.0, 110.0)],
            expected_sd: Vector3::repeat(0.02),
        };
        let unit = ReadingUnit::MetrePerSecondSquared;
        assert_eq!(of(0.059).beyond_expected(unit), None);
        let found = of(-0.1).beyond_expected(unit).expect("five times what was expected");
        assert!(found.is_warning() && found.message().contains("are those at 60 s"), "{found}");
    }
}
