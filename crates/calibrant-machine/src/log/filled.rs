//! Positions that were filled in where markers were lost.
//!
//! A tracker that loses markers loses the orientation first. Programs then fill in the positions: by lines, splines or a model. These positions are smooth, and
//! wrong: they would hold the motion where it was not seen. Measured ones have noise. The difference of the fourth order of samples, divided by their times
//! (a divided difference), is 0 for cubic polynomials and shows the noise of any others.

use super::reference_log::PoseLog;
use nalgebra::Vector3;
use std::ops::Range;

/// Samples of a divided difference of the fourth order.
const WINDOW: usize = 5;
/// The noise of measured positions is at least this part of that of the others.
const MEASURED: f64 = 0.5;
/// Fewest differences that tell the noise.
const FEWEST: usize = 8;

/// Leaves out the positions between orientations that were not seen, unless their noise is that of the positions beside orientations. Returns how many are left
/// out.
///
/// # Examples
/// ```
/// use calibrant_machine::log::{PoseLog, leave_out_filled};
/// use nalgebra::{UnitQuaternion, Vector3};
/// let place = |k: usize| Vector3::new((0.1 * k as f64).sin(), 0.0, 1e-3 * ((k * k) as f64).sin());
/// let mut log = PoseLog {
///     times_s: (0..200).map(|k| 0.01 * k as f64).collect(),
///     positions_m: (0..200).map(|k| Some(place(k))).collect(),
///     world_from_body: vec![Some(UnitQuaternion::identity()); 200],
/// };
/// log.world_from_body[100..130].fill(None);
/// assert_eq!(leave_out_filled(&mut log), 0);
/// for k in 100..130 {
///     let share = (k - 99) as f64 / 31.0;
///     log.positions_m[k] = Some(place(99) * (1.0 - share) + place(130) * share);
/// }
/// assert_eq!(leave_out_filled(&mut log), 30);
/// ```
pub fn leave_out_filled(log: &mut PoseLog) -> usize {
    let doubted = without_orientation(log);
    if doubted.is_empty() {
        return 0;
    }
    let whole = |k: usize| log.positions_m[k].is_some() && log.world_from_body[k].is_some();
    let rest = noise(log, (0..log.times_s.len()).filter(|k| whole(*k)));
    let is_measured = |part: &Range<usize>| {
        let own = noise(log, part.clone());
        own.zip(rest).is_some_and(|(own, rest)| own > MEASURED * rest)
    };
    let (measured, filled): (Vec<_>, Vec<_>) =
        doubted.into_iter().partition(|part| part.len() >= WINDOW + FEWEST && is_measured(part));
    // a gap that is too short to tell is as the others are
    let (short, long): (Vec<_>, Vec<_>) = filled.into_iter().partition(|part| part.len() < WINDOW + FEWEST);
    let short = if long.is_empty() && !measured.is_empty() { Vec::new() } else { short };
    let mut left_out = 0;
    for part in long.into_iter().chain(short) {
        left_out += part.len();
        log.positions_m[part].fill(None);
    }
    left_out
}

/// The runs of positions without an orientation, with orientations before and behind them.
fn without_orientation(log: &PoseLog) -> Vec<Range<usize>> {
    let seen: Vec<usize> = (0..log.times_s.len()).filter(|k| log.world_from_body[*k].is_some()).collect();
    let mut runs = Vec::new();
    for pair in seen.windows(2) {
        for k in pair[0] + 1..pair[1] {
            match runs.last_mut() {
                _ if log.positions_m[k].is_none() => {}
                Some(Range { end, .. }) if *end == k => *end = k + 1,
                _ => runs.push(k..k + 1),
            }
        }
    }
    runs
}

/// The median size of the divided differences of rows that follow each other, in parts of that of noise of 1 m; `None` where they are too few.
fn noise(log: &PoseLog, rows: impl Iterator<Item = usize>) -> Option<f64> {
    let rows: Vec<usize> = rows.collect();
    let windows = rows.windows(WINDOW).filter(|of| of[WINDOW - 1] - of[0] == WINDOW - 1);
    let mut sizes: Vec<f64> = windows.flat_map(|of| difference(log, of[0])).flatten().collect();
    if sizes.len() < 3 * FEWEST {
        return None;
    }
    let middle = sizes.len() / 2;
    Some(*sizes.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The divided difference from this row on, of each axis.
fn difference(log: &PoseLog, first: usize) -> Option<[f64; 3]> {
    let times = &log.times_s[first..first + WINDOW];
    let (mut sum, mut squares) = (Vector3::zeros(), 0.0);
    for (k, time_s) in times.iter().enumerate() {
        let others = times.iter().enumerate().filter(|(other, _)| *other != k);
        let weight: f64 = others.map(|(_, other)| 1.0 / (time_s - other)).product();
        sum += log.positions_m[first + k]? * weight;
        squares += weight * weight;
    }
    let size = sum / squares.sqrt();
    size.iter().all(|of| of.is_finite()).then(|| size.abs().into())
}
