//! Single samples that are off to one side: too near the noise to be left out as spikes are, but they take the means of the holds, and with them the bias, along.
//!
//! Noise is as often far above its mean as far below. So in the middle of each hold single samples beyond [`FAR_DEVIATIONS`] standard deviations are counted on either side. It is no chance if there are
//! far more on one side altogether, and in nearly all holds that have any: a sensor that is put down leaves some in one hold, on either side.

use crate::diagnostic::Diagnostic;
use crate::motion::Hold;
use crate::sensor::{Axis, MeanReading, Recording, SensorKind};

/// Standard deviations of a hold's samples, spikes included: five of white noise with one of 10 in a hundred.
const FAR_DEVIATIONS: f64 = 4.0;
/// The counts on both sides, of samples and of holds, differ by chance by fewer standard deviations than this.
const OF_SAMPLES: f64 = 4.5;
const OF_HOLDS: f64 = 3.0;
/// This share of a hold at each end may move already.
const END_SHARE: usize = 5;

/// For each axis with such samples, what they do. The holds' times are those of a sensor on the same clock.
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
        if all.difference() < OF_SAMPLES || holds.difference() < OF_HOLDS {
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

/// How many are above, and below; and the sum of their deviations.
#[derive(Default)]
struct Sides {
    above: f64,
    below: f64,
    sum: f64,
}

impl Sides {
    /// Of the single deviations beyond a distance.
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

    /// By how many standard deviations of chance the counts differ.
    fn difference(&self) -> f64 {
        (self.above - self.below).abs() / (self.above + self.below).max(1.0).sqrt()
    }
}
