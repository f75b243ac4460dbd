//! Panels as SVG: axes, and what is drawn within them. `chart.js` reads the drawings.

use super::drawing::opened;
use super::map;
use super::panel::{Map, Mark, Panel, Series, Shape};
use super::scale::{Scale, number};
use crate::html::escape;

/// Width of a panel in SVG units. A column of a wide page, or a phone, is about as many pixels wide.
pub(super) const WIDTH: f64 = 400.0;
const HEIGHT: f64 = 270.0;
const SQUARE_HEIGHT: f64 = 400.0;
/// Makes a map nearly a square, beside the bar of its colours.
const MAP_HEIGHT: f64 = 300.0;
/// Room for the bar of a map's colours, and its numbers.
const COLOURS: f64 = 70.0;
/// Width of a digit at the size of the ticks' labels.
const DIGIT: f64 = 6.7;
/// Colour of axes and ticks.
const AXIS: &str = "#424a53";
const GRID: &str = "#e3e7eb";

/// Height of a panel in SVG units.
pub(super) fn height(panel: &Panel) -> f64 {
    match panel.map {
        Some(_) => MAP_HEIGHT,
        None if panel.square => SQUARE_HEIGHT,
        None => HEIGHT,
    }
}

/// The panel as an SVG that takes the width of its column.
pub(super) fn svg(panel: &Panel) -> String {
    let height = height(panel);
    let Some([x, y]) = panel.axes() else {
        return nothing(panel, height);
    };
    let (x, y) = (Scale::new(x, panel.log_x), Scale::new(y, panel.log_y));
    let widest =
        |scale: &Scale| scale.ticks().iter().map(|tick| tick.1.chars().count()).max().unwrap_or(0) as f64;
    let top = if panel.title.is_empty() { 10.0 } else { 42.0 };
    let right = 6.6 + 0.5 * DIGIT * widest(&x) + if panel.map.is_some() { COLOURS } else { 0.0 };
    let x = x.drawn(37.0 + DIGIT * widest(&y), WIDTH - right);
    let y = y.drawn(height - 50.0, top);

    let (mut ranges, mut inside) = (format!(" data-x=\"{x}\" data-y=\"{y}\""), String::new());
    if panel.square || panel.map.is_some() {
        ranges.clear();
    }
    if !panel.x_names.is_empty() {
        ranges += &format!(" data-names=\"{}\"", crate::html::address(panel.x_names));
    }
    for shade in &panel.shades {
        let (from, to) = (x.at(shade.from), x.at(shade.to));
        inside += &rectangle(
            [from, y.to, to - from, y.from - y.to],
            &format!("fill=\"{}\" opacity=\"0.3\"", shade.colour),
        );
    }
    let colours = panel.map.as_ref().map_or_else(String::new, |map| {
        inside += &map::cells(map, &x, &y);
        colour_bar(map, x.to + 16.0, &y)
    });
    panel.series.iter().for_each(|series| drawing(panel, series, &x, &y, &mut inside));
    let (left, wide, high) = (number(x.from), number(x.to - x.from), number(y.from - y.to));
    let attributes = format!(" fill=\"#1b1f24\"{ranges}");
    format!(
        "{}<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>{}{colours}<svg x=\"{left}\" y=\"{top}\" width=\"{wide}\" height=\"{high}\" viewBox=\"{left} {top} {wide} {high}\">{inside}</svg></svg>",
        opened([0.0, 0.0, WIDTH, height], &panel.title, &attributes),
        axes(panel, &x, &y, height)
    )
}

/// Grid, axes, ticks, and their labels. What moves with a zoom is in the group `x`.
fn axes(panel: &Panel, x: &Scale, y: &Scale, height: f64) -> String {
    let (left, right, top, bottom) = (number(x.from), number(x.to), number(y.to), number(y.from));
    let middle = number(0.5 * (x.from + x.to));
    let [mut across, mut below, mut beside, mut grid, mut ticks, mut ticks_of_y] = <[String; 6]>::default();
    for (value, label) in x.ticks() {
        let at = number(x.at(value));
        across += &format!("M{at} {bottom}V{top}");
        ticks += &format!("M{at} {bottom}v5");
        below += &format!("<text x=\"{at}\" y=\"{}\">{label}</text>", number(y.from + 16.0));
    }
    for (value, label) in y.ticks() {
        let at = y.at(value);
        grid += &format!("M{left} {}H{right}", number(at));
        ticks_of_y += &format!("M{left} {}h-5", number(at));
        beside += &format!("<text x=\"{}\" y=\"{}\">{label}</text>", number(x.from - 8.0), number(at + 4.4));
    }
    let beside_axis = format!("15 {}", number(0.5 * (y.from + y.to)));
    let [title, x_label, y_label] = [&panel.title, &panel.x_label, &panel.y_label].map(|text| escape(text));
    format!(
        "<path d=\"{grid}\" stroke=\"{GRID}\" stroke-width=\"0.8\"/>\
         <g class=\"x\" font-size=\"12\" text-anchor=\"middle\"><path d=\"{across}\" stroke=\"{GRID}\" stroke-width=\"0.8\"/><path d=\"{ticks}\" stroke=\"{AXIS}\"/>{below}</g>\
         <path d=\"M{left} {top}V{bottom}H{right}{ticks_of_y}\" stroke=\"{AXIS}\" fill=\"none\"/><g font-size=\"12\" text-anchor=\"end\">{beside}</g>\
         <g text-anchor=\"middle\"><text x=\"{middle}\" y=\"{}\" font-size=\"13\">{x_label}</text>\
         <text transform=\"translate({beside_axis}) rotate(-90)\" font-size=\"13\">{y_label}</text><text x=\"{middle}\" y=\"26\" font-size=\"15\">{title}</text></g>",
        height - 7.0
    )
}

/// The bar of a map's colours, with the values at their edges.
fn colour_bar(map: &Map, left: f64, y: &Scale) -> String {
    let (bands, high) = (map.levels.len().saturating_sub(1), y.from - y.to);
    let step = high / bands.max(1) as f64;
    let mut bar = String::new();
    for (k, level) in map.levels.iter().enumerate() {
        let edge = y.from - step * k as f64;
        if k < bands {
            let fill = format!("fill=\"{}\"", map::colour(k, bands));
            bar += &rectangle([left, edge - step, 14.0, step], &fill);
        }
        let label = crate::number_format::tick(*level);
        bar += &format!(
            "<text x=\"{}\" y=\"{}\" font-size=\"12\">{label}</text>",
            number(left + 19.0),
            number(edge + 4.4)
        );
    }
    let label = escape(map.label);
    format!(
        "{bar}<text x=\"{}\" y=\"{}\" font-size=\"12\" text-anchor=\"end\">{label}</text>",
        WIDTH - 4.0,
        number(y.from + 32.0)
    )
}

fn rectangle([left, top, wide, high]: [f64; 4], attributes: &str) -> String {
    let [left, top, wide, high] = [left, top, wide, high].map(number);
    format!("<rect x=\"{left}\" y=\"{top}\" width=\"{wide}\" height=\"{high}\" {attributes}/>")
}

/// Adds the drawing of a series.
fn drawing(panel: &Panel, series: &Series, x: &Scale, y: &Scale, out: &mut String) {
    let colour = series.colour;
    let seen = || series.finite().filter(|&(x, y, _)| panel.shows(x, y));
    let place = |at: f64, value: f64| format!("{} {}", number(x.at(at)), number(y.at(value)));
    let path = |points: Vec<String>| format!("M{}", points.join("L"));
    let points = || seen().map(|(at, value, _)| place(at, value)).collect::<Vec<_>>();
    let stroke = |path: String, width: f64, dashes: &str| {
        let dashes =
            if dashes.is_empty() { String::new() } else { format!(" stroke-dasharray=\"{dashes}\"") };
        format!("<path d=\"{path}\" stroke=\"{colour}\" stroke-width=\"{width}\" fill=\"none\"{dashes}/>")
    };
    let filled = |path: String, opacity: f64| {
        format!("<path d=\"{path}Z\" fill=\"{colour}\" fill-opacity=\"{opacity}\"/>")
    };
    let (Some(first), Some(last)) = (seen().next(), seen().last()) else { return };
    match series.mark {
        Mark::Line { width, dashes } => *out += &stroke(path(points()), width, dashes),
        Mark::Dots { shape, radius } => {
            out.extend(seen().map(|(at, value, _)| marker(shape, colour, [x.at(at), y.at(value)], radius)))
        }
        Mark::Band => {
            let lower = seen()
                .map(|(at, value, spread)| place(at, value - spread))
                .collect::<Vec<_>>()
                .into_iter()
                .rev();
            *out += &filled(
                path(seen().map(|(at, value, spread)| place(at, value + spread)).chain(lower).collect()),
                0.25,
            );
        }
        Mark::Area => {
            let below = [last, first].map(|(at, ..)| place(at, y.low.max(0.0)));
            *out += &filled(path(points().into_iter().chain(below).collect()), 0.35);
            *out += &stroke(path(points()), 1.2, "");
        }
        Mark::ErrorBars | Mark::Ranges { .. } => {
            let width = if let Mark::Ranges { width } = series.mark { width } else { 1.1 };
            out.extend(seen().map(|(at, value, spread)| {
                stroke(path(vec![place(at, value - spread), place(at, value + spread)]), width, "")
            }));
        }
        // one line that returns to zero between the stems: it draws the zero line too
        Mark::Stems => {
            let stem = |(at, value, _)| [place(at, 0.0), place(at, value), place(at, 0.0)];
            *out += &stroke(path(seen().flat_map(stem).collect()), 1.5, "");
        }
    }
}

/// A marker in the middle of `2 radius` units.
fn marker(shape: Shape, colour: &str, [x, y]: [f64; 2], radius: f64) -> String {
    let [left, right, top, bottom] = [x - radius, x + radius, y - radius, y + radius].map(number);
    match shape {
        Shape::Circle => {
            format!("<circle cx=\"{}\" cy=\"{}\" r=\"{radius}\" fill=\"{colour}\"/>", number(x), number(y))
        }
        Shape::Square => {
            rectangle([x - radius, y - radius, 2.0 * radius, 2.0 * radius], &format!("fill=\"{colour}\""))
        }
        Shape::Triangle => {
            format!("<path d=\"M{} {top}L{right} {bottom}H{left}Z\" fill=\"{colour}\"/>", number(x))
        }
        Shape::Cross => format!(
            "<path d=\"M{left} {top}L{right} {bottom}M{right} {top}L{left} {bottom}\" stroke=\"{colour}\" stroke-width=\"1.5\" fill=\"none\"/>"
        ),
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
        Mark::Dots { shape, .. } => marker(shape, colour, [17.0, 7.0], 3.5),
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
