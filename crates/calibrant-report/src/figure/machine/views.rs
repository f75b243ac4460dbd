//! The machine from the front, from the side and from above.

use super::scene::{Scene, without_gaps};
use crate::figure::colour;
use crate::figure::drawing::{self, opened, stroke};
use crate::figure::frame::framed;
use crate::figure::view::{View, round_step};
use crate::number_format::tick;
use nalgebra::Vector3;

/// Left edge, top edge and side of the plot.
const PLOT: (f64, f64, f64) = (52.0, 28.0, 336.0);
const SIZE: (f64, f64) = (400.0, 410.0);

/// Three views at one scale, with the path of the tip and a few postures.
pub(crate) fn three_views(scene: &Scene) -> String {
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    let panels = [
        panel(scene, "front, seen along y", x, z, ["x (m)", "z (m)"]),
        panel(scene, "side, seen against x", y, z, ["y (m)", "z (m)"]),
        panel(scene, "top, seen against z", x, y, ["x (m)", "y (m)"]),
    ];
    let caption = "All three at one scale, in the axes of the base. Good: the tip moves and turns in all directions. What the motion does not excite, it does not determine.";
    let (title, caption) = match scene.is_chain {
        true => ("The arm", format!("{caption} The arm is drawn at five times.")),
        false => ("The tracked body", format!("{caption} The body's axes are drawn at five times.")),
    };
    framed(title, &legend(scene.is_chain), &panels.concat(), 3, &caption)
}

pub(super) fn legend(is_chain: bool) -> String {
    let line = |colour: &str, width: f64| stroke("M2 7H32", colour, width);
    let dot = |colour: &str| format!("<circle cx=\"17\" cy=\"7\" r=\"4\" fill=\"{colour}\"/>");
    let tip = if is_chain { "tip" } else { "body" };
    let mut entries = Vec::new();
    if is_chain {
        entries.push((line(colour::GREY, 4.0), "links".to_owned()));
        entries.push((dot(colour::BLACK), "base".to_owned()));
    }
    entries.push((line(colour::SKY, 1.2), format!("path of the {tip}")));
    for (axis, colour) in ["x", "y", "z"].iter().zip(colour::AXES) {
        entries.push((line(colour, 2.0), format!("its {axis}")));
    }
    entries.push((dot(SENSOR), "sensor".to_owned()));
    drawing::legend(&entries)
}

/// Colour of the sensor and its lever arm.
pub(super) const SENSOR: &str = colour::PURPLE;

fn panel(scene: &Scene, title: &str, right: Vector3<f64>, up: Vector3<f64>, labels: [&str; 2]) -> String {
    let (left, top, side) = PLOT;
    let half = 1.12 * scene.half.max();
    let view = View {
        right,
        up,
        centre: scene.centre,
        middle: (left + side / 2.0, top + side / 2.0),
        scale: side / (2.0 * half),
    };
    let middle = left + side / 2.0;
    let mut svg = opened([0.0, 0.0, SIZE.0, SIZE.1], title, " fill=\"#1b1f24\"");
    svg += &format!("<text x=\"{middle}\" y=\"17\" font-size=\"15\" text-anchor=\"middle\">{title}</text>");
    svg += &axes(&view, half, labels);
    svg += "<g stroke-linecap=\"round\" stroke-linejoin=\"round\">";
    for run in without_gaps(&scene.path) {
        svg += &stroke(&view.line(&run), colour::SKY, 0.8);
    }
    for posture in scene.few() {
        svg += &posture_strokes(scene, posture, &view);
    }
    if scene.is_chain {
        svg += &stroke(&view.dots([&Vector3::zeros()]), colour::BLACK, 11.0);
    }
    svg + "</g></svg>"
}

fn posture_strokes(scene: &Scene, posture: &calibrant_machine::reference::Posture, view: &View) -> String {
    let links = scene.links(posture);
    let tip = posture.tip().translation.vector;
    let ends = scene.tip_and_sensor(posture);
    let mut svg = String::new();
    if scene.is_chain {
        svg += &format!("<g opacity=\"0.55\">{}</g>", stroke(&view.line(&links), colour::GREY, 3.2));
        svg += &stroke(&view.dots(&links[1..links.len() - 1]), "#424a53", 6.0);
    }
    for (end, colour) in ends.iter().zip(colour::AXES) {
        svg += &stroke(&view.line([&tip, end]), colour, 1.6);
    }
    svg += &stroke(&view.line([&tip, &ends[3]]), SENSOR, 2.2);
    svg + &stroke(&view.dots([&ends[3]]), SENSOR, 5.5)
}

/// Frame, grid and ticks.
fn axes(view: &View, half: f64, labels: [&str; 2]) -> String {
    let (left, top, side) = PLOT;
    let (bottom, end) = (top + side, left + side);
    let step = round_step(2.0 * half, 9.0);
    let ticks = |middle: f64| {
        let first = ((middle - half) / step).ceil() as i64;
        let last = ((middle + half) / step).floor() as i64;
        (first..=last).map(move |k| k as f64 * step)
    };
    let mut svg = String::new();
    let (across, upward) = (view.right.dot(&view.centre), view.up.dot(&view.centre));
    for value in ticks(across) {
        let x = view.at(&(view.centre + view.right * (value - across))).0;
        svg += &format!(
            "<path d=\"M{x:.1} {top}V{bottom}\" stroke=\"#e3e7eb\" stroke-width=\"0.8\"/><text x=\"{x:.1}\" y=\"{}\" font-size=\"11\" text-anchor=\"middle\">{}</text>",
            bottom + 16.0,
            tick(value)
        );
    }
    for value in ticks(upward) {
        let y = view.at(&(view.centre + view.up * (value - upward))).1;
        svg += &format!(
            "<path d=\"M{left} {y:.1}H{end}\" stroke=\"#e3e7eb\" stroke-width=\"0.8\"/><text x=\"{}\" y=\"{:.1}\" font-size=\"11\" text-anchor=\"end\">{}</text>",
            left - 5.0,
            y + 4.0,
            tick(value)
        );
    }
    let [across, upward] = labels;
    let (x, y) = (left + side / 2.0, top + side / 2.0);
    svg + &format!(
        "<rect x=\"{left}\" y=\"{top}\" width=\"{side}\" height=\"{side}\" fill=\"none\" stroke=\"#424a53\"/>\
         <g font-size=\"13\" text-anchor=\"middle\"><text x=\"{x}\" y=\"{}\">{across}</text><text transform=\"translate(13 {y}) rotate(-90)\">{upward}</text></g>",
        bottom + 36.0
    )
}
