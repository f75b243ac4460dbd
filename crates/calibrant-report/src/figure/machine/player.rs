//! The machine to turn and play. Without the script it is a still picture.

use super::mount::scale_bar;
use super::scene::{Scene, without_gaps};
use super::views::{SENSOR, legend};
use crate::figure::colour;
use crate::figure::drawing::opened;
use crate::figure::view::{View, round_step};
use crate::html::escape;
use crate::number_format::fixed;
use calibrant_machine::reference::Posture;
use nalgebra::Vector3;

/// The script that turns and plays the figure.
pub(crate) const PLAYER_SCRIPT: &str = include_str!("player.js");

const SIZE: (f64, f64) = (580.0, 420.0);
/// The first view: azimuth and elevation, degrees.
const VIEW: (f64, f64) = (-55.0, 22.0);
/// Coordinates are whole numbers of this, m.
const GRAIN_M: f64 = 1e-4;

pub(crate) fn player(scene: &Scene) -> String {
    let Some(first) = scene.played.first() else { return String::new() };
    let scale = 1.04 * (SIZE.1 / 2.0) / scene.half.norm();
    let view = View {
        centre: scene.centre,
        middle: (SIZE.0 / 2.0, SIZE.1 / 2.0),
        scale,
        ..View::from(VIEW.0.to_radians(), VIEW.1.to_radians())
    };
    let path = without_gaps(&scene.played_path);
    let floor = floor(scene);
    let (links, ends) = (scene.links(first), scene.tip_and_sensor(first));
    let tip = first.tip().translation.vector;
    let part = |name: &str, path: &str, colour: &str, width: f64| {
        format!("<path data-part=\"{name}\" d=\"{path}\" stroke=\"{colour}\" stroke-width=\"{width}\"/>")
    };
    let lines = |of: &[Vec<Vector3<f64>>]| of.iter().map(|run| view.line(run)).collect::<String>();
    let name = format!("The machine at {} s", fixed(first.time_s, 1));
    let still = " tabindex=\"0\" fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\"";
    let mut svg = opened([0.0, 0.0, SIZE.0, SIZE.1], &name, still);
    svg += &part("floor", &lines(&floor), "#d0d7de", 0.8);
    svg += &part("obstacles", &lines(&scene.obstacles), colour::ORANGE, 1.4);
    // seen from far away, a capsule is a line as wide as it, with round ends
    for (k, (ends, radius_m)) in scene.capsule_ends(first).iter().zip(scene.radii_m()).enumerate() {
        svg += &format!(
            "<path data-part=\"capsule{k}\" d=\"{}\" stroke=\"{}\" stroke-opacity=\"0.16\" stroke-width=\"{:.1}\"/>",
            view.line(ends),
            colour::GREY,
            2.0 * radius_m * scale
        );
    }
    svg += &part("path", &lines(&path), colour::SKY, 1.0);
    if scene.is_chain {
        svg += &part("links", &view.line(&links), colour::GREY, 6.0);
        svg += &part("joints", &view.dots(&links), "#424a53", 10.0);
        svg += &part("base", &view.dots(&links[..1]), colour::BLACK, 18.0);
    }
    for (k, colour) in colour::AXES.iter().enumerate() {
        svg += &part(&format!("axis{k}"), &view.line([&tip, &ends[k]]), colour, 2.6);
    }
    svg += &part("lever", &view.line([&tip, &ends[3]]), SENSOR, 3.0);
    svg += &part("sensor", &view.dots([&ends[3]]), SENSOR, 10.0);
    for (k, (name, end)) in ["x", "y", "z"].iter().zip(base_axes(scene)).enumerate() {
        let (x, y) = view.at(&end);
        svg += &format!(
            "<text data-part=\"name{k}\" x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"14\" text-anchor=\"middle\" dominant-baseline=\"middle\" fill=\"#57606a\" stroke=\"none\">{name}</text>"
        );
    }
    svg += &format!("<g fill=\"#1b1f24\" stroke=\"none\">{}</g></svg>", scale_bar(&view, SIZE));
    let grains = |points: &[Vector3<f64>]| {
        let coordinates = points.iter().flat_map(|point| <[f64; 3]>::from(point - scene.centre)).map(grain);
        coordinates.collect::<Vec<_>>().join(",")
    };
    let runs = |of: &[Vec<Vector3<f64>>]| of.iter().map(|run| grains(run)).collect::<Vec<_>>().join(";");
    let frame = |posture: &Posture| {
        let mut points = scene.links(posture);
        points.extend(scene.tip_and_sensor(posture));
        points.extend(scene.capsule_ends(posture).concat());
        grains(&points)
    };
    let frames: Vec<String> = scene.played.iter().map(frame).collect();
    let last = scene.played.last().map_or(0.0, |posture| posture.time_s);
    let data = [
        ("frames", frames.join(";")),
        ("path", runs(&path)),
        ("floor", runs(&floor)),
        ("obstacles", runs(&scene.obstacles)),
        ("capsules", scene.radii_m().count().to_string()),
        ("names", grains(&base_axes(scene))),
        ("scale", format!("{:.6}", scale * GRAIN_M)),
        ("view", format!("{},{}", VIEW.0, VIEW.1)),
        ("times", format!("{:.3},{last:.3}", first.time_s)),
    ];
    let data: String =
        data.iter().map(|(name, value)| format!(" data-{name}=\"{}\"", escape(value))).collect();
    let path_end_s = scene.path.last().map_or(last, |posture| posture.time_s);
    let path_start_s = scene.path.first().map_or(first.time_s, |posture| posture.time_s);
    let range = |from: f64, to: f64| format!("{} to {} s", fixed(from, 1), fixed(to, 1));
    let which = if last - first.time_s < path_end_s - path_start_s - 0.1 {
        format!(
            "the liveliest part plays with its path: {} of {}",
            range(first.time_s, last),
            range(path_start_s, path_end_s)
        )
    } else {
        format!("it plays from {}", range(first.time_s, last))
    };
    let more = match scene.radii_m().count() {
        0 => " Where no sample was used, it stands still.",
        _ => " Wide and pale: the capsules that are kept apart. Boxes are drawn by their edges.",
    };
    format!(
        "<figure class=\"player\"{data}><h3>The machine in motion</h3>{}<div class=\"stage\">{svg}</div>\
         <div class=\"controls\" hidden><button type=\"button\" data-do=\"play\">Play</button>\
         <input type=\"range\" min=\"0\" max=\"1\" step=\"any\" value=\"0\" aria-label=\"time\"><output>{} s</output>\
         <span><button type=\"button\" data-view=\"-90,0\">Front</button><button type=\"button\" data-view=\"0,0\">Side</button><button type=\"button\" data-view=\"-90,90\">Top</button></span><p>Drag to turn it, or use the arrow keys.</p></div>\
         <figcaption>In real time, {which}.{more} The letters x, y, z are at the ends of the base’s axes along the floor’s corner.</figcaption></figure>",
        legend(scene.is_chain),
        fixed(first.time_s, 1)
    )
}

fn grain(metres: f64) -> String {
    // coordinates that are not finite stay in the middle
    format!("{}", if metres.is_finite() { (metres / GRAIN_M).round() as i64 } else { 0 })
}

/// Lowest corner of the scene.
fn corner(scene: &Scene) -> Vector3<f64> {
    scene.centre - scene.half
}

/// Where the names of the base's axes stand.
fn base_axes(scene: &Scene) -> [Vector3<f64>; 3] {
    let (corner, half) = (corner(scene), scene.half);
    let beyond = 0.08 * half.max();
    [0, 1, 2].map(|k| {
        let mut end = corner;
        end[k] += 2.0 * half[k] + beyond;
        end
    })
}

/// A grid below the machine, and the edge that goes up from its corner.
fn floor(scene: &Scene) -> Vec<Vec<Vector3<f64>>> {
    let (low, high) = (corner(scene), scene.centre + scene.half);
    let step = round_step(2.0 * scene.half.max(), 8.0);
    let inner = |from: f64, to: f64| {
        let first = (from / step).ceil() as i64;
        let last = (to / step).floor() as i64;
        [from, to].into_iter().chain((first..=last).map(move |k| k as f64 * step))
    };
    let z = low.z;
    let along_y = inner(low.x, high.x).map(|x| vec![Vector3::new(x, low.y, z), Vector3::new(x, high.y, z)]);
    let along_x = inner(low.y, high.y).map(|y| vec![Vector3::new(low.x, y, z), Vector3::new(high.x, y, z)]);
    let up = vec![low, Vector3::new(low.x, low.y, high.z)];
    along_y.chain(along_x).chain([up]).collect()
}
