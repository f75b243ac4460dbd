//! Skewed spikes: single samples to one side. They are too near the noise to be removed as spikes, but they shift the means of the holds and the bias.
//!
//! Noise is as often far above its mean as far below. So single samples beyond [`FAR_DEVIATIONS`] standard deviations are counted on either side, in the
//! middle of each hold. Far more on one side, in nearly all holds with such samples, is not by chance. A sensor that is put down has some in one hold, on
//! either side.

use crate::diagnostic::Diagnostic;
use crate::motion::Hold;
use crate::sensor::{Axis, MeanReading, Recording, SensorKind};

/// Least distance of a counted sample, in standard deviations of a hold's samples, spikes included. It is 5 of the white noise if one sample in a
/// hundred is at 10.
const FAR_DEVIATIONS: f64 = 4.0;
/// Least difference of the counts of samples on both sides, in standard deviations of chance.
const SAMPLE_DEVIATIONS: f64 = 4.5;
/// Least difference of the counts of holds on both sides, in standard deviations of chance.
const HOLD_DEVIATIONS: f64 = 3.0;
/// Inverse of the share of a hold at each end that may already move.
const END_SHARE: usize = 5;

/// The warnings about axes with such samples. The holds' times are those of a sensor on the same clock.
pub(super) fn skewed_spikes<'a>(
    recording: &Recording,
    sensor_kind: SensorKind,
    holds: impl IntoIterator<Item = &'a Hold>,
) -> Vec<Diagnostic> {
    let middle = |hold: &Hold| {
        let mut span = recording.between(hold.start_s, hold.end_s);
        let end = span.len() / END_SHARE;
        span.start += end;
        span.end -= end;
        (span.len() > 2).then(|| (span.clone(), MeanReading::of(&recording.readings[span])))
    };
    let middles: Vec<_> =
        holds.into_iter().filter_map(middle).filter_map(|(span, mean)| Some((span, mean?))).collect();
    let unit = recording.unit;
    let skewed = |&axis: &Axis| {
        let k = axis.index();
        let (mut all, mut holds, mut samples) = (Sides::default(), Sides::default(), 0);
        for (span, mean) in &middles {
            let sd = MeanReading::pooled_sd([mean])[k];
            let own = Sides::of(
                recording.readings[span.clone()].iter().map(|y| y[k] - mean.mean[k]),
                FAR_DEVIATIONS * sd,
            );
            holds.add(f64::from(u8::from(own.above > own.below)), f64::from(u8::from(own.above < own.below)));
            all.add(own.above, own.below);
            all.sum += own.sum;
            samples += span.len();
        }
        if all.difference() < SAMPLE_DEVIATIONS || holds.difference() < HOLD_DEVIATIONS {
            return None;
        }
        let shift = all.sum / samples as f64;
        let noise = MeanReading::pooled_sd(middles.iter().map(|(_, mean)| mean))[k];
        Some(Diagnostic::SkewedSpikes {
            sensor_kind,
            axis,
            unit,
            far_deviations: FAR_DEVIATIONS,
            samples_above: all.above,
            samples_below: all.below,
            shift,
            times_noise: (shift / noise).abs() * (samples as f64).sqrt(),
        })
    };
    recording.active_axes().iter().filter_map(skewed).collect()
}

/// Number of samples above and below, and the sum of their deviations.
#[derive(Default)]
struct Sides {
    above: f64,
    below: f64,
    sum: f64,
}

impl Sides {
    /// The counts of single deviations beyond a distance.
    fn of(deviations: impl Iterator<Item = f64>, far: f64) -> Self {
        let mut sides = Self::default();
        let (mut before, mut here) = (0.0, 0.0_f64);
        for next in deviations.chain([0.0]) {
            if here.abs() > far && f64::max(f64::abs(before), f64::abs(next)) <= far {
                sides.add(f64::from(u8::from(here > 0.0)), f64::from(u8::from(here < 0.0)));
                sides.sum += here;
            }
            (before, here) = (here, next);
        }
        sides
    }

    fn add(&mut self, above: f64, below: f64) {
        self.above += above;
        self.below += below;
    }

    /// The difference of the counts, in standard deviations of chance.
    fn difference(&self) -> f64 {
        (self.above - self.below).abs() / (self.above + self.below).max(1.0).sqrt()
    }
}
