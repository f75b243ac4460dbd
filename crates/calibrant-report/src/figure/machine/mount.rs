//! The sensor on the tip, enlarged: its lever arm and its axes.

use super::views::SENSOR;
use crate::figure::colour;
use crate::figure::drawing::{opened, stroke};
use crate::figure::frame::framed;
use crate::figure::view::{View, round_step};
use crate::number_format::{fixed, tick};
use calibrant_machine::chain::SensorMount;
use nalgebra::Vector3;

const SIZE: (f64, f64) = (400.0, 330.0);

/// The tip's axes, the lever arm along each of them and as a line, and the axes of the sensor. `tip` is what carries the sensor.
pub(crate) fn sensor_on_tip(mount: &SensorMount, tip: &str) -> String {
    let lever = mount.lever_m;
    if !lever.norm().is_finite() {
        return String::new();
    }
    let size = if lever.norm() > 0.0 { lever.amax() } else { 0.01 };
    let axis = 0.55 * size;
    let corners = [Vector3::zeros(), Vector3::x() * lever.x, Vector3::new(lever.x, lever.y, 0.0), lever];
    let at_sensor = |end: Vector3<f64>| lever + mount.tip_from_sensor * end;
    let units = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut view = View::from((-50.0_f64).to_radians(), 25.0_f64.to_radians());
    let drawn: Vec<(f64, f64)> = corners
        .into_iter()
        .chain(units.map(|unit| unit * axis))
        .chain(units.map(|unit| at_sensor(unit * axis)))
        .map(|point| view.at(&point))
        .collect();
    let extent = |of: fn(&(f64, f64)) -> f64| {
        let values = drawn.iter().map(of);
        (values.clone().fold(f64::INFINITY, f64::min), values.fold(f64::NEG_INFINITY, f64::max))
    };
    let ((left, right), (top, bottom)) = (extent(|at| at.0), extent(|at| at.1));
    view.scale = ((SIZE.0 - 230.0) / (right - left)).min((SIZE.1 - 90.0) / (bottom - top));
    view.middle = (
        SIZE.0 / 2.0 - view.scale * (left + right) / 2.0,
        SIZE.1 / 2.0 - 8.0 - view.scale * (top + bottom) / 2.0,
    );
    let frame = [0.0, 0.0, SIZE.0, SIZE.1];
    let name = format!("The sensor on the {tip}");
    let mut svg = opened(frame, &name, " fill=\"#1b1f24\" stroke-linecap=\"round\"");
    let line = |from: &Vector3<f64>, to: &Vector3<f64>, colour: &str, width: f64, dashes: &str| {
        let line = stroke(&view.line([from, to]), colour, width);
        format!("<g stroke-dasharray=\"{dashes}\">{line}</g>")
    };
    for pair in corners.windows(2) {
        svg += &line(&pair[0], &pair[1], colour::GREY, 1.2, "2 4");
    }
    for ((unit, colour), name) in units.iter().zip(colour::AXES).zip(["x", "y", "z"]) {
        let (of_tip, of_sensor) = (unit * axis, at_sensor(unit * axis));
        svg += &line(&Vector3::zeros(), &of_tip, colour, 3.0, "");
        svg += &line(&lever, &of_sensor, colour, 1.8, "6 4");
        for (end, start, label) in [
            (of_tip, Vector3::zeros(), name.to_string()),
            (of_sensor, lever, format!("{name} of the sensor")),
        ] {
            let ((x, y), (x0, _)) = (view.at(&(start + (end - start) * 1.1)), view.at(&start));
            let (anchor, below) = match x - x0 {
                right if right > 2.0 => ("start", 4.0),
                left if left < -2.0 => ("end", 4.0),
                _ => ("middle", -2.0),
            };
            svg += &format!(
                "<text x=\"{x:.1}\" y=\"{:.1}\" font-size=\"12\" text-anchor=\"{anchor}\">{label}</text>",
                y + below
            );
        }
    }
    svg += &line(&Vector3::zeros(), &lever, SENSOR, 3.0, "");
    svg += &stroke(&view.dots([&lever]), SENSOR, 12.0);
    svg += &stroke(&view.dots([&Vector3::zeros()]), colour::BLACK, 8.0);
    svg += &scale_bar(&view, SIZE);
    let millimetres: Vec<String> = lever.iter().map(|x| fixed(1e3 * x, 2)).collect();
    let caption = format!(
        "The {tip}’s axes are solid, those of the sensor dashed. Lever arm in the {tip}’s axes x, y, z: {} mm, length {} mm. Dotted: its way along x, then y, then z.",
        millimetres.join(", "),
        fixed(1e3 * lever.norm(), 2)
    );
    framed("Where the sensor sits", "", &(svg + "</svg>"), 1, &caption)
}

/// A bar of a round length in a corner, with its length.
pub(super) fn scale_bar(view: &View, (_, height): (f64, f64)) -> String {
    let length_m = round_step(50.0 / view.scale, 1.0);
    let end = 14.0 + length_m * view.scale;
    let label = match length_m {
        length if length < 0.1 => format!("{} mm", tick(1e3 * length)),
        length => format!("{} m", tick(length)),
    };
    let y = height - 12.0;
    format!(
        "<path d=\"M14 {0}V{y}H{end:.1}V{0}\" fill=\"none\" stroke=\"#1b1f24\" stroke-width=\"1.4\"/><text x=\"{1:.1}\" y=\"{2}\" font-size=\"12\">{label}</text>",
        y - 6.0,
        end + 6.0,
        y + 1.0
    )
}
