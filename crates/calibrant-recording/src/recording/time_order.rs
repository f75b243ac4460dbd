//! Rows that are not in the order of their times: a table that was written in parallel, messages that overtook each other. They are sorted where their times
//! can only be those of one clock.
//!
//! Times that go backwards may also be those of two recordings, one after the other, or of a clock that was set. Such rows must not be mixed. Sorted, the
//! times of one clock are even; and long runs of rows that are in order stand one behind the other, without a gap, and do not interleave.

/// Fewer rows are not judged.
const FEWEST: usize = 100;
/// Sorted steps are the usual one within this range, most of them.
const USUAL: std::ops::RangeInclusive<f64> = 0.45..=1.55;
/// One step in this number may be another.
const OTHER: usize = 5;
/// Rows in order from which on a run may be a recording.
const LONG: usize = 50;
/// Two long runs change places this often at most where they meet.
const MEETING: usize = 16;
/// A longer step between two long runs, in usual steps, is a gap.
const GAP: f64 = 5.0;
/// So few rows may stray, and a clock begins anew so often at most.
const FEW: usize = 3;
/// The first number of sorted steps lasts at least the second number of times what as many usual steps last. Where a clock was set back, rows stand twice as close.
const CLOSE: (usize, f64) = (8, 0.75);

/// How many come after a later one.
pub(crate) fn late<T: PartialOrd + Copy>(times: impl Iterator<Item = T>) -> usize {
    let mut latest = None;
    let is_late = |time: &T| {
        let is_late = latest.is_some_and(|before| *time < before);
        latest = if is_late { latest } else { Some(*time) };
        is_late
    };
    times.filter(is_late).count()
}

/// The rows in the order of their times.
pub(crate) fn sorted_rows(times: &[f64]) -> Vec<usize> {
    let mut rows: Vec<usize> = (0..times.len()).collect();
    rows.sort_by(|&one, &next| times[one].total_cmp(&times[next]));
    rows
}

/// Are these the times of one clock, but not in order? None is NaN.
pub(crate) fn is_clock_out_of_order(times: &[f64]) -> bool {
    if times.len() < FEWEST || times.is_sorted() {
        return false;
    }
    let rows = sorted_rows(times);
    let steps: Vec<f64> = rows.array_windows().map(|&[one, next]| times[next] - times[one]).collect();
    let mut ranked = steps.clone();
    ranked.sort_by(f64::total_cmp);
    let usual = ranked[ranked.len() / 2];
    let others = steps.iter().filter(|step| !USUAL.contains(&(**step / usual))).count();
    let (close, share) = CLOSE;
    let is_close = |pair: &[usize]| times[pair[close]] - times[pair[0]] < share * close as f64 * usual;
    usual > 0.0
        && !strays(times, &rows)
        && OTHER * others <= steps.len()
        && !rows.windows(close + 1).any(is_close)
        && runs_stand_apart(times, &rows, GAP * usual)
}

/// Are all rows in order but a few, which belong far away? Their times are wrong.
fn strays(times: &[f64], sorted: &[usize]) -> bool {
    let early = late(times.iter().rev().map(|time| -time));
    let farthest = sorted.iter().enumerate().map(|(place, row)| place.abs_diff(*row)).max();
    late(times.iter().copied()).min(early) <= FEW && farthest.is_some_and(|rows| rows > LONG)
}

/// Do the long runs of rows in order stand one behind the other?
fn runs_stand_apart(times: &[f64], sorted: &[usize], gap: f64) -> bool {
    let back = |rows: &[usize]| times[rows[1]] - times[rows[0]] > gap && rows[1] < rows[0];
    let restarts = times.array_windows().filter(|[one, next]| next < one).count();
    // a clock that began anew: what came later stands before a gap
    if restarts <= FEW && sorted.windows(2).any(back) {
        return false;
    }
    // the run of each row; `None` in a short one
    let mut run_of: Vec<Option<usize>> = vec![None; times.len()];
    let (mut start, mut long) = (0, 0);
    for end in 1..=times.len() {
        if end < times.len() && times[end] >= times[end - 1] {
            continue;
        }
        if end - start >= LONG {
            run_of[start..end].fill(Some(long));
            long += 1;
        }
        start = end;
    }
    let in_long = sorted.iter().filter_map(|&row| Some((run_of[row]?, times[row]))).collect::<Vec<_>>();
    let mut changes = in_long.array_windows().filter(|[one, next]| one.0 != next.0).peekable();
    let has_gap = sorted.array_windows().any(|&[one, next]| {
        matches!((run_of[one], run_of[next]), (Some(of), Some(other)) if of != other)
            && times[next] - times[one] > gap
    });
    changes.peek().is_none() || !has_gap && changes.count() <= MEETING * long
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Even times with a little jitter.
    fn times(rows: usize) -> Vec<f64> {
        (0..rows).map(|k| 1e3 + 0.01 * (k as f64 + 0.2 * (k as f64 * 1.7).sin())).collect()
    }

    #[test]
    fn the_times_of_one_clock_are_seen_in_any_order() {
        let even = times(1000);
        assert!(!is_clock_out_of_order(&even), "in order");
        let backwards: Vec<f64> = even.iter().rev().copied().collect();
        // chunks of 100 that overlap by eight, the last first
        let chunk = |k: usize| {
            let from = 100 * k;
            (from..from + 92)
                .chain((from + 92..from + 100).step_by(2))
                .chain((from.saturating_sub(8)..from).filter(move |row| row % 2 == 1 && from > 0))
        };
        let chunks: Vec<f64> = (0..10).rev().flat_map(chunk).map(|row| even[row]).collect();
        let mut near = even.clone();
        near.chunks_exact_mut(8).for_each(|eight| eight.rotate_left(3));
        for (what, times) in [("backwards", backwards), ("chunks", chunks), ("near", near)] {
            assert!(is_clock_out_of_order(&times), "{what}");
        }
    }

    #[test]
    fn two_recordings_a_clock_that_was_set_and_other_values_are_not_mixed() {
        let even = times(1000);
        let after = |later_s: f64| -> Vec<f64> {
            even.iter().copied().chain(even.iter().map(|t| t + later_s)).collect()
        };
        let halves = [0, 1].map(|half| even.iter().skip(half).step_by(2).copied());
        let set_back: Vec<f64> =
            even.iter().enumerate().map(|(k, t)| if k < 500 { *t } else { t - 0.105 }).collect();
        let temperature: Vec<f64> = (0..1000).map(|k| 20.0 + (f64::from(k) * 0.01).sin()).collect();
        for (what, times) in [
            ("the same times", after(0.0)),
            ("half a step later", after(0.005)),
            ("a pause between, the later one first", [&after(60.0)[1000..], &even].concat()),
            ("every second row, then the others", halves.into_iter().flatten().collect()),
            ("set back", set_back),
            ("begun anew", even[970..].iter().chain(&even[..900]).copied().collect()),
            ("a row astray", [&even[..500], &[even[0]], &even[500..]].concat()),
            ("a row of another time", [&even[..500], &[1e13], &even[500..]].concat()),
            ("no clock", temperature),
        ] {
            assert!(!is_clock_out_of_order(&times), "{what}");
        }
    }
}
