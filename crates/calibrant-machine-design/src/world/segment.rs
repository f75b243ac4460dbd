//! The nearest points of two segments.
//!
//! The squared distance of `p(s) = p₀ + s d₁` and `q(t) = q₀ + t d₂` is convex in `(s, t)` on the unit square (`ericson2005`, section 5.1.9).
//! For given `s` the best `t` is the projection of `p(s)`, and the reverse. So the optimum of the lines, clamped in `s`, then projected and clamped in `t`,
//! then projected once more, is the optimum of the square.

use nalgebra::Vector3;

/// Shorter segments are points, m².
const POINT_M2: f64 = 1e-24;
/// The sine squared below which two segments are parallel: there the optimum in `s` is no longer defined by rounding.
const PARALLEL: f64 = 1e-14;

/// The nearest points of two segments, each given by its ends.
pub(super) fn segment_segment(one: &[Vector3<f64>; 2], other: &[Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
    let (d1, d2, r) = (one[1] - one[0], other[1] - other[0], one[0] - other[0]);
    let (a, e, f, c) = (d1.norm_squared(), d2.norm_squared(), d2.dot(&r), d1.dot(&r));
    let clamped = |share: f64| share.clamp(0.0, 1.0);
    let (s, t) = match (a <= POINT_M2, e <= POINT_M2) {
        (true, true) => (0.0, 0.0),
        (true, false) => (0.0, clamped(f / e)),
        (false, true) => (clamped(-c / a), 0.0),
        (false, false) => {
            let b = d1.dot(&d2);
            let lines = a * e - b * b;
            let s = if lines > PARALLEL * a * e { clamped((b * f - c * e) / lines) } else { 0.5 };
            let t = clamped((b * s + f) / e);
            (clamped((b * t - c) / a), t)
        }
    };
    [one[0] + d1 * s, other[0] + d2 * t]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chains_for_tests::Numbers;

    /// Squared distance of a point to a segment.
    fn to_segment(point: &Vector3<f64>, of: &[Vector3<f64>; 2]) -> f64 {
        let along = of[1] - of[0];
        let share = if along.norm_squared() == 0.0 {
            0.0
        } else {
            ((point - of[0]).dot(&along) / along.norm_squared()).clamp(0.0, 1.0)
        };
        (point - of[0] - along * share).norm_squared()
    }

    /// The least over one segment, by ternary search: the distance to a convex set is convex along a line.
    fn by_search(one: &[Vector3<f64>; 2], other: &[Vector3<f64>; 2]) -> f64 {
        let at = |s: f64| to_segment(&(one[0] + (one[1] - one[0]) * s), other);
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..120 {
            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
            if at(a) < at(b) { high = b } else { low = a }
        }
        at((low + high) / 2.0).min(at(0.0)).min(at(1.0)).sqrt()
    }

    #[test]
    fn nearest_points_of_segments_are_those_of_a_search() {
        let mut numbers = Numbers(3);
        for k in 0..4000 {
            let one = [numbers.vector(1.0), numbers.vector(1.0)];
            let other = match k % 4 {
                0 => [one[0] + numbers.vector(0.3), one[1] + numbers.vector(1e-7)],
                1 => {
                    let aside = numbers.vector(0.5);
                    [one[0] + aside, one[1] + aside]
                }
                2 => [numbers.vector(1.0); 2],
                _ => [numbers.vector(1.0), numbers.vector(1.0)],
            };
            let [p, q] = segment_segment(&one, &other);
            let (found, searched) = ((p - q).norm(), by_search(&one, &other));
            assert!((found - searched).abs() < 1e-7, "{k}: {found} against {searched}");
        }
    }
}
