//! Figures of residuals: over time, as a histogram, and their autocorrelation.

use super::panel::{Mark, Panel, Series, Shape};
use super::point_thinning::{is_thinned, thinned};
use super::unit::DisplayUnit;
use super::{Figure, colour};
use calibrant_core::estimate::{Calibration, RecoveredMotion};
use calibrant_core::sensor::{Axis, Recording};
use nalgebra::Vector3;

/// Residuals of each axis over time.
pub(crate) fn residuals_over_time(
    calibration: &Calibration,
    motion: &RecoveredMotion,
    recording: &Recording,
) -> Figure {
    let unit = unit_of(calibration);
    let times = recording.times_s().get(motion.first_sample..).unwrap_or_default();
    let panels = panels(motion, recording, "time (s)", &unit.label("residual"), |axis, panel| {
        let values = residuals(motion, axis, unit);
        let points: Vec<_> = times.iter().copied().zip(values).collect();
        let span = points.first().zip(points.last()).map(|(first, last)| [first.0, last.0]);
        let many = is_thinned(points.len());
        let dots = Series::dots("residual", colour::BLUE, Shape::Circle, Vec::new());
        let line = Series::new("residual", colour::BLUE, Mark::Line { width: 0.7, dashes: "" }, Vec::new());
        let mut panel =
            panel.with(Series { points: thinned(points.into_iter()), ..if many { line } else { dots } });
        if let (Some(sd), Some(span)) = (noise(calibration, axis, unit), span) {
            for level in [2.0 * sd, -2.0 * sd] {
                let ends = span.map(|t| (t, level)).to_vec();
                panel = panel.with(Series::dashed(
                    &format!("±2 sd of the {} noise", noise_word(calibration)),
                    colour::BLACK,
                    ends,
                ));
            }
        }
        panel
    });
    let mut caption = "Reading less model. Good: a band without structure about zero, of the same width everywhere, with about one \
                       point in twenty outside the dashed lines. A wave or a step is an error of the model."
        .to_string();
    if is_thinned(motion.residuals.len()) {
        caption.push_str(
            " Only the smallest and the largest residual of each pixel column are drawn, so the band shows the extremes and looks \
             wider than ±2 sd.",
        );
    }
    Figure::new("Residuals over time", panels, caption)
}

/// Histogram of each axis' residuals with the normal curve of the noise.
pub(crate) fn histograms(
    calibration: &Calibration,
    motion: &RecoveredMotion,
    recording: &Recording,
) -> Figure {
    let unit = unit_of(calibration);
    let panels = panels(motion, recording, &unit.label("residual"), "number of samples", |axis, panel| {
        let values: Vec<f64> = residuals(motion, axis, unit).filter(|v| v.is_finite()).collect();
        let Some(bins) = Histogram::of(&values, bin_count(values.len())) else { return panel };
        let mut panel = panel.with(Series::new("residuals", colour::SKY, Mark::Area, bins.outline()));
        if let Some(sd) = noise(calibration, axis, unit) {
            let reach =
                (4.0 * sd).max(bins.low.abs()).max((bins.low + bins.width * bins.counts.len() as f64).abs());
            let reach = reach.min(6.0 * sd);
            let area = values.len() as f64 * bins.width;
            // the bars stay visible below the curve of a noise that is far too small
            let highest = HIGHEST_CURVE * bins.counts.iter().copied().max().unwrap_or(1) as f64;
            if area / (sd * std::f64::consts::TAU.sqrt()) > highest {
                panel.y_shown = Some((0.0, highest));
            }
            let curve = (0..=120)
                .map(|i| reach * (f64::from(i) / 60.0 - 1.0))
                .map(|x| (x, area * (-0.5 * (x / sd).powi(2)).exp() / (sd * std::f64::consts::TAU.sqrt())))
                .collect();
            panel = panel.with(Series::line(
                &format!("normal curve of the {} noise", noise_word(calibration)),
                colour::VERMILLION,
                curve,
            ));
        }
        panel
    });
    let mut caption = "Good: the bars follow the curve. Narrower bars mean that the noise is smaller than assumed. Wider bars mean that it \
                       is larger, or that the model has an error. Long tails are outliers."
        .to_owned();
    if panels.iter().any(|panel| panel.y_shown.is_some()) {
        caption.push_str(
            " The top of the curve is beyond the axis: the residuals are far larger than the noise.",
        );
    }
    Figure::new("Distribution of the residuals", panels, caption)
}

/// Autocorrelation of each axis' residuals with the band of white noise.
pub(crate) fn autocorrelations(
    calibration: &Calibration,
    motion: &RecoveredMotion,
    recording: &Recording,
) -> Figure {
    let unit = unit_of(calibration);
    let panels = panels(motion, recording, "lag (samples)", "autocorrelation", |axis, mut panel| {
        let values: Vec<f64> = residuals(motion, axis, unit).collect();
        let correlation = autocorrelation(&values, (values.len() / 4).min(40));
        let stems: Vec<_> = correlation.iter().enumerate().map(|(i, &r)| ((i + 1) as f64, r)).collect();
        let Some(last) = stems.last().map(|stem| stem.0) else { return panel };
        let bound = 1.96 / (values.len() as f64).sqrt();
        let band = vec![(0.0, 0.0), (last + 1.0, 0.0)];
        panel.y_includes = vec![-2.0 * bound, 2.0 * bound];
        panel
            .with(
                Series::new("95 % band of white noise", colour::ORANGE, Mark::Band, band)
                    .with_spread(vec![bound; 2]),
            )
            .with(Series::new("autocorrelation", colour::BLUE, Mark::Stems, stems))
    });
    let caption = "Good: about nineteen in twenty stems end within the band. Many long stems mean coloured noise or a model error. \
                   The standard deviations of the parameters are then too small.";
    Figure::new("Autocorrelation of the residuals", panels, caption)
}

fn panels(
    motion: &RecoveredMotion,
    recording: &Recording,
    x_label: &str,
    y_label: &str,
    fill: impl Fn(Axis, Panel) -> Panel,
) -> Vec<Panel> {
    let empty = if motion.residuals.is_empty() { "no residuals" } else { "too few residuals" };
    recording
        .active_axes()
        .iter()
        .map(|&axis| {
            let panel = Panel::new(format!("axis {axis}"), x_label, y_label);
            fill(axis, Panel { when_empty: empty.to_string(), ..panel })
        })
        .collect()
}

fn unit_of(calibration: &Calibration) -> DisplayUnit {
    let rms = calibration.fit.residual_rms.unwrap_or_else(Vector3::zeros);
    DisplayUnit::suited_to(calibration.accelerometer_unit.symbol(), rms.iter().map(|rms| 3.0 * rms))
}

fn residuals(motion: &RecoveredMotion, axis: Axis, unit: DisplayUnit) -> impl Iterator<Item = f64> + '_ {
    motion.residuals.iter().map(move |residual| residual[axis.index()] * unit.factor)
}

fn noise(calibration: &Calibration, axis: Axis, unit: DisplayUnit) -> Option<f64> {
    let sd = calibration.fit.sample_noise()?[axis.index()] * unit.factor;
    (sd.is_finite() && sd > 0.0).then_some(sd)
}

fn noise_word(calibration: &Calibration) -> &'static str {
    if calibration.fit.assumed_noise.is_some() { "assumed" } else { "estimated" }
}

/// How many times higher than the bars the curve of the noise is drawn.
const HIGHEST_CURVE: f64 = 4.0;

/// Bars of equal width.
#[derive(Debug)]
pub(super) struct Histogram {
    pub(super) low: f64,
    pub(super) width: f64,
    pub(super) counts: Vec<usize>,
}

impl Histogram {
    /// Counts of finite values in equal bins over their range; `None` for no values.
    pub(super) fn of(values: &[f64], bins: usize) -> Option<Self> {
        let low = values.iter().copied().reduce(f64::min)?;
        let high = values.iter().copied().reduce(f64::max)?;
        let (low, high) = if high > low { (low, high) } else { (low - 0.5, high + 0.5) };
        Some(Self::within(values, low, high, bins.max(1)))
    }

    /// Counts in equal bins between these ends; values beyond them join the outer bins.
    pub(super) fn within(values: &[f64], low: f64, high: f64, bins: usize) -> Self {
        let width = (high - low) / bins as f64;
        let mut counts = vec![0; bins];
        for value in values {
            let bin = ((value - low) / width).floor().clamp(0.0, (bins - 1) as f64);
            counts[bin as usize] += 1;
        }
        Self { low, width, counts }
    }

    /// The outline of the bars, from zero to zero.
    pub(super) fn outline(&self) -> Vec<(f64, f64)> {
        let edge = |i: usize| self.low + self.width * i as f64;
        let mut outline = vec![(edge(0), 0.0)];
        for (i, &count) in self.counts.iter().enumerate() {
            outline.extend([(edge(i), count as f64), (edge(i + 1), count as f64), (edge(i + 1), 0.0)]);
        }
        outline
    }
}

/// Number of histogram bins for n values: Rice's rule, 2 ∛n, from 5 to 60.
pub(super) fn bin_count(n: usize) -> usize {
    ((2.0 * (n as f64).cbrt()).ceil() as usize).clamp(5, 60)
}

/// Autocorrelation of a series at lags 1 to `lags`; empty where it does not vary.
fn autocorrelation(values: &[f64], lags: usize) -> Vec<f64> {
    let n = values.len();
    let mean = values.iter().sum::<f64>() / n.max(1) as f64;
    let centred: Vec<f64> = values.iter().map(|v| v - mean).collect();
    let variance: f64 = centred.iter().map(|v| v * v).sum();
    if !(variance.is_finite() && variance > 0.0) {
        return Vec::new();
    }
    (1..=lags)
        .map(|lag| centred[lag..].iter().zip(&centred).map(|(a, b)| a * b).sum::<f64>() / variance)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn histogram_counts_every_value_once() {
        let values: Vec<f64> = (0..1000).map(|i| f64::from(i) / 999.0).collect();
        let bins = Histogram::of(&values, 10).expect("values");
        assert_eq!(bins.counts.iter().sum::<usize>(), 1000);
        assert_eq!(Histogram::of(&[2.0; 7], 5).expect("values").counts.iter().sum::<usize>(), 7);
        assert!(Histogram::of(&[], 5).is_none());
    }

    #[test]
    fn autocorrelation_of_an_alternating_series_alternates() {
        let values: Vec<f64> = (0..1000).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let r = autocorrelation(&values, 2);
        assert!((r[0] + 0.999).abs() < 1e-12 && (r[1] - 0.998).abs() < 1e-12);
        assert!(autocorrelation(&[1.0; 9], 2).is_empty() && autocorrelation(&[], 0).is_empty());
    }
}
