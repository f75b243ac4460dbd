//! A check for a lost sign: negative readings that were written as positive ones, as two's complement.

use crate::text::decoding::{Checked, refuse};
use calibrant_core::error::Refusal;
use calibrant_core::sensor::{Axis, ReadingUnit, Recording};

/// Widths of a converter's words, bits.
const WIDTHS: [u32; 8] = [8, 10, 12, 14, 16, 18, 20, 24];
/// Readings around zero come within this share of both ends of the range.
const ENDS: f64 = 1.0 / 64.0;
/// Fewer than this share of them are in the middle quarter, which stands for readings beyond 3/4 of the
/// sensor's range.
const IN_THE_MIDDLE: f64 = 1e-3;
/// At least this share of them is on either side.
const ON_A_SIDE: f64 = 0.01;

/// Refuses counts that jump from 0 to the largest number of this many bits. `of` goes before the word axis,
/// as in `gyroscope axis x`.
pub(super) fn check(recording: &Recording, of: &str) -> Checked<()> {
    if recording.unit() != ReadingUnit::Counts {
        return Ok(());
    }
    let [least, most] = recording.extremes();
    for &axis in recording.active_axes() {
        let (least, most) = (least[axis.index()], most[axis.index()]);
        let Some(bits) = WIDTHS.into_iter().find(|bits| most < f64::from(1_u32 << bits)) else { continue };
        let range = f64::from(1_u32 << bits);
        let reaches_both_ends = least >= 0.0 && least < ENDS * range && most >= (1.0 - ENDS) * range;
        if reaches_both_ends && is_split(recording, axis, range) {
            let message = format!(
                "{of}axis {axis} reads from {least} to {most} counts, but hardly anything in the middle: negative numbers of {bits} bits were written as positive ones"
            );
            let help = format!("subtract {range} from each reading of {} or more", 0.5 * range);
            return refuse(Refusal::SignLost, message, help);
        }
    }
    Ok(())
}

/// Are the readings of an axis, whole numbers, at both ends of the range and not between?
fn is_split(recording: &Recording, axis: Axis, range: f64) -> bool {
    let readings = || recording.readings().iter().map(|reading| reading[axis.index()]);
    let share =
        |is: &dyn Fn(f64) -> bool| readings().filter(|y| is(*y)).count() as f64 / recording.len() as f64;
    readings().all(|y| y.fract() == 0.0)
        && share(&|y| (0.375..0.625).contains(&(y / range))) < IN_THE_MIDDLE
        && share(&|y| y < 0.375 * range) > ON_A_SIDE
        && share(&|y| y > 0.625 * range) > ON_A_SIDE
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    /// Held along ±x in turn, and moved through everything between. 1 g is 16 384 counts of 16 bits, or 2 048
    /// of a range that begins at 0.
    fn recording(of: impl Fn(f64) -> f64) -> Recording {
        let at = |k: usize| (k as f64 * 1e-3).sin() * 17_000.0;
        let times_s = (0..20_000).map(|k| k as f64 * 0.01).collect();
        let readings = (0..20_000).map(|k| Vector3::new(of(at(k)), 5.0, 20.0)).collect();
        Recording::new(times_s, readings, 3, ReadingUnit::Counts).expect("samples in order")
    }

    #[test]
    fn lost_signs_are_named_and_other_counts_are_not() {
        let wrapped = recording(|y| y.round().rem_euclid(65_536.0));
        let stated = check(&wrapped, "gyroscope ").expect_err("refused").to_string();
        assert!(
            stated.contains("gyroscope axis x") && stated.contains("16 bits") && stated.contains("32768"),
            "{stated}"
        );
        assert!(check(&recording(f64::round), "").is_ok(), "signed");
        assert!(check(&recording(|y| (y + 32_768.0).round()), "").is_ok(), "zero in the middle");
        // from one end of the range to the other, as a saturated sensor
        assert!(check(&recording(|y| (2.0 * y + 32_768.0).round().clamp(0.0, 65_535.0)), "").is_ok());
        let in_si = wrapped.mapped(ReadingUnit::MetrePerSecondSquared, |reading| *reading);
        assert!(check(&in_si, "").is_ok());
    }
}
