//! Figures as data: panels of series with a title, a legend and a caption, drawn at the very end.
//!
//! A [`Figure`] becomes one `<figure>`: panels beside each other where there is room and below each other where there is
//! not, each its own SVG that scales with its column, so that letters stay legible on a phone. The legend is made from the
//! series themselves. [`draw`] is the only place that knows the plotting library.

mod allan;
mod before_after;
mod correlation;
mod design_population;
mod draw;
mod ellipse;
mod holds;
mod motion;
mod motion_pair;
mod panel;
mod population;
mod residuals;
mod rotations;
mod sphere;
mod starts;
mod still;
mod surface;
mod sweep;
mod temperature;
mod thin;
mod unit;
mod validation;

pub(super) use allan::allan_figure;
pub(super) use before_after::{force_before_and_after, holds_before_and_after, imu_before_and_after};
pub(super) use correlation::{correlation_map, correlation_map_of};
pub(super) use design_population::{absolute_errors, optimal_motions, traces};
pub(super) use draw::renumbered;
pub(super) use ellipse::confidence_ellipses;
pub(super) use holds::{hold_residuals, recording_overview};
pub(super) use motion::{acceleration_figure, motion_error_figure, state_and_jerk_figure};
pub(super) use motion_pair::{Drawn, jerk_and_acceleration, states, velocity_and_displacement};
pub(super) use population::{p_values, parameter_errors, parameters_against_truth, standardised_errors};
pub(super) use residuals::{autocorrelations, histograms, residuals_over_time};
pub(super) use rotations::rotation_errors;
pub(super) use sphere::hold_directions;
pub(super) use starts::start_values;
pub(super) use still::still_gyroscope;
pub(super) use surface::trace_map;
pub(super) use sweep::sweep_curves;
pub(super) use temperature::bias_over_temperature;
pub(super) use unit::DisplayUnit;
pub(super) use validation::validation_errors;

use super::html::escape;
use panel::{Panel, Series};
use rayon::prelude::*;

/// Okabe–Ito colours, told apart by all common kinds of colour vision.
mod colour {
    pub(super) const BLACK: &str = "#000000";
    pub(super) const ORANGE: &str = "#e69f00";
    pub(super) const SKY: &str = "#56b4e9";
    pub(super) const GREEN: &str = "#009e73";
    pub(super) const BLUE: &str = "#0072b2";
    pub(super) const VERMILLION: &str = "#d55e00";
    pub(super) const GREY: &str = "#6e7781";
}

/// A figure: panels that belong together.
#[derive(Debug)]
pub(super) struct Figure {
    title: String,
    caption: String,
    panels: Vec<Panel>,
    columns: usize,
}

impl Figure {
    fn new(title: impl Into<String>, panels: Vec<Panel>, caption: impl Into<String>) -> Self {
        let columns = panels.len().clamp(1, 3);
        Self { title: title.into(), caption: caption.into(), panels, columns }
    }

    fn with_columns(mut self, columns: usize) -> Self {
        self.columns = columns;
        self
    }

    /// The figure as HTML.
    pub(super) fn html(&self) -> String {
        let panels: Vec<String> = self.panels.par_iter().map(draw::svg).collect();
        framed(&self.title, &self.legend(), &panels.concat(), self.columns, &self.caption)
    }

    fn legend(&self) -> String {
        let mut seen: Vec<&Series> = Vec::new();
        for series in self.panels.iter().flat_map(|panel| &panel.series) {
            if !series.label.is_empty() && seen.iter().all(|other| other.label != series.label) {
                seen.push(series);
            }
        }
        let mut entries: Vec<String> =
            seen.iter().map(|series| entry(&draw::key(series), &series.label)).collect();
        let mut shades: Vec<&str> = Vec::new();
        for shade in self.panels.iter().flat_map(|panel| &panel.shades) {
            if !shade.label.is_empty() && !shades.contains(&shade.label) {
                shades.push(shade.label);
                entries.push(entry(&draw::shade_key(shade.colour), shade.label));
            }
        }
        format!("<ul class=\"legend\">{}</ul>", entries.concat())
    }
}

/// Figures as HTML, side by side, as drawing is what a report waits for; nothing for those that there is no occasion for.
pub(super) fn drawn<const N: usize>(figures: [&(dyn Fn() -> Option<Figure> + Sync); N]) -> [String; N] {
    let mut html = figures.map(|_| String::new());
    html.par_iter_mut().zip(figures).for_each(|(html, figure)| {
        *html = figure().map_or_else(String::new, |figure| figure.html());
    });
    html
}

fn entry(key: &str, label: &str) -> String {
    format!("<li>{key}{}</li>", escape(label))
}

/// Title, legend, panels and caption in their frame.
fn framed(title: &str, legend: &str, panels: &str, columns: usize, caption: &str) -> String {
    let class = match columns {
        1 => "panels one",
        2 => "panels two",
        _ => "panels",
    };
    format!(
        "<figure><h3>{}</h3>{legend}<div class=\"{class}\">{panels}</div><figcaption>{}</figcaption></figure>",
        escape(title),
        escape(caption)
    )
}
