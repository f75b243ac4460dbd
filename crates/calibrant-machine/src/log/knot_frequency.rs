//! The periods that knots may have, from the second differences of even samples.
//!
//! The second difference of a piecewise linear function is 0 but next to a knot. So its size has a line in its
//! spectrum at the frequency of the knots, or at the alias of it.

use nalgebra::Vector3;
use realfft::RealFftPlanner;

/// Samples over which the size of the second differences is averaged.
const AVERAGED: usize = 129;
/// Least and largest number of samples for each knot. With fewer, a piecewise linear function follows vibration at
/// some frequencies to the last decimal.
const RATIOS: std::ops::RangeInclusive<f64> = 1.4..=60.0;
/// Lines of the spectrum that are tried.
const LINES: usize = 4;

/// Second differences of even samples.
pub(super) fn second_differences(values: &[Vector3<f64>]) -> Vec<f64> {
    values.array_windows().map(|[before, value, after]| (after - value * 2.0 + before).norm()).collect()
}

/// Periods in samples, the longest first.
pub(super) fn periods(values: &[Vector3<f64>]) -> Vec<f64> {
    let sizes = second_differences(values);
    let Some(spectrum) = spectrum(&sizes) else { return Vec::new() };
    let is_peak = |bin: usize| {
        spectrum[bin] >= spectrum[bin - 1] && spectrum.get(bin + 1).is_none_or(|next| spectrum[bin] > *next)
    };
    let mut peaks: Vec<usize> = (2..spectrum.len()).filter(|&bin| is_peak(bin)).collect();
    peaks.sort_by(|&one, &other| spectrum[other].total_cmp(&spectrum[one]));
    peaks.truncate(LINES);
    let samples = (2 * (spectrum.len() - 1)) as f64;
    let frequency = |bin: usize| {
        let (before, after) =
            (spectrum[bin - 1], spectrum.get(bin + 1).copied().unwrap_or(spectrum[bin - 1]));
        let curvature = before - 2.0 * spectrum[bin] + after;
        let off = if curvature < 0.0 { 0.5 * (before - after) / curvature } else { 0.0 };
        (bin as f64 + off) / samples
    };
    let of_line = |bin: usize| {
        let frequency = frequency(bin);
        // the line may be the second harmonic, or the alias of a frequency above half the sample rate
        [0.5 * frequency, frequency, 0.5 * (1.0 - frequency), 1.0 - frequency].map(f64::recip)
    };
    // knots at every second sample have no line where they are halfway between samples
    let mut periods: Vec<f64> = peaks.into_iter().flat_map(of_line).chain([2.0]).collect();
    periods.retain(|period| RATIOS.contains(period));
    periods.sort_by(|one, other| other.total_cmp(one));
    periods
}

/// Amplitudes of the sizes less their local mean, over it.
fn spectrum(sizes: &[f64]) -> Option<Vec<f64>> {
    let mean = |k: usize| {
        let around = &sizes[k.saturating_sub(AVERAGED / 2)..(k + AVERAGED / 2 + 1).min(sizes.len())];
        around.iter().sum::<f64>() / around.len() as f64
    };
    let length = sizes.len() & !1;
    let window = |k: usize| (std::f64::consts::PI * (k as f64 + 0.5) / length as f64).sin().powi(2);
    let mut input: Vec<f64> = (0..length)
        .map(|k| {
            let mean = mean(k);
            if mean > 0.0 { window(k) * (sizes[k] / mean - 1.0) } else { 0.0 }
        })
        .collect();
    let transform = RealFftPlanner::new().plan_fft_forward(length);
    let mut output = transform.make_output_vec();
    transform.process(&mut input, &mut output).ok()?;
    Some(output.iter().map(|line| line.norm()).collect())
}
