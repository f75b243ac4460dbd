//! Are two recordings one, of which one was smoothed: a moving average, a low-pass filter, means of so many samples?
//!
//! A moving average over three samples leaves differences of successive samples nothing in common with those before. Means over stretches longer than its window stay nearly what they were:
//! `u` and `v` are the differences of the means of successive stretches of a hold, at the same times in both recordings, and
//!
//! ```text
//! r(l) = Σ_k u_k·v_{k+l} / √(Σ|u_k|² Σ|v_{k+l}|²)
//! ```
//!
//! Noise has no memory of so long: it is in step at `l = 0` alone, in all of a hold. What a machine repeats at the same times is not: it settles in the beginning of a hold, so that the first
//! third does not count, and of the rest the half with the lesser `r(0)`; creep is a trend, which is taken out of each hold; a hum is as much in step at other shifts. What is far beyond the
//! usual is a movement, and left out.

use crate::motion::Hold;
use crate::sensor::Recording;
use nalgebra::Vector3;

/// Stretches begin with one sample of the slower recording, and are so many times doubled.
const DOUBLINGS: usize = 5;
/// With fewer differences nothing is said: 32 of one axis of white noise have an r of standard deviation 0.18.
const FEWEST_DIFFERENCES: usize = 32;
/// How far `r(0)` stands out above the root of the sum of its squares elsewhere where the noise is the same.
const STANDS_OUT: f64 = 0.4;
/// Shifts within a hold at which noise is not in step. That of neighbours is, as they share a stretch.
const SHIFTS: std::ops::RangeInclusive<usize> = 2..=6;
/// Up to this one they must be there: a hum may be a quarter of its period off at one of them.
const LARGEST_NEEDED_SHIFT: usize = 4;
/// Differences so many times their lower quartile are movements: five and a half standard deviations of three axes. Half of the time and more may be movements.
const MOVEMENT_FACTOR: f64 = 5.0;

/// Sum and number of the readings in a stretch of time, of both recordings.
type Sums = [(Vector3<f64>, f64); 2];
/// Differences of both, NaN where there are no readings.
type Pair = [Vector3<f64>; 2];

/// Correlation of the noise of means of two recordings in the holds of the first; `None` where it is none. `delay_s`: what the clock of the other shows less that of the one.
pub(super) fn slow_noise_in_common(
    one: &Recording,
    holds: &[Hold],
    other: &Recording,
    delay_s: f64,
) -> Option<f64> {
    let interval_s = one.rate_hz().min(other.rate_hz()).recip();
    let in_hold = |hold: &Hold| -> Vec<Sums> {
        let count = (hold.duration_s() / interval_s) as usize;
        // ends of stretches are between samples
        let start_s = hold.start_s - 0.5 * interval_s;
        let mut sums = vec![[(Vector3::zeros(), 0.0); 2]; count];
        for (of, (recording, start_s)) in [(one, start_s), (other, start_s + delay_s)].into_iter().enumerate()
        {
            for k in recording.between(start_s, start_s + count as f64 * interval_s) {
                let segment = ((recording.times_s[k] - start_s) / interval_s) as usize;
                if let Some(sums) = sums.get_mut(segment) {
                    sums[of] = (sums[of].0 + recording.readings[k], sums[of].1 + 1.0);
                }
            }
        }
        sums
    };
    let mut sums: Vec<Vec<Sums>> = holds.iter().map(in_hold).collect();
    let mut most: Option<f64> = None;
    for _ in 0..=DOUBLINGS {
        if let Some(found) = in_common(&sums) {
            most = Some(most.map_or(found, |most| most.max(found)));
        }
        sums.iter_mut().for_each(|sums| *sums = doubled(sums));
    }
    most
}

/// The sums of stretches twice as long.
fn doubled(sums: &[Sums]) -> Vec<Sums> {
    let both = |one: (Vector3<f64>, f64), next: (Vector3<f64>, f64)| (one.0 + next.0, one.1 + next.1);
    sums.chunks_exact(2).map(|pair| [0, 1].map(|of| both(pair[0][of], pair[1][of]))).collect()
}

fn in_common(sums: &[Vec<Sums>]) -> Option<f64> {
    let mean = |(sum, count): (Vector3<f64>, f64)| sum / count;
    let differences = |sums: &Vec<Sums>| -> Vec<Pair> {
        sums.windows(2).map(|pair| [0, 1].map(|of| mean(pair[1][of]) - mean(pair[0][of]))).collect()
    };
    let mut holds: Vec<Vec<Pair>> = sums.iter().map(differences).collect();
    for of in [0, 1] {
        leave_out_moves(&mut holds, of);
    }
    for hold in &mut holds {
        hold.drain(..hold.len().div_ceil(3));
        [0, 1].into_iter().for_each(|of| take_out_trend(hold, of));
    }
    let half = |late: bool| correlation(&holds, 0, &|k, n| (2 * k >= n) == late);
    let in_step = half(false)?.min(half(true)?);
    if in_step <= STANDS_OUT {
        return None;
    }
    let mut squares = 0.0;
    for shift in SHIFTS {
        match correlation(&holds, shift, &|_, _| true) {
            Some(r) => squares += r * r,
            None if shift <= LARGEST_NEEDED_SHIFT => return None,
            None => {}
        }
    }
    (in_step > STANDS_OUT + squares.sqrt()).then_some(in_step)
}

/// The differences of a trend are all the same.
fn take_out_trend(hold: &mut [Pair], of: usize) {
    let known = hold.iter().map(|pair| pair[of]).filter(|value| value.iter().all(|y| y.is_finite()));
    let (sum, count) = known.fold((Vector3::zeros(), 0.0), |(sum, count), value| (sum + value, count + 1.0));
    hold.iter_mut().for_each(|pair| pair[of] -= sum / f64::max(count, 1.0));
}

/// Makes differences that are far beyond the usual NaN.
fn leave_out_moves(holds: &mut [Vec<Pair>], of: usize) {
    let sizes = holds.iter().flatten().map(|pair| pair[of].norm()).filter(|size| size.is_finite());
    let mut sizes: Vec<f64> = sizes.collect();
    if sizes.is_empty() {
        return;
    }
    let quarter = sizes.len() / 4;
    let (_, quartile, _) = sizes.select_nth_unstable_by(quarter, f64::total_cmp);
    let most = MOVEMENT_FACTOR * *quartile;
    let moves = |pair: &&mut Pair| pair[of].norm() > most;
    holds.iter_mut().flatten().filter(moves).for_each(|pair| pair[of].fill(f64::NAN));
}

/// `r(l)` over the differences number k of n in their hold that are asked for; `None` where too few have noise in both.
fn correlation(holds: &[Vec<Pair>], shift: usize, inside: &dyn Fn(usize, usize) -> bool) -> Option<f64> {
    let (mut product, mut powers, mut count) = (0.0, [0.0; 2], 0);
    for hold in holds {
        let shifted = hold.iter().zip(hold.iter().skip(shift)).enumerate();
        for (_, (here, there)) in shifted.filter(|(k, _)| inside(*k, hold.len())) {
            let (u, v) = (&here[0], &there[1]);
            let of_both = [u.norm_squared(), v.norm_squared()];
            if of_both.iter().all(|power| *power > 0.0) {
                product += u.dot(v);
                powers = [powers[0] + of_both[0], powers[1] + of_both[1]];
                count += 1;
            }
        }
    }
    (count >= FEWEST_DIFFERENCES).then(|| product / (powers[0] * powers[1]).sqrt())
}
