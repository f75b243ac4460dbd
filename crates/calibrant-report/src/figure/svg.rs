//! Panels as SVG: the only file that knows the plotting library.

use super::drawing::{FONT, opened};
use super::panel::{Map, Mark, Panel, Series, Shape};
use crate::html::escape;
use crate::number_format::{self, fixed};
use kuva::prelude::{Layout, LinePlot, LineStyle, MarkerShape, Plot, ScatterPlot, Theme};
use kuva::{TickFormat, plot::BandPlot, plot::ContourPlot, render::annotations::ShadedRegion};
use std::sync::Arc;

/// Width of a panel in SVG units. A column of a wide page, or a phone, is about as many pixels wide.
const WIDTH: f64 = 400.0;
const HEIGHT: f64 = 270.0;
const SQUARE_HEIGHT: f64 = 400.0;
/// Makes a map nearly a square, beside the bar of its colours.
const MAP_HEIGHT: f64 = 300.0;
/// The panel as an SVG that takes the width of its column.
pub(super) fn svg(panel: &Panel) -> String {
    let height = match panel.map {
        Some(_) => MAP_HEIGHT,
        None if panel.square => SQUARE_HEIGHT,
        None => HEIGHT,
    };
    let Some(axes) = panel.axes() else {
        return nothing(panel, height);
    };
    let [x, y] = axes.map(|axis| axis.range);
    let mut plots: Vec<Plot> = panel.map.iter().map(contours).collect();
    plots.extend(panel.series.iter().flat_map(|series| self::plots(panel, series)));
    let mut layout = Layout::new(x, y)
        .with_width(WIDTH)
        .with_height(height)
        .with_x_label(panel.x_label.as_str())
        .with_y_label(panel.y_label.as_str())
        .with_theme(theme())
        .with_title_size(15)
        .with_label_size(13)
        .with_tick_size(12)
        .with_ticks(5)
        .with_tick_format(TickFormat::Custom(Arc::new(move |value| tick(value, x))))
        .with_x_axis_min(x.0)
        .with_x_axis_max(x.1)
        .with_y_axis_min(y.0)
        .with_y_axis_max(y.1)
        .with_grid_line_width(0.8);
    if !panel.title.is_empty() {
        layout = layout.with_title(panel.title.as_str());
    }
    if let Some(step) = axes[0].step {
        layout = layout.with_x_tick_step(step);
    }
    if let Some(step) = axes[1].step {
        layout = layout.with_y_tick_step(step);
    }
    if panel.log_x {
        layout = layout.with_log_x();
    }
    if panel.log_y {
        layout = layout.with_log_y();
    }
    layout.show_colorbar = panel.map.is_some();
    layout.colorbar_tick_format = TickFormat::Custom(Arc::new(crate::number_format::tick));
    for shade in &panel.shades {
        layout = layout.with_shaded_region(
            ShadedRegion::vertical(shade.from, shade.to).with_color(shade.colour).with_opacity(0.3),
        );
    }
    let axis = |(low, high): (f64, f64), log: bool| format!("{low} {high}{}", if log { " 1" } else { "" });
    let ranges = format!(" data-x=\"{}\" data-y=\"{}\"", axis(x, panel.log_x), axis(y, panel.log_y));
    responsive(
        &kuva::render_to_svg(plots, layout),
        height,
        &panel.title,
        if panel.square || panel.map.is_some() { "" } else { &ranges },
    )
}

/// A tick's label. Where the x axis is far from zero, as in seconds since 1970, six digits do not distinguish
/// its ticks.
fn tick(value: f64, x: (f64, f64)) -> String {
    let (span, most) = (x.1 - x.0, x.0.abs().max(x.1.abs()));
    if span > 1e-3 * most || !(x.0..=x.1).contains(&value) {
        return number_format::tick(value);
    }
    let decimals = (1.0 - span.log10()).ceil().clamp(0.0, 9.0) as usize;
    fixed(value, decimals)
}

fn theme() -> Theme {
    Theme {
        axis_color: "#424a53".into(),
        tick_color: "#424a53".into(),
        grid_color: "#e3e7eb".into(),
        text_color: "#1b1f24".into(),
        font_family: Some(FONT.into()),
        ..Theme::light()
    }
}

fn contours(map: &Map) -> Plot {
    let grid = ContourPlot::new().with_grid(map.values.clone(), map.x.clone(), map.y.clone());
    grid.with_levels(&map.levels).with_filled().with_line_width(0.5).with_legend(map.label).into()
}

fn plots(panel: &Panel, series: &Series) -> Vec<Plot> {
    let drawn = || series.finite().filter(|&(x, y, _)| panel.shows(x, y));
    let line = |points: Vec<(f64, f64)>, width: f64, dashes: &str| {
        let style = if dashes.is_empty() { LineStyle::Solid } else { LineStyle::Custom(dashes.to_string()) };
        LinePlot::new()
            .with_data(points)
            .with_color(series.colour)
            .with_stroke_width(width)
            .with_line_style(style)
    };
    let points: Vec<(f64, f64)> = drawn().map(|(x, y, _)| (x, y)).collect();
    if points.is_empty() {
        return Vec::new();
    }
    match series.mark {
        Mark::Line { width, dashes } => vec![line(points, width, dashes).into()],
        Mark::Dots { shape, radius } => vec![
            ScatterPlot::new()
                .with_data(points)
                .with_color(series.colour)
                .with_size(radius)
                .with_marker(match shape {
                    Shape::Circle => MarkerShape::Circle,
                    Shape::Square => MarkerShape::Square,
                    Shape::Triangle => MarkerShape::Triangle,
                    Shape::Cross => MarkerShape::Cross,
                })
                .into(),
        ],
        Mark::Band => {
            let (low, high): (Vec<f64>, Vec<f64>) = drawn().map(|(_, y, s)| (y - s, y + s)).unzip();
            let x: Vec<f64> = points.iter().map(|point| point.0).collect();
            vec![BandPlot::new(x, low, high).with_color(series.colour).with_opacity(0.25).into()]
        }
        Mark::Area => vec![line(points, 1.2, "").with_fill().with_fill_opacity(0.35).into()],
        Mark::ErrorBars | Mark::Ranges { .. } => {
            let width = if let Mark::Ranges { width } = series.mark { width } else { 1.1 };
            drawn().map(|(x, y, s)| line(vec![(x, y - s), (x, y + s)], width, "").into()).collect()
        }
        // one line that returns to zero between the stems: it draws the zero line too
        Mark::Stems => {
            let path = points.iter().flat_map(|&(x, y)| [(x, 0.0), (x, y), (x, 0.0)]).collect();
            vec![line(path, 1.5, "").into()]
        }
    }
}

/// Width of the thinnest line in a legend: a single hairline is hardly seen.
const LEAST_KEY_WIDTH: f64 = 1.5;

/// The series' sign in a legend.
pub(super) fn key(series: &Series) -> String {
    let colour = series.colour;
    match series.mark {
        Mark::Line { width, dashes } => format!(
            "<path d=\"M1 7H33\" stroke=\"{colour}\" stroke-width=\"{}\" stroke-dasharray=\"{dashes}\"/>",
            width.max(LEAST_KEY_WIDTH)
        ),
        Mark::Dots { shape, .. } => match shape {
            Shape::Circle => format!("<circle cx=\"17\" cy=\"7\" r=\"3.5\" fill=\"{colour}\"/>"),
            Shape::Square => {
                format!("<rect x=\"13.5\" y=\"3.5\" width=\"7\" height=\"7\" fill=\"{colour}\"/>")
            }
            Shape::Triangle => format!("<path d=\"M17 2.5L21.5 11H12.5Z\" fill=\"{colour}\"/>"),
            Shape::Cross => {
                format!("<path d=\"M13 3L21 11M21 3L13 11\" stroke=\"{colour}\" stroke-width=\"1.6\"/>")
            }
        },
        Mark::Band => {
            format!("<rect x=\"1\" y=\"2\" width=\"32\" height=\"10\" fill=\"{colour}\" opacity=\"0.3\"/>")
        }
        Mark::Area => format!(
            "<rect x=\"1\" y=\"2\" width=\"32\" height=\"10\" fill=\"{colour}\" fill-opacity=\"0.35\" stroke=\"{colour}\"/>"
        ),
        Mark::ErrorBars => format!("<path d=\"M17 1V13\" stroke=\"{colour}\" stroke-width=\"1.4\"/>"),
        Mark::Ranges { width } => {
            format!("<path d=\"M17 1V13\" stroke=\"{colour}\" stroke-width=\"{width}\"/>")
        }
        Mark::Stems => {
            format!("<path d=\"M1 12H33M8 12V2M17 12V6M26 12V8\" stroke=\"{colour}\" stroke-width=\"1.5\"/>")
        }
    }
}

/// The sign of a shaded interval in a legend.
pub(super) fn shade_key(colour: &str) -> String {
    format!("<rect x=\"1\" y=\"1\" width=\"32\" height=\"12\" fill=\"{colour}\" opacity=\"0.3\"/>")
}

/// An SVG of fixed size made to follow its column, named for screen readers, its numbers shortened, with further attributes.
fn responsive(svg: &str, height: f64, name: &str, attributes: &str) -> String {
    let body = svg.find('>').map_or("", |end| &svg[end + 1..]);
    let body = match (body.find("<!--"), body.find("-->")) {
        (Some(start), Some(end)) if start < end => format!("{}{}", &body[..start], &body[end + 3..]),
        _ => body.to_string(),
    };
    let attributes = format!(" fill=\"#1b1f24\"{attributes}");
    opened([0.0, 0.0, WIDTH, height], name, &attributes) + &shortened(&body)
}

/// Drops decimals beyond the second within tags: the plotting library writes some coordinates as
/// 123.45000000000002.
fn shortened(svg: &str) -> String {
    let mut short = String::with_capacity(svg.len());
    let (mut decimals, mut after_point, mut in_tag, mut kept) = (0, false, false, 0);
    for (at, byte) in svg.bytes().enumerate() {
        if byte.is_ascii_digit() {
            decimals += usize::from(after_point);
            if in_tag && decimals > 2 {
                short.push_str(&svg[kept..at]);
                kept = at + 1;
            }
        } else {
            in_tag = byte == b'<' || (in_tag && byte != b'>');
            after_point = byte == b'.';
            decimals = 0;
        }
    }
    short.push_str(&svg[kept..]);
    short
}

fn nothing(panel: &Panel, height: f64) -> String {
    let middle = WIDTH / 2.0;
    let opened = opened([0.0, 0.0, WIDTH, height], &panel.title, " text-anchor=\"middle\"");
    format!(
        "{opened}<rect x=\"0.5\" y=\"0.5\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#d8dee4\"/><text x=\"{middle}\" y=\"22\" font-size=\"15\">{}</text>\
         <text x=\"{middle}\" y=\"{}\" font-size=\"13\" fill=\"#57606a\">{}</text></svg>",
        WIDTH - 1.0,
        height - 1.0,
        escape(&panel.title),
        height / 2.0,
        escape(&panel.when_empty)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_far_from_zero_are_told_apart() {
        let epoch = (1_700_000_000.0, 1_700_000_166.0);
        assert_eq!(tick(1_700_000_040.0, epoch), "1700000040");
        assert_eq!(tick(0.5, epoch), "0.5", "of the other axis");
        assert_eq!(tick(1e-12 + 9.80, (9.8, 9.802)), "9.8000");
        assert_eq!(tick(40.0, (0.0, 166.0)), "40");
    }
}
