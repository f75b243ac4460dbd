//! A pose as turns of the hand: an axis up or down, then a turn about each of the two other axes.
//!
//! With axis k up and (i, j, k) in cyclic order, a turn by α about i and then by β about the sensor's own j
//! brings the direction `u = R_jᵀ(β) R_iᵀ(α) e_k = (−sin β cos α, sin α, cos β cos α)` up, in the order i, j, k.

use calibrant_core::sensor::Axis;
use nalgebra::{Matrix3, Rotation3, Vector3};

/// A turn below this angle is none, degrees.
const NONE_DEG: f64 = 0.05;

/// How to hold the sensor so that a direction is up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Attitude {
    axis: usize,
    is_down: bool,
    /// Turns about the next axis but one, and about the one before, rad.
    turns: [f64; 2],
}

impl Attitude {
    /// For a direction (unit vector in the sensor's axes) that is to be up. The axis nearest to it is taken.
    pub(crate) fn of(up: &Vector3<f64>) -> Self {
        let axis = up.iamax();
        let is_down = up[axis] < 0.0;
        let u = if is_down { -up } else { *up };
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        Self { axis, is_down, turns: [u[j].clamp(-1.0, 1.0).asin(), (-u[i]).atan2(u[axis])] }
    }

    /// `z up, then turned 45° about x`.
    pub(crate) fn words(&self) -> String {
        let name = |axis: usize| Axis::ALL[axis % 3].to_string();
        let turned: Vec<String> = [(self.turns[0], self.axis + 1), (self.turns[1], self.axis + 2)]
            .iter()
            .filter(|(angle, _)| angle.to_degrees().abs() >= NONE_DEG)
            .map(|(angle, axis)| {
                let degrees = (angle.to_degrees() * 10.0).round() / 10.0;
                format!("{degrees}° about {}", name(*axis)).replace('-', "−")
            })
            .collect();
        let base = format!("{} {}", name(self.axis), if self.is_down { "down" } else { "up" });
        if turned.is_empty() { base } else { format!("{base}, then turned {}", turned.join(", then ")) }
    }

    /// The sensor's axes in the room, whose third axis is up.
    pub(crate) fn room_from_sensor(&self) -> Matrix3<f64> {
        let (i, j, k) = ((self.axis + 1) % 3, (self.axis + 2) % 3, self.axis);
        let place = Matrix3::from_rows(&[i, j, k].map(|axis| Vector3::ith(axis, 1.0).transpose()));
        let unit = |axis: usize| Vector3::<f64>::ith_axis(axis);
        let flip = if self.is_down { std::f64::consts::PI } else { 0.0 };
        let turn = Rotation3::from_axis_angle(&unit(i), flip + self.turns[0])
            * Rotation3::from_axis_angle(&unit(j), self.turns[1]);
        place * turn.into_inner()
    }
}

/// A pose in words: `z up, then turned 45° about x`. The turns are right-handed, about the sensor's own axes.
#[must_use]
pub fn pose_in_words(up: &Vector3<f64>) -> String {
    Attitude::of(up).words()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_attitude_brings_the_direction_up() {
        for u in [(0.3, -0.8, 0.5), (0.0, 0.0, -1.0), (-0.9, 0.1, 0.4), (0.2, 0.9, -0.1), (1.0, 1.0, 1.0)] {
            let u = Vector3::new(u.0, u.1, u.2).normalize();
            let up = Attitude::of(&u).room_from_sensor() * u;
            assert!((up - Vector3::z()).norm() < 1e-12, "{u} {up}");
        }
    }

    #[test]
    fn poses_have_the_words_of_a_hand() {
        let say = |x: f64, y: f64, z: f64| pose_in_words(&Vector3::new(x, y, z).normalize());
        assert_eq!(say(0.0, 0.0, 1.0), "z up");
        assert_eq!(say(-1.0, 0.0, 0.0), "x down");
        assert_eq!(say(0.0, 0.6, 0.8), "z up, then turned 36.9° about x");
        assert_eq!(say(0.6, 0.0, 0.8), "z up, then turned −36.9° about y");
    }

    /// A hand that follows the words: it turns the device about its own axes, and looks what is up.
    fn followed(words: &str) -> Vector3<f64> {
        let axis =
            |name: &str| Vector3::ith(["x", "y", "z"].iter().position(|n| *n == name).expect("an axis"), 1.0);
        let mut steps = words.split(", then ");
        let (name, way) = steps.next().and_then(|base| base.split_once(' ')).expect("a base");
        let mut up: Vector3<f64> = axis(name) * if way == "up" { 1.0 } else { -1.0 };
        for step in steps {
            let (angle, name) = step.trim_start_matches("turned ").split_once("° about ").expect("a turn");
            let angle: f64 = angle.replace('−', "-").parse().expect("a number");
            // what stands still in the room turns back in the device
            let turn =
                Rotation3::from_axis_angle(&nalgebra::Unit::new_normalize(axis(name)), -angle.to_radians());
            up = turn * up;
        }
        up
    }

    #[test]
    fn a_hand_that_follows_the_words_gets_the_pose() {
        for number in 0..500_u32 {
            let part = |k: u32| (f64::from(number * 3 + k) * 12.9898).sin();
            let u = Vector3::new(part(0), part(1), part(2)).normalize();
            let found = followed(&pose_in_words(&u));
            // angles are rounded to 0.1°, each of two turns
            assert!(found.angle(&u).to_degrees() < 0.08, "{u} {} {found}", pose_in_words(&u));
        }
        for u in [Vector3::x(), -Vector3::y(), -Vector3::z()] {
            assert_eq!(followed(&pose_in_words(&u)), u);
        }
    }
}
