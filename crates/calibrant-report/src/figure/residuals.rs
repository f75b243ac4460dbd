//! Figures of residuals: over time, as a histogram, and their autocorrelation.

use super::frame::caption;
use super::histogram::{Histogram, bin_count, normal_curve};
use super::panel::{Mark, Panel, Points, Series, Shape};
use super::point_thinning::{is_thinned, thinned};
use super::unit::DisplayUnit;
use super::{Figure, colour};
use calibrant_core::estimate::{Calibration, RecoveredMotion};
use calibrant_core::sensor::{Axis, Recording, SensorKind};
use nalgebra::Vector3;
use std::f64::consts::TAU;

pub(crate) fn residuals_over_time(
    calibration: &Calibration,
    motion: &RecoveredMotion,
    recording: &Recording,
) -> Figure {
    let unit = unit_of(calibration);
    let times = recording.times_s().get(motion.first_sample..).unwrap_or_default();
    let panels = panels(motion, recording, "time (s)", &unit.label("residual"), |axis, panel| {
        let points = times.iter().copied().zip(residuals(motion, axis, unit)).collect();
        let label = format!("±2 sd of the {} noise", noise_word(calibration));
        over_time(panel, points, noise(calibration, axis, unit).map(|sd| (label.as_str(), sd)))
    });
    let caption = caption(
        "Reading less model. Good: a band without structure about zero, of the same width everywhere, with about one \
         point in twenty outside the dashed lines. A wave or a step is an error of the model.",
        &[(
            is_thinned(motion.residuals.len()),
            "Only the smallest and the largest residual of each pixel column are drawn, so the band shows the extremes and looks \
             wider than ±2 sd.",
        )],
    );
    Figure::new("Residuals over time", panels, caption)
}

/// Residuals on one axis, and lines at two standard deviations of the noise, with the name of this.
pub(super) fn over_time(panel: Panel, points: Points, noise: Option<(&str, f64)>) -> Panel {
    let span = points.first().zip(points.last()).map(|(first, last)| [first.0, last.0]);
    let mark = match is_thinned(points.len()) {
        true => Mark::Line { width: 0.7, dashes: "" },
        false => Mark::Dots { shape: Shape::Circle, radius: 2.2 },
    };
    let mut panel = panel.with(Series::new("residual", colour::BLUE, mark, thinned(points.into_iter())));
    if let (Some((label, sd)), Some(span)) = (noise, span) {
        for level in [2.0 * sd, -2.0 * sd] {
            panel = panel.with(Series::dashed(label, colour::BLACK, span.map(|t| (t, level)).to_vec()));
        }
    }
    panel
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
            let area = values.len() as f64 * bins.width;
            // the bars stay visible below the curve of a noise that is far too small
            let highest = HIGHEST_CURVE * bins.most() as f64;
            if area / (sd * TAU.sqrt()) > highest {
                panel.y_shown = Some((0.0, highest));
            }
            let label = format!("normal curve of the {} noise", noise_word(calibration));
            let curve = normal_curve(area, sd, reach.min(6.0 * sd));
            panel = panel.with(Series::line(&label, colour::VERMILLION, curve));
        }
        panel
    });
    let caption = caption(
        "Good: the bars follow the curve. Narrower bars mean that the noise is smaller than assumed. Wider bars mean that it \
         is larger, or that the model has an error. Long tails are outliers.",
        &[(
            panels.iter().any(|panel| panel.y_shown.is_some()),
            "The top of the curve is beyond the axis: the residuals are far larger than the noise.",
        )],
    );
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
        let stems: Points = (1..).map(f64::from).zip(correlation).collect();
        let Some(last) = stems.last().map(|stem| stem.0) else { return panel };
        let bound = 1.96 / (values.len() as f64).sqrt();
        let band = vec![(0.0, 0.0), (last + 1.0, 0.0)];
        panel.y_includes = vec![-2.0 * bound, 2.0 * bound];
        panel
            .with(Series::band("95 % band of white noise", colour::ORANGE, band, vec![bound; 2]))
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
    Panel::by_axis(recording.active_axes(), x_label, y_label, |axis, panel| {
        fill(axis, Panel { when_empty: empty.to_string(), ..panel })
    })
}

fn unit_of(calibration: &Calibration) -> DisplayUnit {
    let rms = calibration.fit.residual_rms.unwrap_or_else(Vector3::zeros);
    DisplayUnit::suited_to(
        calibration.unit(SensorKind::Accelerometer).symbol(),
        rms.iter().map(|rms| 3.0 * rms),
    )
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
    fn autocorrelation_of_an_alternating_series_alternates() {
        let values: Vec<f64> = (0..1000).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let r = autocorrelation(&values, 2);
        assert!((r[0] + 0.999).abs() < 1e-12 && (r[1] - 0.998).abs() < 1e-12);
        assert!(autocorrelation(&[1.0; 9], 2).is_empty() && autocorrelation(&[], 0).is_empty());
    }
}
