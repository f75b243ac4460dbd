//! What the gyroscope recorded of each rotation and each turn.

use super::ImuProblem;
use super::joint::{HoldData, RotationData, TurnData};
use super::rates::{LocalBias, Samples};
use super::still::StillNoise;
use super::thermal::Climate;
use crate::error::{Complaint, Error, Result};
use crate::motion::Hold;
use crate::sensor::{ImuParameters, Recording, Saturation, SensorParameters, interpolated, times};
use nalgebra::Vector3;
use rayon::prelude::*;
use std::ops::Range;

/// A rotation begins this long before the end of a hold, s: a hand begins to turn so gently that the first milliradians look still.
const MARGIN_S: f64 = 0.3;
/// Samples that one thread takes at a time.
const PIECE: usize = 4096;
/// What a saturated accelerometer lacks for less than this in a rotation does not matter, s: with 1 g cut off and the g-sensitivity of common sensors, 2e-4
/// (rad/s)/(m/s²), the gyroscope adds up to 0.1 mrad in it.
const BRIEF_S: f64 = 0.05;

/// The specific force at the gyroscope's sample times.
pub(super) fn felt_forces(
    accelerometer: &Recording,
    gyroscope: &Recording,
    sensor: &SensorParameters,
) -> Option<Vec<Vector3<f64>>> {
    let correction = sensor.matrix.try_inverse()?;
    let force = |k: usize| times(&correction, &(accelerometer.readings[k] - sensor.bias));
    let at = |k: usize| interpolated(&accelerometer.times_s, force, gyroscope.times_s[k], k);
    // zero only where the accelerometer has no sample at all
    let felt = |k: usize| at(k).unwrap_or_else(Vector3::zeros);
    Some((0..gyroscope.len()).into_par_iter().with_min_len(PIECE).map(felt).collect())
}

/// The time from shortly before the end of a hold to shortly after the start of the next.
pub(super) struct Span {
    /// Begin, s: of the first sample, where the gyroscope covers it.
    pub(super) start_s: f64,
    /// End, s: of the last sample, where the gyroscope covers it.
    pub(super) end_s: f64,
    /// The gyroscope's samples in it and one beside it on each side.
    samples: Range<usize>,
    /// Does the gyroscope's recording begin before and end after it?
    covered: bool,
}

/// The times between these holds, with the gyroscope's samples.
pub(super) fn rotation_spans(gyroscope: &Recording, holds: &[&Hold]) -> Vec<Span> {
    holds
        .windows(2)
        .map(|pair| {
            let (from, to) = (pair[0], pair[1]);
            let margin = |hold: &Hold| (0.25 * hold.duration_s()).min(MARGIN_S);
            let (start_s, end_s) = (from.end_s - margin(from), to.start_s + margin(to));
            let times = &gyroscope.times_s;
            let first = times.partition_point(|&t| t <= start_s).saturating_sub(1);
            let end = (times.partition_point(|&t| t < end_s) + 1).min(gyroscope.len());
            let covered = times[first] <= from.end_s && times[end - 1] >= to.start_s;
            if covered {
                Span { start_s: times[first], end_s: times[end - 1], samples: first..end, covered }
            } else {
                Span { start_s, end_s, samples: first..first + 1, covered }
            }
        })
        .collect()
}

/// Can rotations be integrated?
pub(super) struct Integrable<'a> {
    gyroscope: &'a Recording,
    gap_s: f64,
    saturations: Vec<Saturation>,
    /// The accelerometer as it was read, where the gyroscope feels the specific force, with the ends of its range that it touches.
    felt: Option<(&'a Recording, Vec<Saturation>)>,
}

impl<'a> Integrable<'a> {
    /// `felt`: the accelerometer as it was read, where the gyroscope feels the specific force.
    pub(super) fn of(gyroscope: &'a Recording, felt: Option<&'a Recording>) -> Self {
        let (of_gyroscope, felt) = rayon::join(
            || (gyroscope.gap_s(), gyroscope.saturations()),
            || felt.map(|accelerometer| (accelerometer, accelerometer.saturations())),
        );
        let (gap_s, saturations) = of_gyroscope;
        Self { gyroscope, gap_s, saturations, felt }
    }

    /// The rotations in these spans, each from one of the holds to the next.
    pub(super) fn rotations(
        &self,
        felt: Option<&'a [Vector3<f64>]>,
        spans: &[Span],
        holds: &[HoldData],
    ) -> Vec<RotationData<'a>> {
        let rotation = |(from, span): (usize, &Span)| RotationData {
            from,
            samples: Samples {
                times_s: &self.gyroscope.times_s[span.samples.clone()],
                readings: &self.gyroscope.readings[span.samples.clone()],
                forces: felt.map(|felt| &felt[span.samples.clone()]),
                drift: [from, from + 1].map(|hold| LocalBias::none(holds[hold].temperature_c)),
            },
            used: self.obstacle(span).is_none(),
            counts: true,
        };
        spans.iter().enumerate().map(rotation).collect()
    }

    /// Why a span cannot be integrated; nothing where it can.
    pub(super) fn obstacle(&self, span: &Span) -> Option<String> {
        let times = &self.gyroscope.times_s;
        if !span.covered {
            return Some(match (times.first(), times.last()) {
                (Some(begin), _) if *begin > span.start_s + MARGIN_S => {
                    format!("the gyroscope's recording begins only at {begin:.1} s")
                }
                (_, Some(end)) => format!("the gyroscope's recording ends at {end:.1} s"),
                _ => "the gyroscope's recording does not cover it".into(),
            });
        }
        let longest = times[span.samples.clone()].windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max);
        if longest > self.gap_s {
            return Some(format!("the gyroscope pauses for {longest:.3} s in it"));
        }
        if span.samples.len() < 3 {
            return Some("the gyroscope has too few samples in it".into());
        }
        self.saturation(&span.samples)
    }

    /// Which sensor stops at the end of its range in these samples so that they cannot be integrated, in words.
    fn saturation(&self, span: &Range<usize>) -> Option<String> {
        let readings = &self.gyroscope.readings[span.clone()];
        if let Some(end) = self.saturations.iter().find(|end| end.is_reached(readings)) {
            return Some(format!("axis {} of the gyroscope saturates in it", end.axis));
        }
        let (accelerometer, ends) = self.felt.as_ref()?;
        let times = &self.gyroscope.times_s;
        let (start_s, end_s) = (times[span.start], times[span.end - 1]);
        let readings = &accelerometer.readings[accelerometer.between(start_s, end_s)];
        let brief = BRIEF_S * readings.len() as f64 / (end_s - start_s);
        let lasts = |end: &&Saturation| end.touches(readings) as f64 > brief;
        let end = ends.iter().find(lasts)?;
        Some(format!(
            "axis {} of the accelerometer saturates in it, so that the force that the gyroscope feels is not known",
            end.axis
        ))
    }
}

/// The turns of known angle, with the integrals of the readings.
pub(super) fn turns(
    problem: &ImuProblem<'_>,
    integrable: &Integrable<'_>,
    noise: &StillNoise,
    felt: Option<&[Vector3<f64>]>,
    still: (&ImuParameters, &Climate<'_>),
) -> Result<Vec<TurnData>> {
    problem
        .setup
        .turns
        .iter()
        .enumerate()
        .map(|(number, turn)| {
            let gyroscope = integrable.gyroscope;
            if let Some(before) = problem.setup.turns[..number].iter().position(|before| turn.repeats(before))
            {
                return Err(Error::experiment(Complaint::new(
                    format!(
                        "{} and {} are the same turn: it would count twice",
                        problem.setup.turns[before].named(before),
                        turn.named(number)
                    ),
                    "give each turn once, in gyroscope.turns or in the list of sections",
                )));
            }
            let Range { start: first, end } = gyroscope.between(turn.start_s, turn.end_s);
            if end < first + 3 {
                return Err(Error::recording(Complaint::new(
                    format!("{} has {} samples of the gyroscope", turn.named(number), end - first),
                    "correct the times of the turns",
                )));
            }
            if let Some(saturation) = integrable.saturation(&(first..end)) {
                return Err(Error::recording(Complaint::new(
                    format!("{} cannot be integrated: {saturation}", turn.named(number)),
                    "turn more slowly, record with a larger range, or take this turn out",
                )));
            }
            let (times, readings) = (&gyroscope.times_s[first..end], &gyroscope.readings[first..end]);
            let (mut integral, mut variance, mut force) =
                (Vector3::zeros(), Vector3::zeros(), Vector3::zeros());
            for k in 0..times.len() {
                let before = if k > 0 { times[k] - times[k - 1] } else { 0.0 };
                let after = if k + 1 < times.len() { times[k + 1] - times[k] } else { 0.0 };
                let weight = 0.5 * (before + after);
                integral += readings[k] * weight;
                force += felt.map_or_else(Vector3::zeros, |felt| felt[first + k]) * weight;
                variance += noise.of_sample.component_mul(&noise.of_sample) * (weight * weight);
            }
            let duration_s = times[times.len() - 1] - times[0];
            // an axis that hardly turns reads as in a hold
            variance += noise.of_mean * (duration_s * duration_s);
            // the gain, roughly: what the readings add up to beyond their bias, over the angle
            let temperature_c = still.1.mean(turn.start_s, turn.end_s);
            let bias = still.0.at(temperature_c).gyroscope.bias * duration_s;
            let gain = (integral - bias).norm() / turn.angle_rad.abs();
            let along = (integral - bias).try_normalize(0.0).unwrap_or_default().map(|share| share * share);
            let across = (Vector3::repeat(1.0) - along) * turn.angle_rad.powi(2);
            variance += (along + across) * (gain * turn.angle_sd_rad).powi(2);
            Ok(TurnData {
                integral,
                duration_s,
                force,
                angle: turn.axis * turn.angle_rad,
                weight: variance.map(|variance| 1.0 / variance.max(f64::MIN_POSITIVE)),
                temperature_c,
            })
        })
        .collect()
}
