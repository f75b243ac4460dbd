//! Where in a recording a commanded motion begins: the delay by correlation, from which the fit begins.
//!
//! For each delay the readings of an axis are compared with the commanded acceleration by their correlation ρ. The likelihood of a delay is
//! `−(n/2) Σ ln(1 − ρ²)` over the axes, with the prior of the delay added: that tells the periods of a motion that repeats apart. An axis may be reversed,
//! but hardly ever is: half a period of a shuttle looks like it.

use super::{RecoveredClock, holds::median};
use crate::error::{Error, InputError, Refusal, Result};
use crate::motion::{CommandedMotion, Trust};
use crate::sensor::Recording;

/// Steps in the shortest interval of the motion.
const STEPS: f64 = 8.0;
/// Correlation below which recording and motion are of different motions.
const SAME_MOTION: f64 = 0.5;
/// Part of the shorter of motion and recording that both have in common.
const COMMON: f64 = 0.5;
/// Log-likelihood of a reversed axis.
const REVERSED: f64 = -10.0;
/// Fewest values that are correlated.
const FEWEST: usize = 8;

/// The clock before the fit: its delay as given, or where it is not exact by correlation; no rate.
///
/// # Errors
/// [`Error::Recording`] where the motion is not in the recording.
pub(super) fn aligned(
    recording: &Recording,
    command: &CommandedMotion,
    axes: usize,
) -> Result<RecoveredClock> {
    let given = command.clock;
    let tau = command.motion.times_s();
    let middle = 0.5 * (tau[0] + tau[tau.len() - 1]);
    let delay_s = if given.delay_sd_s > 0.0 && command.trust != Trust::Unknown {
        Correlation::new(recording, command, axes).delay_s()?
    } else {
        given.delay_s
    };
    Ok(RecoveredClock { given, delay_s, at_s: middle - delay_s, ..RecoveredClock::default() })
}

/// Readings and commanded acceleration, each step of time.
struct Correlation<'a> {
    command: &'a CommandedMotion,
    axes: usize,
    step_s: f64,
    first_s: f64,
    last_s: f64,
    /// The mean reading of each step of the recording.
    readings: Vec<Option<[f64; 3]>>,
}

/// How well readings and motion agree at a delay.
#[derive(Clone, Copy)]
struct Agreement {
    /// Log-likelihood, the prior of the delay among it.
    likelihood: f64,
    /// The largest correlation of an axis.
    correlation: f64,
}

impl<'a> Correlation<'a> {
    fn new(recording: &Recording, command: &'a CommandedMotion, axes: usize) -> Self {
        let times = &recording.times_s;
        let (first_s, last_s) = (times[0], times[times.len() - 1]);
        let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let shortest = (0..command.motion.intervals()).map(|i| command.motion.interval_s(i));
        let step_s = (shortest.fold(f64::INFINITY, f64::min) / STEPS).max(median(steps));
        let mut sums = vec![([0.0; 3], 0_u32); ((last_s - first_s) / step_s) as usize + 1];
        for (time, reading) in times.iter().zip(&recording.readings) {
            let place = (((time - first_s) / step_s) as usize).min(sums.len() - 1);
            let (sum, count) = &mut sums[place];
            (0..3).for_each(|k| sum[k] += reading[k]);
            *count += 1;
        }
        let mean = |(sum, count): ([f64; 3], u32)| (count > 0).then(|| sum.map(|of| of / f64::from(count)));
        Self { command, axes, step_s, first_s, last_s, readings: sums.into_iter().map(mean).collect() }
    }

    /// The delay at which both agree best.
    fn delay_s(&self) -> Result<f64> {
        let tau = self.command.motion.times_s();
        let (start, end) = (tau[0], tau[tau.len() - 1]);
        let common = COMMON * (end - start).min(self.last_s - self.first_s);
        let given = self.command.clock;
        let place = |delay_s: f64| ((delay_s - given.delay_s) / self.step_s).round() as i64;
        let places = place(start + common - self.last_s)..=place(end - common - self.first_s);
        let delay = |place: i64| given.delay_s + place as f64 * self.step_s;
        let agreements = places.filter_map(|k| Some((k, self.at(delay(k))?)));
        let found = agreements.max_by(|one, other| one.1.likelihood.total_cmp(&other.1.likelihood));
        let Some((place, found)) = found.filter(|(_, found)| found.correlation >= SAME_MOTION) else {
            let correlation = found.map_or(0.0, |(_, found)| found.correlation);
            return Err(Error::recording(
                InputError::new(
                    Refusal::MotionInvalid,
                    format!(
                        "the motion was not found in the recording: at no delay is the correlation of readings and commanded acceleration above {correlation:.2}"
                    ),
                    "check that both belong together, the order of the axes and the unit. Where they surely begin together, give delay_s = 0.0 and delay_sd_s = 0.0 in [motion.clock]",
                )
                .about_key("motion.clock"),
            ));
        };
        // the top of the parabola through the best three
        let beside = |k: i64| self.at(delay(k)).map(|found| found.likelihood);
        let refined = match (beside(place - 1), beside(place + 1)) {
            (Some(a), Some(c)) if 2.0 * found.likelihood - a - c > 0.0 => {
                0.5 * (c - a) / (2.0 * found.likelihood - a - c)
            }
            _ => 0.0,
        };
        Ok(delay(place) + refined.clamp(-0.5, 0.5) * self.step_s)
    }

    /// The agreement at a delay; `None` where they have too little in common.
    fn at(&self, delay_s: f64) -> Option<Agreement> {
        let tau = self.command.motion.times_s();
        let (start, end) = (tau[0], tau[tau.len() - 1]);
        let place = |motion_s: f64| (motion_s - delay_s - self.first_s) / self.step_s - 0.5;
        let first = place(start).ceil().max(0.0) as usize;
        let last = place(end).floor().min(self.readings.len() as f64 - 1.0);
        let mut sums = [[0.0_f64; 5]; 3];
        let mut count = 0.0;
        for k in first..(last + 1.0).max(0.0) as usize {
            let Some(reading) = self.readings[k] else { continue };
            let time_s = self.first_s + (k as f64 + 0.5) * self.step_s;
            let acceleration = self.command.motion.acceleration_at(time_s + delay_s);
            count += 1.0;
            for (axis, sums) in sums.iter_mut().enumerate().take(self.axes) {
                let (a, y) = (acceleration[axis], reading[axis]);
                [a, y, a * a, y * y, a * y].into_iter().zip(sums).for_each(|(of, sum)| *sum += of);
            }
        }
        if count < FEWEST as f64 {
            return None;
        }
        let mut agreement = Agreement { likelihood: 0.0, correlation: 0.0 };
        for [a, y, aa, yy, ay] in sums {
            let (of_a, of_y) = (aa - a * a / count, yy - y * y / count);
            if of_a > 0.0 && of_y > 0.0 {
                let correlation = (ay - a * y / count) / (of_a * of_y).sqrt();
                agreement.likelihood -= 0.5 * count * (1.0 - correlation * correlation).max(1e-12).ln();
                agreement.likelihood += if correlation < 0.0 { REVERSED } else { 0.0 };
                agreement.correlation = agreement.correlation.max(correlation.abs());
            }
        }
        let given = self.command.clock;
        agreement.likelihood -= 0.5 * ((delay_s - given.delay_s) / given.delay_sd_s).powi(2);
        Some(agreement)
    }
}
