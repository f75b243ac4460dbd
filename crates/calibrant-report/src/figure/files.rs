//! A figure as files: one drawing with its title and legend, and the values in it.

use super::drawing::FONT;
use super::frame::Figure;
use super::svg;
use crate::html::escape;
use std::fmt::Write;

/// Room above the panels, and of a line of the legend.
const TITLE: f64 = 34.0;
const LINE: f64 = 22.0;

/// A figure for a paper, or for a program of the reader's own.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FigureFiles {
    /// Its title.
    pub title: String,
    /// The drawing, SVG.
    pub svg: String,
    /// The values that it shows, CSV: panel, labels of the axes, series, x, y, half width of a bar or a band.
    pub csv: String,
}

/// What a page draws, and `--figures` writes.
pub(crate) trait Drawable {
    /// As a part of a page.
    fn html(&self) -> String;
    /// As files.
    fn files(&self) -> FigureFiles;
}

/// Drawings in rows, each with its size, with the title above and the legend below: signs with their labels.
pub(super) fn standalone(
    title: &str,
    drawings: &[(String, [f64; 2])],
    signs: &[(String, String)],
    columns: usize,
) -> String {
    let wide = drawings.iter().map(|(_, [width, _])| *width).fold(0.0, f64::max);
    let (mut drawn, mut top) = (String::new(), TITLE);
    for row in drawings.chunks(columns) {
        for (column, (drawing, [width, height])) in row.iter().enumerate() {
            let x = column as f64 * wide;
            let place = format!("<svg x=\"{x}\" y=\"{top}\" width=\"{width}\" height=\"{height}\"");
            drawn += &drawing.replacen("<svg", &place, 1);
        }
        top += row.iter().map(|(_, [_, height])| *height).fold(0.0, f64::max);
    }
    for (number, (sign, label)) in signs.iter().enumerate() {
        let x = (number % columns) as f64 * wide + 40.0;
        let y = top + (number / columns) as f64 * LINE;
        let _ = write!(
            drawn,
            "<svg x=\"{x}\" y=\"{y}\" width=\"34\" height=\"14\" viewBox=\"0 0 34 14\" fill=\"none\">{sign}</svg><text x=\"{}\" y=\"{}\" font-size=\"13\">{}</text>",
            x + 42.0,
            y + 12.0,
            escape(label)
        );
    }
    let (width, height) = (columns as f64 * wide, top + LINE * signs.len().div_ceil(columns) as f64 + 6.0);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" font-family=\"{FONT}\" fill=\"#1b1f24\"><rect width=\"100%\" height=\"100%\" fill=\"#fff\"/><text x=\"{}\" y=\"22\" font-size=\"17\" text-anchor=\"middle\">{}</text>{drawn}</svg>\n",
        width / 2.0,
        escape(title)
    )
}

/// A text as a field of CSV.
pub(super) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

impl Drawable for Figure {
    fn html(&self) -> String {
        self.html()
    }

    fn files(&self) -> FigureFiles {
        let drawings: Vec<_> =
            self.panels.iter().map(|panel| (svg::svg(panel), [svg::WIDTH, svg::height(panel)])).collect();
        let svg = standalone(&self.title, &drawings, &self.signs(), self.columns);
        FigureFiles { title: self.title.clone(), svg, csv: self.values() }
    }
}

impl Figure {
    fn values(&self) -> String {
        let mut csv = String::from("panel,x_label,y_label,series,x,y,half_width\n");
        for panel in &self.panels {
            let labels = [&panel.title, &panel.x_label, &panel.y_label].map(|text| quoted(text)).join(",");
            for series in &panel.series {
                let label = quoted(&series.label);
                for (x, y, half_width) in series.finite() {
                    let _ = writeln!(csv, "{labels},{label},{x:?},{y:?},{half_width:?}");
                }
            }
            for shade in &panel.shades {
                let label = quoted(shade.label);
                for x in [shade.from, shade.to] {
                    let _ = writeln!(csv, "{labels},{label},{x:?},,");
                }
            }
        }
        csv
    }
}
