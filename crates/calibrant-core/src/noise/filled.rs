//! Gaps of a recording at rest, filled so that its noise can be examined as a whole.
//!
//! A gap of m samples lies on the line between the means of the m samples before and behind it, with the deviations of those before about their mean in
//! reverse order. So the white noise and what correlates it stay as they are, and a random walk goes on behind the gap from where it was.

use super::segment::GAP;
use crate::diagnostic::noise::NoiseGapsFilled;
use crate::sensor::Recording;
use nalgebra::Vector3;

/// Largest share of the samples that may be filled.
const MOST: f64 = 0.1;

/// The recording without gaps, and how many there were. `None` where it has none, or too much of it is missing.
#[must_use]
pub fn filled(recording: &Recording) -> Option<(Recording, NoiseGapsFilled)> {
    let (times, readings) = (&recording.times_s, &recording.readings);
    let mean_step = (times.last()? - times.first()?) / times.len() as f64;
    if !times.array_windows().any(|[one, next]| next - one > (GAP - 1.0) * mean_step) {
        return None;
    }
    let step = recording.rate_hz().recip();
    let (mut all_times, mut all) = (Vec::with_capacity(times.len()), Vec::with_capacity(times.len()));
    let (mut gaps, mut added) = (0, 0);
    for k in 0..times.len() {
        let lost = match k {
            0 => 0.0,
            _ => ((times[k] - times[k - 1]) / step).round() - 1.0,
        };
        if lost >= GAP - 1.0 {
            // no more than there is before and behind it
            if lost > k.min(times.len() - k) as f64 {
                return None;
            }
            let lost = lost as usize;
            let mean = |of: &[Vector3<f64>]| of.iter().sum::<Vector3<f64>>() / of.len() as f64;
            let before = &readings[k - lost..k];
            let ends = [mean(before), mean(&readings[k..k + lost])];
            for (j, reading) in before.iter().rev().enumerate() {
                let part = (j + 1) as f64 / (lost + 1) as f64;
                all_times.push(times[k - 1] + part * (times[k] - times[k - 1]));
                all.push(reading - ends[0] + ends[0].lerp(&ends[1], part));
            }
            (gaps, added) = (gaps + 1, added + lost);
        }
        all_times.push(times[k]);
        all.push(readings[k]);
    }
    let share = added as f64 / all.len() as f64;
    if gaps == 0 || share > MOST {
        return None;
    }
    let filled = Recording { times_s: all_times, readings: all, ..recording.clone() };
    Some((filled, NoiseGapsFilled { gaps, share }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::{PowerLaw, Segment, SensorNoise};
    use crate::sensor::{ReadingUnit, SensorKind};
    use crate::simulate::{Purpose, simulate_noise, stream};

    /// White noise and a random walk at 50 Hz, of which blocks of half a second are lost.
    #[test]
    fn noise_is_that_of_the_whole_recording() {
        let mut rng = stream(5, Purpose::Sensor, 0);
        let count = 60_000;
        let of = |_| {
            let white = simulate_noise(PowerLaw::White, 1e-3, 0.02, count, &mut rng);
            let walk = simulate_noise(PowerLaw::RandomWalk, 1e-4, 0.02, count, &mut rng);
            white.iter().zip(&walk).map(|(white, walk)| white + walk).collect::<Vec<f64>>()
        };
        let axes: [Vec<f64>; 3] = [0, 1, 2].map(of);
        let kept = |k: &usize| k % 1500 >= 25 || *k < 1000;
        let times_s = (0..count).filter(kept).map(|k| 0.02 * k as f64).collect();
        let readings =
            (0..count).filter(kept).map(|k| Vector3::new(axes[0][k], axes[1][k], axes[2][k])).collect();
        let recording = Recording { times_s, readings, axes: 3, unit: ReadingUnit::RadianPerSecond };
        let (whole, found) = filled(&recording).expect("gaps");
        assert_eq!((found.gaps, whole.len()), (39, count));
        let end_s = whole.times_s[count - 1];
        let segment = Segment::between(&whole, 0.0, end_s).expect("one part");
        assert_eq!((segment.parts, segment.samples()), (1, count));
        let noise = SensorNoise::of(SensorKind::Gyroscope, &whole, segment).expect("determined");
        let sigma = noise.white_noise_per_sample().expect("white noise");
        assert!((sigma / (1e-3 * 50_f64.sqrt()) - Vector3::repeat(1.0)).amax() < 0.02, "{sigma}");
        let longest = Segment::between(&recording, 0.0, end_s).expect("long enough").samples();
        assert!(longest < 2600, "{longest}: nothing of the walk is seen in a part alone");
    }
}
