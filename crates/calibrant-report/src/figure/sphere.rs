//! The figure of the holds' directions on the sphere, in two equal-area hemispheres.
//!
//! This file draws it itself: a sphere with a graticule and numbered points is no panel.

use super::colour;
use super::drawing::{legend, opened};
use super::files::{Drawable, FigureFiles, standalone};
use super::frame::framed;
use crate::html::escape;
use calibrant_core::estimate::{HoldCalibration, HoldResult};
use nalgebra::Vector3;

const RADIUS: f64 = 165.0;
/// Half the side of a hemisphere's drawing.
const HALF: f64 = 212.0;

/// Directions on the sphere, numbered.
pub(crate) struct Sphere {
    title: &'static str,
    /// Signs with their labels.
    legend: Vec<(String, String)>,
    points: Vec<Point>,
    /// Directions without numbers.
    rings: Vec<Vector3<f64>>,
    caption: &'static str,
}

impl Drawable for Sphere {
    fn html(&self) -> String {
        let hemispheres = self.hemispheres().concat();
        framed(self.title, &legend(&self.legend), &hemispheres, 2, self.caption)
    }

    fn files(&self) -> FigureFiles {
        let drawings = self.hemispheres().map(|drawing| (drawing, [2.0 * HALF, 2.0 * HALF + 16.0]));
        let row = |(number, d, used): &Point| format!("{number},{:?},{:?},{:?},{used}\n", d.x, d.y, d.z);
        let ring = |d: &Vector3<f64>| format!(",{:?},{:?},{:?},\n", d.x, d.y, d.z);
        let rows = self.points.iter().map(row).chain(self.rings.iter().map(ring));
        FigureFiles {
            title: self.title.to_owned(),
            svg: standalone(self.title, &drawings, &self.legend, 2),
            csv: "number,x,y,z,used\n".to_owned() + &rows.collect::<String>(),
        }
    }
}

impl Sphere {
    fn hemispheres(&self) -> [String; 2] {
        [("upper half, z ≥ 0", true), ("lower half, z < 0", false)]
            .map(|(name, upper)| hemisphere(&self.points, &self.rings, name, upper))
    }
}

/// Directions of the specific force in the sensor's frame, one numbered point for each hold.
pub(crate) fn hold_directions(holds: &HoldCalibration) -> Sphere {
    let points: Vec<Point> = holds
        .holds
        .iter()
        .enumerate()
        .filter_map(|(i, hold)| direction(hold).map(|d| (i + 1, d, hold.used)))
        .collect();
    let mut signs = vec![(dot(17.0, 7.0), "used".to_owned())];
    if holds.holds.iter().any(|hold| !hold.used) {
        signs.push((cross(17.0, 7.0), "not used".to_owned()));
    }
    let caption = "Specific force over its magnitude in the true frame, with the number of the hold. Both halves are seen from \
                   +z. Equal areas on the sphere are equal areas here. Rings are 30° apart, and the rim is z = 0. Good: points in \
                   all parts of both halves. An empty region is a direction in which the calibration extrapolates.";
    Sphere { title: "Orientations of the holds", legend: signs, points, rings: Vec::new(), caption }
}

/// Directions of poses in the sensor's frame, numbered, and those of the approximate design that bounds them.
pub(crate) fn pose_directions(poses: &[Vector3<f64>], approximate: &[Vector3<f64>]) -> Sphere {
    let points = poses.iter().enumerate().map(|(k, u)| (k + 1, *u, true)).collect();
    let legend = [(dot(17.0, 7.0), "pose"), (ring(17.0, 7.0), "direction of the approximate design")];
    let legend = legend.map(|(sign, label)| (sign, label.to_owned())).to_vec();
    let caption = "The direction that is up in each pose, in the sensor's axes. Both halves are seen from +z. Equal areas on the sphere are \
                   equal areas here. Rings are 30° apart, and the rim is z = 0.";
    Sphere { title: "Directions of the poses", legend, points, rings: approximate.to_vec(), caption }
}

/// A number, a direction, and whether it is used.
type Point = (usize, Vector3<f64>, bool);

fn hemisphere(points: &[Point], rings: &[Vector3<f64>], name: &str, upper: bool) -> String {
    let points: Vec<(usize, (f64, f64), bool)> = points
        .iter()
        .filter(|(_, d, _)| (d.z >= 0.0) == upper)
        .map(|(number, d, used)| (*number, projected(d), *used))
        .collect();
    let frame = [-HALF, -HALF - 16.0, 2.0 * HALF, 2.0 * HALF + 16.0];
    let mut svg = opened(frame, name, " fill=\"#1b1f24\"");
    let top = 2.0 - HALF;
    svg.push_str(&format!(
        "<text x=\"0\" y=\"{top}\" font-size=\"15\" text-anchor=\"middle\">{}</text>",
        escape(name)
    ));
    for elevation in [0.0_f64, 30.0, 60.0] {
        let radius = RADIUS * (1.0 - elevation.to_radians().sin()).sqrt();
        let stroke = if elevation == 0.0 { "#424a53" } else { "#d0d7de" };
        svg.push_str(&format!("<circle r=\"{radius:.1}\" fill=\"none\" stroke=\"{stroke}\"/>"));
    }
    svg.push_str(&format!("<path d=\"M{0} 0H{RADIUS}M0 {0}V{RADIUS}\" stroke=\"#d0d7de\"/>", -RADIUS));
    for (label, x, y) in [
        ("+x", RADIUS + 28.0, 4.0),
        ("−x", -RADIUS - 28.0, 4.0),
        ("+y", 0.0, -RADIUS - 20.0),
        ("−y", 0.0, RADIUS + 30.0),
    ] {
        svg.push_str(&format!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"13\" text-anchor=\"middle\">{label}</text>"
        ));
    }
    for direction in rings.iter().filter(|direction| (direction.z >= 0.0) == upper) {
        let (x, y) = projected(direction);
        svg.push_str(&ring(x, y));
    }
    for &(_, (x, y), used) in &points {
        svg.push_str(&if used { dot(x, y) } else { cross(x, y) });
    }
    for (number, (x, y), used) in placed(&points) {
        let fill = if used { "#1b1f24" } else { "#b34700" };
        svg.push_str(&format!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"12\" text-anchor=\"middle\" fill=\"{fill}\">{number}</text>"
        ));
    }
    if points.is_empty() {
        svg.push_str("<text y=\"30\" font-size=\"13\" text-anchor=\"middle\" fill=\"#57606a\">no hold in this half</text>");
    }
    svg + "</svg>"
}

/// The position of each number. It is the place about its point that is farthest from other points and
/// numbers already placed.
fn placed(points: &[(usize, (f64, f64), bool)]) -> Vec<(usize, (f64, f64), bool)> {
    /// Places of a number about its point.
    const PLACES: [(f64, f64); 8] = [
        (11.0, -5.0),
        (-11.0, -5.0),
        (11.0, 13.0),
        (-11.0, 13.0),
        (0.0, -8.0),
        (0.0, 17.0),
        (13.0, 4.0),
        (-13.0, 4.0),
    ];
    let mut taken: Vec<(f64, f64)> = points.iter().map(|point| point.1).collect();
    let mut labels = Vec::with_capacity(points.len());
    for &(number, (x, y), used) in points {
        let room = |&(dx, dy): &(f64, f64)| {
            let (cx, cy) = (x + dx, y + dy - 4.0); // the middle of the number
            taken
                .iter()
                .filter(|&&p| p != (x, y))
                .map(|p| (p.0 - cx).hypot(1.3 * (p.1 - cy)))
                .fold(40.0, f64::min)
        };
        // a small preference for the first place keeps the picture calm
        let score = |i: usize| room(&PLACES[i]) - 0.5 * i as f64;
        let best = (0..PLACES.len()).max_by(|&a, &b| score(a).total_cmp(&score(b))).unwrap_or(0);
        let (dx, dy) = PLACES[best];
        taken.push((x + dx, y + dy - 4.0));
        labels.push((number, (x + dx, y + dy), used));
    }
    labels
}

fn direction(hold: &HoldResult) -> Option<Vector3<f64>> {
    let norm = hold.force_mps2.norm();
    (norm.is_finite() && norm > 0.0).then(|| hold.force_mps2 / norm)
}

/// Lambert's azimuthal equal-area projection about ±z, the equator at [`RADIUS`]; y points up.
fn projected(direction: &Vector3<f64>) -> (f64, f64) {
    let segment = RADIUS / (1.0 + direction.z.abs()).sqrt();
    (direction.x * segment, -direction.y * segment)
}

fn dot(x: f64, y: f64) -> String {
    format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.8\" fill=\"{}\"/>", colour::BLUE)
}

fn ring(x: f64, y: f64) -> String {
    format!(
        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6.5\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>",
        colour::ORANGE
    )
}

fn cross(x: f64, y: f64) -> String {
    format!(
        "<path d=\"M{:.1} {:.1}l9 9m-9 0l9 -9\" stroke=\"{}\" stroke-width=\"2.2\"/>",
        x - 4.5,
        y - 4.5,
        colour::VERMILLION
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_projection_keeps_areas_and_puts_the_equator_on_the_rim() {
        let at = |elevation: f64| {
            let (x, y) = projected(&Vector3::new(elevation.cos(), 0.0, elevation.sin()));
            x.hypot(y)
        };
        assert!((at(0.0) - RADIUS).abs() < 1e-9);
        // the cap above elevation e has the share 1 − sin e of the half sphere's area
        for e in [0.2, 0.7, 1.3_f64] {
            assert!(((at(e) / RADIUS).powi(2) - (1.0 - e.sin())).abs() < 1e-12);
        }
    }
}
