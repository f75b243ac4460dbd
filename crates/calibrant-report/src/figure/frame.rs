//! The frame of a figure: panels with title, legend and caption, as HTML.

use super::drawing::legend;
use super::panel::{Panel, Series};
use super::svg;
use crate::html::escape;
use rayon::prelude::*;

/// A figure: panels that belong together.
#[derive(Debug, Clone)]
pub(crate) struct Figure {
    pub(super) title: String,
    caption: String,
    pub(super) panels: Vec<Panel>,
    pub(super) columns: usize,
}

impl Figure {
    pub(super) fn new(title: impl Into<String>, panels: Vec<Panel>, caption: impl Into<String>) -> Self {
        let columns = panels.len().clamp(1, 3);
        Self { title: title.into(), caption: caption.into(), panels, columns }
    }

    pub(super) fn with_columns(mut self, columns: usize) -> Self {
        self.columns = columns;
        self
    }

    pub(crate) fn html(&self) -> String {
        let panels: Vec<String> = self.panels.par_iter().map(svg::svg).collect();
        framed(&self.title, &self.legend(), &panels.concat(), self.columns, &self.caption)
    }

    fn legend(&self) -> String {
        legend(&self.signs())
    }

    /// The lines of the legend, each once: the sign of a series or a shaded interval, and its label.
    pub(super) fn signs(&self) -> Vec<(String, String)> {
        let mut seen: Vec<&Series> = Vec::new();
        for series in self.panels.iter().flat_map(|panel| &panel.series) {
            if !series.label.is_empty() && seen.iter().all(|other| other.label != series.label) {
                seen.push(series);
            }
        }
        let mut signs: Vec<_> = seen.iter().map(|series| (svg::key(series), series.label.clone())).collect();
        for shade in self.panels.iter().flat_map(|panel| &panel.shades) {
            let sign = (svg::shade_key(shade.colour), shade.label.to_owned());
            if !signs.contains(&sign) {
                signs.push(sign);
            }
        }
        signs
    }
}

/// A caption, with those of further sentences that apply.
pub(super) fn caption(always: &str, further: &[(bool, &str)]) -> String {
    let further = further.iter().filter(|(applies, _)| *applies).map(|(_, sentence)| *sentence);
    std::iter::once(always).chain(further).collect::<Vec<_>>().join(" ")
}

/// Figures as HTML, drawn in parallel, since a report mostly waits for drawing. Nothing for a figure that is
/// `None`.
pub(crate) fn drawn<const N: usize>(figures: [&(dyn Fn() -> Option<Figure> + Sync); N]) -> [String; N] {
    let mut html = figures.map(|_| String::new());
    html.par_iter_mut().zip(figures).for_each(|(html, figure)| {
        *html = figure().map_or_else(String::new, |figure| figure.html());
    });
    html
}

/// Title, legend, panels and caption in their frame.
pub(super) fn framed(title: &str, legend: &str, panels: &str, columns: usize, caption: &str) -> String {
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
