//! A box, and the nearest point of a segment to it.
//!
//! In the box's axes the signed distance of a point is `|max(|x| − h, 0)|` outside and `maxᵢ(|xᵢ| − hᵢ)` inside: convex, so along a segment, too.
//! Outside, its square is a quadratic between the places where the segment crosses the planes of the box's faces; its derivative is continuous and grows, so
//! the optimum is where it changes sign, and linear interpolation within that piece is exact. Inside, it is the largest of six linear functions,
//! whose lowest point is an end or where two of them cross.

use nalgebra::{Isometry3, Point3, Vector3};

/// A box that does not move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cuboid {
    /// Pose of its middle, in the base; m.
    pub pose: Isometry3<f64>,
    /// Half of its edges, m.
    pub half_m: Vector3<f64>,
}

/// Where a segment is nearest to a box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SegmentBox {
    /// Negative inside, m.
    pub distance_m: f64,
    pub on_segment: Vector3<f64>,
    /// Gradient of the distance by that point.
    pub outward: Vector3<f64>,
}

/// A segment that comes nearer than this enters the box: at its surface rounding decides on which side a point is.
const TOUCHING_M: f64 = 1e-12;

/// The nearest point of a segment to a box.
pub(super) fn segment_box(segment: &[Vector3<f64>; 2], cuboid: &Cuboid) -> SegmentBox {
    let [p, q] = segment.map(|end| cuboid.pose.inverse_transform_point(&Point3::from(end)).coords);
    let (along, half) = (q - p, cuboid.half_m);
    let mut share = outside_optimum(&p, &along, &half);
    if signed_distance(&(p + along * share), &half).0 <= TOUCHING_M {
        share = inside_optimum(&p, &along, &half);
    }
    let (distance_m, outward) = signed_distance(&(p + along * share), &half);
    SegmentBox {
        distance_m,
        on_segment: segment[0] + (segment[1] - segment[0]) * share,
        outward: cuboid.pose.rotation * outward,
    }
}

/// Signed distance of a point in the box's axes, and its gradient.
fn signed_distance(x: &Vector3<f64>, half: &Vector3<f64>) -> (f64, Vector3<f64>) {
    let over = x.abs() - half;
    let beyond = over.map(|of| of.max(0.0));
    let norm = beyond.norm();
    if norm > 0.0 {
        return (norm, beyond.component_mul(&x.map(f64::signum)) / norm);
    }
    let face = over.imax();
    (over[face], Vector3::ith(face, x[face].signum()))
}

/// Share of the segment at which the squared distance is least.
fn outside_optimum(p: &Vector3<f64>, along: &Vector3<f64>, half: &Vector3<f64>) -> f64 {
    // half of the derivative by the share
    let slope = |share: f64| {
        let x = p + along * share;
        (0..3).map(|i| along[i] * (x[i] - x[i].clamp(-half[i], half[i]))).sum::<f64>()
    };
    let (mut low, mut high) = ((0.0, slope(0.0)), (1.0, slope(1.0)));
    if low.1 >= 0.0 {
        return 0.0;
    }
    if high.1 <= 0.0 {
        return 1.0;
    }
    for i in 0..3 {
        for face in [-half[i], half[i]] {
            let share = (face - p[i]) / along[i];
            if share > low.0 && share < high.0 {
                let at = (share, slope(share));
                if at.1 < 0.0 { low = at } else { high = at }
            }
        }
    }
    low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1)
}

/// Share of the segment at which a segment that enters the box is deepest.
fn inside_optimum(p: &Vector3<f64>, along: &Vector3<f64>, half: &Vector3<f64>) -> f64 {
    let sides = |i: usize| [(p[i] - half[i], along[i]), (-p[i] - half[i], -along[i])];
    let [[a, b], [c, d], [e, f]] = [sides(0), sides(1), sides(2)];
    let faces = [a, b, c, d, e, f];
    let depth = |share: f64| faces.iter().map(|(at, by)| at + by * share).fold(f64::MIN, f64::max);
    let (mut best, mut least) = (0.0, depth(0.0));
    let mut consider = |share: f64| {
        if (0.0..=1.0).contains(&share) && depth(share) < least {
            (best, least) = (share, depth(share));
        }
    };
    consider(1.0);
    for (k, one) in faces.iter().enumerate() {
        for other in &faces[k + 1..] {
            consider((other.0 - one.0) / (one.1 - other.1));
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chains_for_tests::Numbers;

    #[test]
    fn the_distance_of_a_segment_to_a_box_is_that_of_a_search() {
        let mut numbers = Numbers(5);
        let mut inside = 0;
        for k in 0..4000 {
            let half_m = numbers.vector(0.3).abs() + Vector3::repeat(0.02);
            let cuboid = Cuboid { pose: Isometry3::new(numbers.vector(0.3), numbers.vector(2.0)), half_m };
            let mut segment = [numbers.vector(0.5), numbers.vector(0.5)];
            if k % 3 == 0 {
                // along an edge of the box
                segment[1] = segment[0] + cuboid.pose.rotation * Vector3::x() * 0.4;
            }
            let found = segment_box(&segment, &cuboid);
            let of = |share: f64| {
                let x = segment[0] + (segment[1] - segment[0]) * share;
                let x = cuboid.pose.inverse_transform_point(&Point3::from(x)).coords;
                let over = x.abs() - half_m;
                over.map(|of| of.max(0.0)).norm() + over.max().min(0.0)
            };
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..120 {
                let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
                if of(a) <= of(b) { high = b } else { low = a }
            }
            let searched = of((low + high) / 2.0).min(of(0.0)).min(of(1.0));
            assert!((found.distance_m - searched).abs() < 1e-9, "{k}: {found:?} against {searched}");
            inside += usize::from(found.distance_m < 0.0);
        }
        assert!(inside > 400, "{inside} segments enter their box");
    }
}
