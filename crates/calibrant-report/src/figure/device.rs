//! A picture of the device in a pose: a box with its three axes, seen from the side and a little above.
//!
//! This file draws it itself: a panel has no solids.

use super::colour;
use super::drawing::opened;
use super::view::View;
use nalgebra::{Matrix3, Vector3};

/// Half edges of the box.
const HALF: Vector3<f64> = Vector3::new(1.0, 0.7, 0.3);
/// Length of an axis from the middle.
const AXIS: f64 = 1.7;
/// Azimuth and elevation from which it is seen, degrees.
const SEEN_FROM: (f64, f64) = (-62.0, 24.0);
/// Pixels for a unit.
const SCALE: f64 = 34.0;
/// Fill of the faces across x, y and z.
const FACES: [&str; 3] = ["#d8dee4", "#eaeef2", "#f6f8fa"];

/// The vertical of the room, at the side.
const UP: &str = "<path d=\"M-61 62V38\" stroke=\"#6e7781\" stroke-width=\"2.4\"/><path d=\"M-61 32L-57.5 40H-64.5Z\" fill=\"#6e7781\"/>\
                  <text x=\"-61\" y=\"27\" font-size=\"11\" text-anchor=\"middle\" fill=\"#6e7781\">up</text>";

/// The device as SVG. `room_from_sensor`: its axes in the room, whose third axis is up; `words`: the same in words.
pub(crate) fn device(room_from_sensor: Matrix3<f64>, words: &str) -> String {
    let view = Seen::new(room_from_sensor);
    let mut svg = opened([-70.0, -70.0, 140.0, 140.0], words, "");
    let (behind, before): (Vec<usize>, Vec<usize>) =
        (0..3).partition(|&axis| view.depth(&Vector3::ith(axis, 1.0)) < 0.0);
    behind.iter().for_each(|&axis| svg.push_str(&view.axis(axis)));
    svg.push_str(&view.faces());
    before.iter().for_each(|&axis| svg.push_str(&view.axis(axis)));
    // names last: no face hides them
    (0..3).for_each(|axis| svg.push_str(&view.name(axis)));
    svg + UP + "</svg>"
}

/// The sensor as it is seen.
struct Seen {
    view: View,
    room_from_sensor: Matrix3<f64>,
}

impl Seen {
    fn new(room_from_sensor: Matrix3<f64>) -> Self {
        let view = View::from(SEEN_FROM.0.to_radians(), SEEN_FROM.1.to_radians());
        Self { view: View { scale: SCALE, ..view }, room_from_sensor }
    }

    fn at(&self, point: &Vector3<f64>) -> (f64, f64) {
        self.view.at(&(self.room_from_sensor * point))
    }

    fn depth(&self, direction: &Vector3<f64>) -> f64 {
        self.view.right.cross(&self.view.up).dot(&(self.room_from_sensor * direction))
    }

    /// The faces towards the eye, with the name of the axis on that of its positive end.
    fn faces(&self) -> String {
        let mut svg = String::new();
        for axis in 0..3 {
            let sign = if self.depth(&Vector3::ith(axis, 1.0)) > 0.0 { 1.0 } else { -1.0 };
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            let corner = |a: f64, b: f64| {
                let mut point = Vector3::zeros();
                (point[axis], point[i], point[j]) = (sign * HALF[axis], a * HALF[i], b * HALF[j]);
                let (x, y) = self.at(&point);
                format!("{x:.1},{y:.1}")
            };
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(a, b)| corner(a, b));
            svg.push_str(&format!(
                "<polygon points=\"{}\" fill=\"{}\" stroke=\"#1b1f24\" stroke-width=\"1.2\" stroke-linejoin=\"round\"/>",
                corners.join(" "),
                FACES[axis]
            ));
        }
        svg
    }

    /// The name of an axis at its end, with a rim that lifts it off what lies behind.
    fn name(&self, axis: usize) -> String {
        let (x, y) = self.at(&(Vector3::ith(axis, 1.0) * AXIS));
        let length = x.hypot(y).max(1e-9);
        let (x, y) = (x + 9.0 * x / length, y + 9.0 * y / length + 4.0);
        format!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"13\" font-weight=\"700\" text-anchor=\"middle\" fill=\"{}\" stroke=\"#ffffff\" \
             stroke-width=\"3\" paint-order=\"stroke\">{}</text>",
            colour::AXES[axis],
            ["x", "y", "z"][axis]
        )
    }

    /// The positive half of an axis, from the face to its end.
    fn axis(&self, axis: usize) -> String {
        let unit: Vector3<f64> = Vector3::ith(axis, 1.0);
        let (x0, y0) = self.at(&(unit * HALF[axis]));
        let (x1, y1) = self.at(&(unit * AXIS));
        let length = (x1 - x0).hypot(y1 - y0).max(1e-9);
        let (dx, dy) = ((x1 - x0) / length, (y1 - y0) / length);
        let colour = colour::AXES[axis];
        // an axis that points at the eye is a dot
        let head = if length < 6.0 {
            String::new()
        } else {
            let (bx, by) = (x1 - 6.0 * dx, y1 - 6.0 * dy);
            format!(
                "<path d=\"M{x1:.1} {y1:.1}L{:.1} {:.1}L{:.1} {:.1}Z\" fill=\"{colour}\"/>",
                bx - 3.0 * dy,
                by + 3.0 * dx,
                bx + 3.0 * dy,
                by - 3.0 * dx
            )
        };
        format!(
            "<path d=\"M{x0:.1} {y0:.1}L{x1:.1} {y1:.1}\" stroke=\"{colour}\" stroke-width=\"2.4\"/>{head}"
        )
    }
}
