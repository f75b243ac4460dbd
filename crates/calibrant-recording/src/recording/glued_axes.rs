//! Axes that keep their reading while the others move, and axes with the same reading: a loose wire, or a column that is there twice.

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::reader::{AxesEqual, AxisStuck, Span};
use calibrant_core::sensor::{Axis, Recording};
use nalgebra::Vector3;
use std::ops::Range;

/// A shorter stretch may be chance, s and samples.
const LONG_S: f64 = 0.5;
const LONG_SAMPLES: usize = 20;

/// An axis that repeats its reading this often has coarse readings, as a share of the samples.
const COARSE: f64 = 0.1;

/// Meanwhile a reading changes by this share of its range in the recording: coarse readings at rest stay the same, too.
const MOVES: f64 = 0.1;

/// What there is of a recording of three axes, each with its first sample.
pub(super) fn glued_axes(recording: &Recording) -> Vec<(Diagnostic, usize)> {
    let (readings, times_s) = (recording.readings(), recording.times_s());
    let [low, high] = recording.extremes();
    let moves = |axis: Axis, part: &Range<usize>| {
        let k = axis.index();
        let (least, most) = readings[part.clone()]
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), y| (least.min(y[k]), most.max(y[k])));
        most - least > MOVES * (high[k] - low[k])
    };
    let times = |part: &Range<usize>| Span { start_s: times_s[part.start], end_s: times_s[part.end - 1] };
    let is_long =
        |part: &Range<usize>| part.len() >= LONG_SAMPLES && times(part).end_s - times(part).start_s >= LONG_S;
    let mut found = Vec::new();
    if recording.axes() != 3 || readings.is_empty() {
        return found;
    }
    for axis in Axis::ALL.into_iter().filter(|axis| recording.constant(*axis).is_none()) {
        let k = axis.index();
        let (part, repeats) = longest(readings, |before, y| before[k] == y[k]);
        let is_coarse = (repeats - part.len()) as f64 > COARSE * (readings.len() - part.len()) as f64;
        let value = readings[part.start][k];
        let is_clipped = value <= low[k] || value >= high[k];
        let others_move = Axis::ALL.into_iter().any(|other| other != axis && moves(other, &part));
        if is_long(&part) && others_move && !is_clipped && !is_coarse {
            found.push((AxisStuck { axis, value, times: Some(times(&part)) }.into(), part.start));
        }
    }
    for (one, other) in [(Axis::X, Axis::Y), (Axis::X, Axis::Z), (Axis::Y, Axis::Z)] {
        let is_same = |y: &Vector3<f64>| y[one.index()] == y[other.index()];
        let (part, same) = longest(readings, |before, y| is_same(before) && is_same(y));
        let is_coarse = (same - part.len()) as f64 > COARSE * (readings.len() - part.len()) as f64;
        if is_long(&part) && moves(one, &part) && !is_coarse {
            let times = (part.len() < readings.len()).then(|| times(&part));
            found.push((AxesEqual { one, other, times }.into(), part.start));
        }
    }
    found
}

/// The longest stretch of samples each of which stays so from the one before, and the number of those that do, with one more.
fn longest(
    readings: &[Vector3<f64>],
    stays: impl Fn(&Vector3<f64>, &Vector3<f64>) -> bool,
) -> (Range<usize>, usize) {
    let (mut longest, mut first, mut all) = (0..1, 0, 1);
    for (before, [one, next]) in readings.array_windows().enumerate() {
        if !stays(one, next) {
            first = before + 1;
            continue;
        }
        all += 1;
        if before + 2 - first > longest.len() {
            longest = first..before + 2;
        }
    }
    (longest, all)
}
