//! The time of each rotation from one stationary interval to the next, and whether it can be integrated.

use crate::diagnostic::RotationReason;
use crate::estimate::holds::ROUNDED_TIME_STEPS;
use crate::estimate::imu::model::{HoldData, LocalBias, RotationData, Samples};
use crate::estimate::imu::rotations::gravity_at_ends::{AtEnds, MARGIN_S, margin_s};
use crate::estimate::imu::rotations::knocks::Knocks;
use crate::motion::Hold;
use crate::sensor::{Recording, Saturation, SensorKind};
use nalgebra::Vector3;
use std::ops::Range;

/// A shorter saturation of the accelerometer in a rotation does not matter, s. With 1 g cut off and a common g-sensitivity of 2e-4 (rad/s)/(m/s²),
/// the error is 0.1 mrad.
const BRIEF_S: f64 = 0.05;

/// The time from shortly before the end of a hold to shortly after the start of the next.
pub(crate) struct Span {
    /// Begin, s: of the first sample, where the gyroscope covers it.
    pub(crate) start_s: f64,
    /// End, s: of the last sample, where the gyroscope covers it.
    pub(crate) end_s: f64,
    /// The gyroscope's samples in it, and one more on each side.
    samples: Range<usize>,
    /// Does the gyroscope's recording begin before and end after it?
    covered: bool,
    /// Are the holds of different recordings? Then there is no rotation.
    pub(crate) is_between_recordings: bool,
}

/// The times between these holds, with the gyroscope's samples. `further_from_s`: when further recordings begin.
pub(crate) fn rotation_spans(gyroscope: &Recording, holds: &[&Hold], further_from_s: &[f64]) -> Vec<Span> {
    let slack_s = ROUNDED_TIME_STEPS / gyroscope.rate_hz();
    holds
        .windows(2)
        .map(|pair| {
            let (from, to) = (pair[0], pair[1]);
            let (start_s, end_s) = (from.end_s - margin_s(from), to.start_s + margin_s(to));
            let times = &gyroscope.times_s;
            let first = times.partition_point(|&t| t <= start_s + slack_s).saturating_sub(1);
            let end = (times.partition_point(|&t| t < end_s - slack_s) + 1).min(gyroscope.len());
            let covered = times[first] <= from.end_s && times[end - 1] >= to.start_s;
            let is_between_recordings = further_from_s.iter().any(|t| (from.end_s..=to.start_s).contains(t));
            let samples = if covered { first..end } else { first..first + 1 };
            let (start_s, end_s) = if covered { (times[first], times[end - 1]) } else { (start_s, end_s) };
            Span { start_s, end_s, samples, covered, is_between_recordings }
        })
        .collect()
}

/// Can rotations be integrated?
pub(crate) struct Integrable<'a> {
    pub(crate) gyroscope: &'a Recording,
    gap_s: f64,
    saturations: Vec<Saturation>,
    /// The accelerometer before spikes were replaced, with the ends of its range. Only for a gyroscope with g-sensitivity.
    felt: Option<(&'a Recording, Vec<Saturation>)>,
}

impl<'a> Integrable<'a> {
    /// `felt`: the accelerometer before spikes were replaced, for a gyroscope with g-sensitivity.
    pub(crate) fn of(gyroscope: &'a Recording, felt: Option<&'a Recording>) -> Self {
        let (of_gyroscope, felt) = rayon::join(
            || (gyroscope.gap_s(), gyroscope.saturations()),
            || felt.map(|accelerometer| (accelerometer, accelerometer.saturations())),
        );
        let (gap_s, saturations) = of_gyroscope;
        Self { gyroscope, gap_s, saturations, felt }
    }

    /// The rotations in these spans, each from one of the holds to the next. `at_ends`: gravity at the ends of the holds.
    pub(crate) fn rotations(
        &self,
        felt: Option<&'a [Vector3<f64>]>,
        spans: &[Span],
        (holds, at_ends): (&[HoldData], &[AtEnds]),
    ) -> Vec<RotationData<'a>> {
        let rotation = |(from, span): (usize, &Span)| RotationData {
            from,
            samples: Samples {
                times_s: &self.gyroscope.times_s[span.samples.clone()],
                readings: &self.gyroscope.readings[span.samples.clone()],
                forces: felt.map(|felt| &felt[span.samples.clone()]),
                drift: [from, from + 1].map(|hold| LocalBias::none(holds[hold].temperature_c)),
            },
            knocks: Knocks::find(
                &self.gyroscope.times_s[span.samples.clone()],
                &self.gyroscope.readings[span.samples.clone()],
            ),
            beside_means: [at_ends[from][1], at_ends[from + 1][0]],
            used: !span.is_between_recordings && self.obstacle(span).is_none(),
            counts: true,
        };
        spans.iter().enumerate().map(rotation).collect()
    }

    /// Why a span cannot be integrated. `None` if it can.
    pub(crate) fn obstacle(&self, span: &Span) -> Option<RotationReason> {
        let times = &self.gyroscope.times_s;
        if !span.covered {
            return Some(match (times.first(), times.last()) {
                (Some(begin), _) if *begin > span.start_s + MARGIN_S => {
                    RotationReason::GyroscopeBegins(*begin)
                }
                (_, Some(end)) => RotationReason::GyroscopeEnds(*end),
                _ => RotationReason::SamplesMissing,
            });
        }
        let longest = times[span.samples.clone()].windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max);
        if longest > self.gap_s {
            return Some(RotationReason::GyroscopePauses(longest));
        }
        if span.samples.len() < 3 {
            return Some(RotationReason::SamplesMissing);
        }
        self.saturation(&span.samples)
    }

    /// The sensor that saturates in these samples. They cannot be integrated.
    pub(crate) fn saturation(&self, span: &Range<usize>) -> Option<RotationReason> {
        let readings = &self.gyroscope.readings[span.clone()];
        if let Some(end) = self.saturations.iter().find(|end| end.is_reached(readings)) {
            return Some(RotationReason::Saturated(SensorKind::Gyroscope, end.axis));
        }
        let (accelerometer, ends) = self.felt.as_ref()?;
        let times = &self.gyroscope.times_s;
        let (start_s, end_s) = (times[span.start], times[span.end - 1]);
        let readings = &accelerometer.readings[accelerometer.between(start_s, end_s)];
        let brief = BRIEF_S * readings.len() as f64 / (end_s - start_s);
        let lasts = |end: &&Saturation| end.touches(readings) as f64 > brief;
        let end = ends.iter().find(lasts)?;
        Some(RotationReason::Saturated(SensorKind::Accelerometer, end.axis))
    }
}
