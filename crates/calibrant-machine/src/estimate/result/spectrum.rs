//! The spectrum of a sensor's residuals, and how far they follow the reference (`welch1967`).

use crate::estimate::{MachineCalibration, MachineParameters, SampleResidual};
use calibrant_core::fourier::Fourier;
use calibrant_core::sensor::{Recording, SensorKind};
use nalgebra::{Complex, Vector3};

/// Fewest and most samples of a segment.
const LENGTHS: [usize; 2] = [32, 2048];
/// A segment is at most this part of the samples.
const PARTS: usize = 6;
/// Half-overlapping segments under a Hann window correlate by 1/6, so their powers by 1/36 with each neighbour: they tell as much as
/// this part of their number of separate ones.
const INDEPENDENT: f64 = 18.0 / 19.0;
/// Probability that a coherence of unrelated signals is below the stated level.
const LEVEL: f64 = 0.95;

/// Densities by frequency, per axis, one-sided.
#[derive(Debug, Clone, PartialEq)]
pub struct ResidualSpectrum {
    /// Frequencies, without 0 and half the sample rate, Hz.
    pub frequencies_hz: Vec<f64>,
    /// Power density of the residuals, the reading's unit² per Hz.
    pub residuals: Vec<Vector3<f64>>,
    /// Power density of what the sensor should have read.
    pub reference: Vec<Vector3<f64>>,
    /// Coherence of both, 0 to 1: the part of the residuals' power that follows the reference linearly.
    pub coherence: Vec<Vector3<f64>>,
    /// Power density of the noise that neighbouring samples do not share.
    pub white_noise: Vector3<f64>,
    /// Number of segments.
    pub segments: usize,
    /// The coherence that unrelated signals exceed at one frequency in twenty.
    pub unrelated: f64,
}

/// A sample that was used: time of the motion, residual, and the reading that the reference says.
type Sample = (f64, Vector3<f64>, Vector3<f64>);

impl MachineCalibration {
    /// The spectrum of a sensor's residuals. `recording` is that sensor's. `None` for too few samples without a gap.
    #[must_use]
    pub fn residual_spectrum(&self, sensor: SensorKind, recording: &Recording) -> Option<ResidualSpectrum> {
        let noise = self.noise.iter().find(|of| of.sensor == sensor)?;
        let samples = with_reference(&noise.residuals, recording, sensor, &self.parameters);
        spectrum(&samples, &noise.white_noise)
    }
}

/// What the reference says at each residual: the reading of the sample at its time, less the residual.
fn with_reference(
    residuals: &[SampleResidual],
    recording: &Recording,
    sensor: SensorKind,
    parameters: &MachineParameters,
) -> Vec<Sample> {
    let times = recording.times_s();
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return Vec::new() };
    let middle_s = 0.5 * (first + last);
    let distance = |k: usize, time: f64| (parameters.motion_time(sensor, times[k], middle_s) - time).abs();
    let mut place = 0;
    let sample = |of: &SampleResidual| {
        let time = of.time_s;
        while place + 1 < times.len() && distance(place + 1, time) <= distance(place, time) {
            place += 1;
        }
        (time, of.value, recording.readings()[place] - of.value)
    };
    residuals.iter().map(sample).collect()
}

/// Welch's averages over half-overlapping segments without a gap.
fn spectrum(samples: &[Sample], white_noise: &Vector3<f64>) -> Option<ResidualSpectrum> {
    let mut steps: Vec<f64> = samples.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
    if steps.is_empty() {
        return None;
    }
    let middle = steps.len() / 2;
    let step_s = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    let runs: Vec<&[Sample]> = samples
        .chunk_by(|one, next| next.0 - one.0 < 1.5 * step_s)
        .filter(|run| run.len() >= LENGTHS[0])
        .collect();
    let longest = runs.iter().map(|run| run.len()).max()?;
    let wanted = (samples.len() / PARTS).clamp(LENGTHS[0], LENGTHS[1]).min(longest);
    let length = (wanted + 1).next_power_of_two() / 2;
    let fourier = Fourier::of_size(length);
    // Hann's window is the square of a sine
    let window: Vec<f64> =
        (0..length).map(|j| (std::f64::consts::PI * j as f64 / length as f64).sin().powi(2)).collect();
    let per_density = 2.0 * step_s / window.iter().map(|w| w * w).sum::<f64>();
    let bins = length / 2 - 1;
    let zero = Vector3::zeros();
    let (mut residuals, mut reference) = (vec![zero; bins], vec![zero; bins]);
    let mut cross = vec![[Complex::new(0.0, 0.0); 3]; bins];
    let of = |values: &mut dyn Iterator<Item = f64>| {
        let values: Vec<f64> = values.collect();
        let mean = values.iter().sum::<f64>() / length as f64;
        let spectrum =
            fourier.transform(values.iter().zip(&window).map(|(value, weight)| (value - mean) * weight));
        spectrum[1..=bins].to_vec()
    };
    let mut segments = 0;
    for run in runs {
        for start in (0..=run.len().saturating_sub(length)).step_by(length / 2) {
            let Some(segment) = run.get(start..start + length) else { break };
            segments += 1;
            for axis in 0..3 {
                let residual = of(&mut segment.iter().map(|sample| sample.1[axis]));
                let expected = of(&mut segment.iter().map(|sample| sample.2[axis]));
                for (k, (a, b)) in residual.iter().zip(&expected).enumerate() {
                    residuals[k][axis] += a.norm_sqr();
                    reference[k][axis] += b.norm_sqr();
                    cross[k][axis] += a * b.conj();
                }
            }
        }
    }
    if segments < 2 {
        return None;
    }
    let coherence = (0..bins).map(|k| {
        Vector3::from_fn(|axis, _| {
            let powers = residuals[k][axis] * reference[k][axis];
            if powers > 0.0 { cross[k][axis].norm_sqr() / powers } else { 0.0 }
        })
    });
    let coherence = coherence.collect();
    let scale = per_density / f64::from(segments);
    residuals.iter_mut().chain(&mut reference).for_each(|power| *power *= scale);
    let others = (INDEPENDENT * f64::from(segments) - 1.0).max(0.1);
    Some(ResidualSpectrum {
        frequencies_hz: (1..=bins).map(|k| k as f64 / (length as f64 * step_s)).collect(),
        residuals,
        reference,
        coherence,
        white_noise: white_noise.map(|sd| 2.0 * step_s * sd * sd),
        segments: segments as usize,
        unrelated: 1.0 - (1.0 - LEVEL).powf(1.0 / others),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::RngExt;
    use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
    use rand_distr::StandardNormal;
    use std::f64::consts::TAU;

    const STEP_S: f64 = 0.005;

    fn of(samples: &[Sample]) -> ResidualSpectrum {
        spectrum(samples, &Vector3::repeat(0.3)).expect("long enough")
    }

    /// A sine of amplitude `a` that fits a segment has the power a²/2. Hann's window spreads it over three frequencies in parts 1:4:1.
    #[test]
    fn a_sine_has_its_power_at_its_frequency() {
        let bin = 40.0;
        let sine = |k: usize| (TAU * bin * k as f64 / 512.0).sin();
        let sample = |k: usize| (k as f64 * STEP_S, Vector3::x() * 0.7 * sine(k), Vector3::x() * sine(k));
        let found = of(&(0..4000).map(sample).collect::<Vec<_>>());
        assert_eq!(found.frequencies_hz.len(), 255);
        let width = found.frequencies_hz[0];
        assert!((width - 1.0 / (512.0 * STEP_S)).abs() < 1e-9);
        let power = |k: usize| found.residuals[k][0] * width;
        assert!((power(39) - 0.245 * 2.0 / 3.0).abs() < 1e-9, "{}", power(39));
        for beside in [38, 40] {
            assert!((power(beside) - 0.245 / 6.0).abs() < 1e-9, "{}", power(beside));
        }
        assert!(power(36).abs() < 1e-12);
        assert!((found.coherence[39][0] - 1.0).abs() < 1e-9);
        assert!((found.reference[39][0] * 0.49 / found.residuals[39][0] - 1.0).abs() < 1e-9);
        assert_eq!(found.coherence[39][1], 0.0);
    }

    /// White noise has the density 2σ²/f_s, and a part `ρ²` of common power is the coherence. Gaps end segments.
    #[test]
    fn white_noise_is_flat_and_coherence_is_the_common_part() {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let mut normal = || Vector3::from_fn(|_, _| random.sample::<f64, _>(StandardNormal));
        let sample = |k: usize| {
            let (common, own, other) = (normal(), normal(), normal());
            let time = k as f64 * STEP_S + if k >= 30_000 { 12.0 } else { 0.0 };
            (time, (common + own) * 0.3 / 2.0_f64.sqrt(), common + other)
        };
        let found = of(&(0..60_000).map(sample).collect::<Vec<_>>());
        let bins = found.residuals.len() as f64;
        for axis in 0..3 {
            let mean = found.residuals.iter().map(|power| power[axis]).sum::<f64>() / bins;
            assert!((mean / found.white_noise[axis] - 1.0).abs() < 0.02, "{mean}");
            let coherence = found.coherence.iter().map(|of| of[axis]).sum::<f64>() / bins;
            assert!((coherence - 0.25).abs() < 0.02, "{coherence}");
        }
        assert_eq!(found.segments, 2 * (2 * 30_000 / 2048 - 1));
        assert!((found.white_noise[0] - 2.0 * 0.09 * STEP_S).abs() < 1e-15);
    }

    #[test]
    fn unrelated_signals_exceed_the_level_at_one_frequency_in_twenty() {
        let mut random = ChaCha8Rng::seed_from_u64(8);
        let mut normal = || Vector3::from_fn(|_, _| random.sample::<f64, _>(StandardNormal));
        let found = of(&(0..40_000).map(|k| (k as f64 * STEP_S, normal(), normal())).collect::<Vec<_>>());
        let above =
            found.coherence.iter().flat_map(|of| of.iter()).filter(|of| **of > found.unrelated).count();
        let share = above as f64 / (3 * found.coherence.len()) as f64;
        assert!((0.03..0.07).contains(&share), "{share}");
    }

    #[test]
    fn too_few_samples_have_no_spectrum() {
        let samples: Vec<Sample> = (0..30).map(|k| (f64::from(k), Vector3::x(), Vector3::x())).collect();
        assert_eq!(spectrum(&samples, &Vector3::zeros()), None);
        assert_eq!(spectrum(&samples[..1], &Vector3::zeros()), None);
    }
}
