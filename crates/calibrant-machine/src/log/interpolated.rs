//! Poses that are an interpolation of a slower stream, and the samples of that stream.
//!
//! Some programs interpolate the poses of a tracker to the times of another sensor. Straight lines between samples
//! have no acceleration, and corners between them that are no motion. What is between the samples of the tracker
//! is no measurement.

use super::piecewise_linear::{KnotFit, Knots, Nodes, fit, periods, rms, second_differences};
use super::reference_log::PoseLog;
use nalgebra::{UnitQuaternion, Vector3};
use std::ops::Range;

/// Samples in which the knots are sought.
const SOUGHT_IN: usize = 1024;
/// Fewest samples in which they are sought.
const FEWEST: usize = 200;
/// Samples of the first fit, and knots of it.
const FIRST_FIT: usize = 160;
const FIRST_KNOTS: f64 = 8.0;
/// Most knots for each sample: a log with longer gaps is not examined.
const MOST_KNOTS: f64 = 10.0;
/// Phases of the knots that are tried.
const PHASES: usize = 24;
/// Knots fit where the distance is below this share of the second differences,
const OF_SECOND_DIFFERENCES: f64 = 0.02;
/// and below this share of that with knots half a period later.
const OF_OTHER_PHASE: f64 = 0.25;
/// With fewer samples for each knot, vibration at one frequency may look as interpolated: the distance must be that of
/// rounding.
const FEW: f64 = 2.0;
/// Largest distance that rounding makes, in steps of the last decimal.
const OF_ROUNDING: f64 = 0.6;
/// Steps may differ from the usual one by this share.
const EVEN: f64 = 1e-3;
/// Information of a node, in samples at it, below which it is not determined.
const LEAST_INFORMATION: f64 = 0.02;
/// A clock is compared with a whole number of hertz that is as near as this.
const OF_NOMINAL: f64 = 1e-3;
/// Iterations of the fit of orientations.
const TURNS: usize = 3;

/// A slower stream of poses, recovered from its interpolation.
#[derive(Debug, Clone, PartialEq)]
pub struct RecoveredStream {
    /// Its samples, at even times. `None` where the stream had none, or none can be recovered.
    pub log: PoseLog,
    /// Time from sample to sample by the clock of the interpolated log, s.
    pub period_s: f64,
    /// Standard deviation of the period, s.
    pub period_sd_s: f64,
    /// Time of the first sample, s.
    pub first_s: f64,
    /// Root mean square of the distance between logged and interpolated positions, m.
    pub rms_m: f64,
    /// The same of the angle between orientations, where there are any, rad.
    pub rms_rad: Option<f64>,
}

impl RecoveredStream {
    /// Rate of the stream by the clock of the interpolated log, Hz.
    #[must_use]
    pub fn rate_hz(&self) -> f64 {
        1.0 / self.period_s
    }

    /// The rate that the stream has by its own clock, where a whole number of hertz is that near, and how much faster
    /// that clock is, in parts of 1.
    #[must_use]
    pub fn clock(&self) -> Option<(f64, f64)> {
        let nominal_hz = self.rate_hz().round();
        let faster = self.rate_hz() / nominal_hz - 1.0;
        (nominal_hz > 0.0 && faster.abs() < OF_NOMINAL).then_some((nominal_hz, faster))
    }
}

/// The positions that were seen, each time once.
struct Seen {
    times_s: Vec<f64>,
    positions_m: Vec<Vector3<f64>>,
}

/// Finds the slower stream whose linear interpolation a log is. `None` for a log that is none: noise, rest, a motion
/// that was sampled as it is logged.
///
/// The time grows as the length of the log does.
///
/// # Examples
/// ```
/// use calibrant_machine::log::{PoseLog, recover_interpolated};
/// use nalgebra::Vector3;
///
/// let place = |t: f64| Vector3::new((7.0 * t).sin(), (5.0 * t).cos(), 0.3 * (9.0 * t).sin());
/// let interpolated = |t: f64| {
///     let before = (t * 100.0).floor();
///     let share = t * 100.0 - before;
///     place(before / 100.0) * (1.0 - share) + place((before + 1.0) / 100.0) * share
/// };
/// let times_s: Vec<f64> = (0..2000).map(|k| k as f64 / 273.0).collect();
/// let log = |position: &dyn Fn(f64) -> Vector3<f64>| PoseLog {
///     positions_m: times_s.iter().map(|t| Some(position(*t))).collect(),
///     world_from_body: vec![None; times_s.len()],
///     times_s: times_s.clone(),
/// };
/// let stream = recover_interpolated(&log(&interpolated)).expect("interpolated");
/// assert!((stream.period_s - 0.01).abs() < 1e-8);
/// assert_eq!(recover_interpolated(&log(&place)), None);
/// ```
#[must_use]
pub fn recover_interpolated(log: &PoseLog) -> Option<RecoveredStream> {
    let seen = Seen::of(log);
    let found = seen.find_knots()?;
    let knots = found.knots;
    let nodes = Nodes::of(&seen.times_s, &knots);
    let positions = nodes.solve(seen.positions_m.iter().copied());
    let position_at = |place: usize, is_known: bool| is_known.then(|| positions[place]);
    let is_known = |nodes: &Nodes| {
        nodes.information().into_iter().map(|information| information > LEAST_INFORMATION).collect::<Vec<_>>()
    };
    let known = is_known(&nodes);
    // the first and the last node lie outside the log, unless a sample is at them
    let first = known.iter().position(|known| *known)?;
    let last = known.iter().rposition(|known| *known)?;
    let turned = orientations(log, &knots);
    let numbers: Vec<i64> = (first..=last).map(|node| nodes.first + node as i64).collect();
    let log = PoseLog {
        times_s: numbers.iter().map(|&number| knots.at(number)).collect(),
        positions_m: (first..=last).map(|node| position_at(node, known[node])).collect(),
        world_from_body: numbers
            .iter()
            .map(|number| {
                let turned = turned.as_ref()?;
                let node = usize::try_from(number - turned.first).ok()?;
                turned.nodes.get(node).copied().flatten()
            })
            .collect(),
    };
    Some(RecoveredStream {
        first_s: log.times_s[0],
        log,
        period_s: knots.period_s,
        period_sd_s: found.period_sd_s,
        rms_m: found.rms,
        rms_rad: turned.map(|turned| turned.rms_rad),
    })
}

impl Seen {
    fn of(log: &PoseLog) -> Self {
        let mut seen = Self { times_s: Vec::new(), positions_m: Vec::new() };
        for (&t, position) in log.times_s.iter().zip(&log.positions_m) {
            if let Some(position) = position.filter(|_| seen.times_s.last() != Some(&t)) {
                seen.times_s.push(t);
                seen.positions_m.push(position);
            }
        }
        seen
    }

    /// The knots, fitted to all samples; `None` where no knots fit.
    fn find_knots(&self) -> Option<KnotFit> {
        let part = self.most_moving()?;
        let periods = periods(&self.positions_m[part.clone()]).into_iter();
        let (mut part, mut found) = periods.into_iter().find_map(|period| self.first_fit(&part, period))?;
        while part.len() < self.times_s.len() {
            // twice as long, around the same middle
            part = part.start.saturating_sub(part.len() / 2)
                ..(part.end + part.len() / 2).min(self.times_s.len());
            found = fit(&self.times_s[part.clone()], &self.positions_m[part.clone()], &found.knots);
            if !self.fits(&part, &found) {
                return None;
            }
        }
        Some(found)
    }

    /// Knots that fit in the middle of an even part, and are about this number of samples apart.
    fn first_fit(&self, even: &Range<usize>, period: f64) -> Option<(Range<usize>, KnotFit)> {
        let middle = usize::midpoint(even.start, even.end);
        let half = (FIRST_FIT.max((FIRST_KNOTS * period) as usize) / 2).min(even.len() / 2);
        let part = middle - half..middle + half;
        let period_s = period * self.step_s(even);
        let (times_s, positions) = (&self.times_s[part.clone()], &self.positions_m[part.clone()]);
        if self.times_s[self.times_s.len() - 1] - self.times_s[0]
            > MOST_KNOTS * period_s * self.times_s.len() as f64
        {
            return None;
        }
        let middle_s = times_s[half];
        let start = (0..PHASES)
            .map(|phase| Knots { reference_s: middle_s + period_s * phase as f64 / PHASES as f64, period_s })
            .map(|knots| (rms(times_s, positions, &knots), knots))
            .min_by(|one, other| one.0.total_cmp(&other.0))?;
        let found = fit(times_s, positions, &start.1);
        let sizes = second_differences(positions);
        let size = (sizes.iter().map(|size| size * size).sum::<f64>() / sizes.len() as f64).sqrt();
        (found.rms < OF_SECOND_DIFFERENCES * size && self.fits(&part, &found)).then_some((part, found))
    }

    /// Do the knots fit better than others of the same period? Few samples for each have to fit to the last decimal.
    fn fits(&self, part: &Range<usize>, found: &KnotFit) -> bool {
        let is_few = found.knots.period_s < FEW * self.step_s(part);
        if is_few && found.rms > OF_ROUNDING * last_decimal(&self.positions_m[part.clone()]) {
            return false;
        }
        let (times_s, positions) = (&self.times_s[part.clone()], &self.positions_m[part.clone()]);
        let other = rms(times_s, positions, &found.knots.shifted(0.5 * found.knots.period_s));
        found.rms < OF_OTHER_PHASE * other
    }

    /// The part with even times in which the body moves most.
    fn most_moving(&self) -> Option<Range<usize>> {
        let length = SOUGHT_IN.min(self.times_s.len());
        if length < FEWEST {
            return None;
        }
        let parts = (0..=self.times_s.len() - length).step_by(length / 2).map(|start| start..start + length);
        let moved = |part: &Range<usize>| {
            let mut sizes = second_differences(&self.positions_m[part.clone()]);
            let middle = sizes.len() / 2;
            *sizes.select_nth_unstable_by(middle, f64::total_cmp).1
        };
        let is_even = |part: &Range<usize>| {
            let step_s = self.step_s(part);
            self.times_s[part.clone()]
                .array_windows()
                .all(|[one, next]| ((next - one) / step_s - 1.0).abs() < EVEN)
        };
        parts
            .filter(is_even)
            .map(|part| (moved(&part), part))
            .max_by(|one, other| one.0.total_cmp(&other.0))
            .map(|(_, part)| part)
    }

    /// Mean time from sample to sample, s.
    fn step_s(&self, part: &Range<usize>) -> f64 {
        (self.times_s[part.end - 1] - self.times_s[part.start]) / (part.len() - 1) as f64
    }
}

/// The step of the last decimal in which values are given.
fn last_decimal(values: &[Vector3<f64>]) -> f64 {
    /// More decimals are not looked for.
    const MOST: i32 = 12;
    let is_whole = |scale: f64| {
        let rest = |value: f64| (value * scale - (value * scale).round()).abs();
        values.iter().all(|value| value.iter().all(|value| rest(*value) < 1e-3))
    };
    (0..MOST)
        .map(|decimals| 10.0_f64.powi(decimals))
        .find(|scale| is_whole(*scale))
        .unwrap_or(10.0_f64.powi(MOST))
        .recip()
}

/// Orientations at knots.
struct Turned {
    /// Number of the first node.
    first: i64,
    nodes: Vec<Option<UnitQuaternion<f64>>>,
    rms_rad: f64,
}

/// The orientations at the knots, by least squares of the angles from the logged ones to a turn at a constant rate
/// from knot to knot.
fn orientations(log: &PoseLog, knots: &Knots) -> Option<Turned> {
    let seen = log.times_s.iter().zip(&log.world_from_body);
    let (times_s, logged): (Vec<f64>, Vec<UnitQuaternion<f64>>) =
        seen.filter_map(|(&t, orientation)| Some((t, (*orientation)?))).unzip();
    let span_s = times_s.last()? - times_s.first()?;
    if span_s > MOST_KNOTS * knots.period_s * times_s.len() as f64 {
        return None;
    }
    let nodes = Nodes::of(&times_s, knots);
    // begin with the nearest one that was logged
    let mut turned = vec![None; nodes.len()];
    for (k, orientation) in logged.iter().enumerate() {
        let (node, weight) = nodes.place(k);
        for (node, away) in [(node, weight), (node + 1, 1.0 - weight)] {
            if turned[node].is_none_or(|(nearest, _)| away < nearest) {
                turned[node] = Some((away, *orientation));
            }
        }
    }
    let known: Vec<bool> =
        nodes.information().into_iter().map(|information| information > LEAST_INFORMATION).collect();
    let mut turned: Vec<UnitQuaternion<f64>> = turned
        .into_iter()
        .map(|turned| turned.map_or_else(UnitQuaternion::identity, |(_, orientation)| orientation))
        .collect();
    let errors = |turned: &[UnitQuaternion<f64>]| -> Vec<Vector3<f64>> {
        let error = |(k, logged): (usize, &UnitQuaternion<f64>)| {
            let (node, weight) = nodes.place(k);
            let between = (turned[node].inverse() * turned[node + 1]).scaled_axis() * weight;
            let expected = turned[node] * UnitQuaternion::from_scaled_axis(between);
            // in the world: what both nodes turn by moves what is between them likewise
            (logged * expected.inverse()).scaled_axis()
        };
        logged.iter().enumerate().map(error).collect()
    };
    for _ in 0..TURNS {
        let by = nodes.solve(errors(&turned).into_iter());
        for (orientation, by) in turned.iter_mut().zip(by) {
            *orientation = UnitQuaternion::from_scaled_axis(by) * *orientation;
        }
    }
    let squares: f64 = errors(&turned).iter().map(|error| error.norm_squared()).sum();
    Some(Turned {
        first: nodes.first,
        nodes: turned
            .into_iter()
            .zip(known)
            .map(|(orientation, known)| known.then_some(orientation))
            .collect(),
        rms_rad: (squares / times_s.len() as f64).sqrt(),
    })
}
