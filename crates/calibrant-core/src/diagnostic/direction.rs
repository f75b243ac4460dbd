//! A direction in words.

use crate::sensor::Axis;
use nalgebra::Vector3;

/// Two directions agree within this angle, rad.
///
/// Faces by hand, unknown gains and non-orthogonality stay well below it. Mistakes are 90° or 180°.
pub(crate) const AGREES_RAD: f64 = 0.5;

/// A direction in words: `-x`, or its components.
pub(crate) fn direction_in_words(direction: &Vector3<f64>) -> String {
    let near =
        |sign: f64, axis: &Axis| direction.angle(&(sign * Vector3::ith(axis.index(), 1.0))) < AGREES_RAD;
    for (sign, name) in [(1.0, ""), (-1.0, "-")] {
        if let Some(axis) = Axis::ALL.iter().find(|axis| near(sign, axis)) {
            return format!("{name}{axis}");
        }
    }
    format!("({:+.1}, {:+.1}, {:+.1})", direction.x, direction.y, direction.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_direction_reads_as_its_axis_or_its_components() {
        assert_eq!(direction_in_words(&Vector3::new(0.05, -0.99, 0.1).normalize()), "-y");
        assert_eq!(direction_in_words(&Vector3::new(0.6, 0.0, 0.8)), "(+0.6, +0.0, +0.8)");
    }
}
