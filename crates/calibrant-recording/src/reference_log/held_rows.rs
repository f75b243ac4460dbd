//! Rows that repeat the one before although the machine moves: the writer was faster than what it logs, and held its last
//! values, or a tracker lost the body, and its bridge went on with the last pose.

use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::log::RowsHeld;
use calibrant_machine::log::{ReferenceLog, step_of};

/// Rows in a row at most: more is a rest, unless the motion goes on with a jump.
const LONGEST: usize = 8;
/// What was not seen is caught up in one row, this many times farther than the rows behind it move. What rested starts slowly.
const JUMP: f64 = 3.0;
const BEHIND: usize = 3;
/// A motion changes a value from row to row by this number of its steps at least: less may round to none.
const STEPS: f64 = 3.0;
/// Share of the rows from which on it is no chance.
const SHARE: f64 = 0.01;

/// Leaves out the rows that are held.
pub(super) fn leave_out_held(log: &mut ReferenceLog) -> Option<Diagnostic> {
    let held = held(&values(log));
    let count = held.iter().filter(|held| **held).count();
    if (count as f64) < SHARE * held.len() as f64 || count == 0 {
        return None;
    }
    match log {
        ReferenceLog::Joints(log) => {
            let width = log.names.len();
            for values in std::iter::once(&mut log.positions).chain(&mut log.velocities) {
                let kept = values.chunks_exact(width).zip(&held).filter(|(_, held)| !**held);
                *values = kept.flat_map(|(row, _)| row).copied().collect();
            }
            keep(&mut log.times_s, &held);
        }
        ReferenceLog::Poses(log) => {
            keep(&mut log.times_s, &held);
            keep(&mut log.positions_m, &held);
            keep(&mut log.world_from_body, &held);
        }
    }
    Some(RowsHeld { rows: count, share: count as f64 / held.len() as f64 }.into())
}

fn keep<T>(values: &mut Vec<T>, held: &[bool]) {
    let mut held = held.iter();
    values.retain(|_| held.next() != Some(&true));
}

/// The values of each row.
fn values(log: &ReferenceLog) -> Vec<Vec<f64>> {
    match log {
        ReferenceLog::Joints(log) => (0..log.times_s.len()).map(|k| log.row(k).to_vec()).collect(),
        ReferenceLog::Poses(log) => (log.positions_m.iter().zip(&log.world_from_body))
            .map(|(position, turned)| {
                let position = position.map_or([f64::NAN; 3], Into::into);
                let turned = turned.map_or([f64::NAN; 4], |of| of.coords.into());
                position.into_iter().chain(turned).collect()
            })
            .collect(),
    }
}

/// Is each row between two changes of the motion, and the same as the one before?
fn held(rows: &[Vec<f64>]) -> Vec<bool> {
    let width = rows.first().map_or(0, Vec::len);
    let steps: Vec<f64> = (0..width).map(|j| step_of(rows.iter().map(|row| row[j]))).collect();
    // the change to each row from the one before, in steps; a value that is not rounded never repeats by chance
    let change = |pair: &[Vec<f64>]| {
        let of = |j: usize| (pair[1][j] - pair[0][j]).abs();
        let in_steps = |j: usize| if of(j) > 0.0 { of(j) / steps[j] } else { 0.0 };
        (0..width).map(in_steps).fold(0.0, f64::max)
    };
    let changes: Vec<f64> = rows.windows(2).map(change).collect();
    let distance = |k: usize| rows[k].iter().zip(&rows[k + 1]).map(|(one, next)| (next - one).powi(2)).sum();
    let distances: Vec<f64> = (0..changes.len()).map(distance).map(f64::sqrt).collect();
    let mut held = vec![false; rows.len()];
    let (mut long, mut jumps, mut start) = (Vec::new(), 0, 0);
    while start < changes.len() {
        let end = (start..changes.len()).find(|k| changes[*k] > 0.0).unwrap_or(changes.len());
        let is_between = start > 0 && end < changes.len() && changes[start - 1].min(changes[end]) >= STEPS;
        let is_whole = rows[start].iter().all(|value| value.is_finite());
        if end > start && is_between && is_whole {
            if end - start <= LONGEST {
                held[start + 1..=end].fill(true);
            } else {
                let behind = distances[end + 1..].iter().take(BEHIND).copied().fold(0.0, f64::max);
                jumps += usize::from(distances[end] > JUMP * behind);
                long.push(start + 1..=end);
            }
        }
        start = end + 1;
    }
    // a motion that turns back is not far from where it was lost
    if 2 * jumps > long.len() {
        long.into_iter().for_each(|rows| held[rows].fill(true));
    }
    held
}

#[cfg(test)]
mod tests {
    use super::super::options::ReferenceLogOptions;
    use super::super::read::parse_reference_log;

    /// A sine at 100 Hz whose values a writer holds for this number of rows, in steps; at rest in the last third.
    fn rows(held: i32, step: f64) -> (usize, usize) {
        let at = |k: i32| (f64::from(k.min(400)) * 0.02).sin();
        let row = |k: i32| {
            let angle = (at(k / held * held) / step).round() * step;
            format!("{},{angle:.9}\n", f64::from(k) / 100.0)
        };
        let text = "t_s,elbow_rad\n".to_owned() + &(0..600).map(row).collect::<String>();
        let file = parse_reference_log(text.as_bytes(), &ReferenceLogOptions::default()).expect("a log");
        (file.log.times_s().len(), file.findings.len())
    }

    #[test]
    fn rows_that_hold_the_last_value_are_left_out_and_rests_are_kept() {
        let (left, findings) = rows(2, 1e-5);
        // 200 of the first 400 rows, but some at the turning points of the sine, where it moves by less than three steps
        assert!((400..=405).contains(&left) && findings == 1, "{left}");
        for step in [1e-9, 1e-3, 1e-2] {
            assert_eq!(rows(1, step), (600, 0), "{step}");
        }
        // every thirty rows of a body that was lost for all but one of them
        assert_eq!(rows(30, 1e-5).1, 1);
    }
}
