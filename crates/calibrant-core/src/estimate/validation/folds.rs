//! Blocks of holds that are left out in turn.
//!
//! Blocks are contiguous, so that the rotations within a block are left out with it. Without a block, the other holds are given as intervals, and the gyroscope's
//! samples from the hold before it to the hold after it are cut out, so that no rotation leads across.

use super::result::FailedFold;
use crate::error::{Error, InputError, Refusal, Result};
use crate::motion::Hold;
use crate::sensor::Recording;
use std::ops::Range;

/// A block of the used holds, and what is left without it.
pub(super) struct Block {
    /// Places among the used holds.
    pub(super) places: Range<usize>,
    /// The other holds, (start, end) in s.
    pub(super) others: Vec<(f64, f64)>,
    /// From the hold before to the hold after, s.
    pub(super) span_s: (f64, f64),
}

/// So many blocks of nearly equal length.
pub(super) fn blocks(holds: &[&Hold], folds: usize) -> Result<Vec<Block>> {
    let count = holds.len();
    if folds < 2 || folds > count {
        return Err(Error::experiment(InputError::new(
            Refusal::ValidationImpossible,
            format!("{folds} folds cannot be made of {count} used holds"),
            format!("choose between 2 and {count}"),
        )));
    }
    let block = |number: usize| {
        let places = number * count / folds..(number + 1) * count / folds;
        let others = (0..count).filter(|place| !places.contains(place));
        Block {
            others: others.map(|place| (holds[place].start_s, holds[place].end_s)).collect(),
            span_s: (
                places.start.checked_sub(1).map_or(f64::NEG_INFINITY, |before| holds[before].end_s),
                holds.get(places.end).map_or(f64::INFINITY, |after| after.start_s),
            ),
            places,
        }
    };
    Ok((0..folds).map(block).collect())
}

impl Block {
    /// Does any of this stretch lie within what is cut out?
    pub(super) fn touches(&self, start_s: f64, end_s: f64) -> bool {
        start_s < self.span_s.1 && end_s > self.span_s.0
    }

    /// A recording without the block.
    pub(super) fn cut(&self, recording: &Recording) -> Recording {
        let kept = |t: f64| t <= self.span_s.0 || t >= self.span_s.1;
        let pairs = recording.times_s.iter().zip(&recording.readings).filter(|(t, _)| kept(**t));
        let (times_s, readings) = pairs.map(|(t, reading)| (*t, *reading)).unzip();
        Recording { times_s, readings, axes: recording.axes, unit: recording.unit }
    }
}

/// What came of the blocks, those apart that nothing came of. `numbers`: the numbers of the used holds.
pub(super) fn sorted<T>(
    blocks: &[Block],
    numbers: &[usize],
    outcomes: Vec<Result<T>>,
) -> Result<(Vec<T>, Vec<FailedFold>)> {
    let (mut done, mut failed) = (Vec::new(), Vec::new());
    for (block, outcome) in blocks.iter().zip(outcomes) {
        match outcome {
            Ok(errors) => done.push(errors),
            Err(error) => {
                let holds = (numbers[block.places.start], numbers[block.places.end - 1]);
                failed.push(FailedFold { holds, reason: error.to_string() });
            }
        }
    }
    match failed.first() {
        Some(first) if done.is_empty() => Err(Error::recording(InputError::new(
            Refusal::ValidationImpossible,
            format!(
                "none of the {} folds can be predicted from the others; without holds {} to {}: {}",
                blocks.len(),
                first.holds.0 + 1,
                first.holds.1 + 1,
                first.reason
            ),
            "use more folds, each then leaves out less; or record more holds",
        ))),
        _ => Ok((done, failed)),
    }
}
