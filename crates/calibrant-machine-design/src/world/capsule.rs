//! A capsule: all points within a radius of a segment.

use super::cuboid::{Cuboid, segment_box};
use super::segment::segment_segment;
use nalgebra::{AbstractRotation, Isometry, Point3, Unit, Vector3};
use std::f64::consts::PI;

/// All points within a radius of a segment. A ball is one whose ends are equal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capsule {
    /// Ends of the segment, m.
    pub ends_m: [Vector3<f64>; 2],
    /// Radius, m.
    pub radius_m: f64,
}

/// Two nearest points of two bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Nearest {
    /// Negative where the bodies overlap, m.
    pub distance_m: f64,
    /// A point of each on its surface, m.
    pub points: [Vector3<f64>; 2],
    /// From the first body to the second.
    pub normal: Vector3<f64>,
}

impl Capsule {
    /// A ball.
    #[must_use]
    pub fn ball(center_m: Vector3<f64>, radius_m: f64) -> Self {
        Self { ends_m: [center_m; 2], radius_m }
    }

    /// The same capsule, given in other axes.
    #[must_use]
    pub fn placed<R: AbstractRotation<f64, 3>>(&self, frame: &Isometry<f64, R, 3>) -> Self {
        let place = |end: Vector3<f64>| (frame * Point3::from(end)).coords;
        let [one, other] = self.ends_m;
        Self { ends_m: [place(one), place(other)], radius_m: self.radius_m }
    }

    /// Volume, m³.
    #[must_use]
    pub fn volume_m3(&self) -> f64 {
        let length = (self.ends_m[1] - self.ends_m[0]).norm();
        PI * self.radius_m * self.radius_m * (length + 4.0 / 3.0 * self.radius_m)
    }

    /// Distance of the farthest point of the capsule from the origin of its axes, m.
    #[must_use]
    pub fn extent_m(&self) -> f64 {
        self.ends_m[0].norm().max(self.ends_m[1].norm()) + self.radius_m
    }

    /// Middle of the segment.
    pub(super) fn middle(&self) -> Vector3<f64> {
        (self.ends_m[0] + self.ends_m[1]) / 2.0
    }

    /// Radius of the ball around the middle that contains the capsule.
    pub(super) fn bounding_radius_m(&self) -> f64 {
        (self.ends_m[1] - self.ends_m[0]).norm() / 2.0 + self.radius_m
    }

    /// Against another capsule in the same axes.
    pub(super) fn to_capsule(self, other: &Self) -> Nearest {
        let [p, q] = segment_segment(&self.ends_m, &other.ends_m);
        let apart = q - p;
        let normal = Unit::try_new(apart, TOUCHING_M)
            .map_or_else(|| across(&self.ends_m, &other.ends_m), Unit::into_inner);
        Nearest {
            distance_m: apart.norm() - self.radius_m - other.radius_m,
            points: [p + normal * self.radius_m, q - normal * other.radius_m],
            normal,
        }
    }

    /// Against a box in the same axes.
    pub(super) fn to_box(self, cuboid: &Cuboid) -> Nearest {
        let found = segment_box(&self.ends_m, cuboid);
        let normal = -found.outward;
        Nearest {
            distance_m: found.distance_m - self.radius_m,
            points: [found.on_segment + normal * self.radius_m, found.on_segment + normal * found.distance_m],
            normal,
        }
    }
}

/// Segments nearer than this cross, and their difference gives no direction.
const TOUCHING_M: f64 = 1e-12;

/// A direction across two segments that cross.
fn across(one: &[Vector3<f64>; 2], other: &[Vector3<f64>; 2]) -> Vector3<f64> {
    let [u, v] = [one[1] - one[0], other[1] - other[0]];
    let long = if u.norm_squared() > v.norm_squared() { u } else { v };
    let least = Vector3::ith(long.iamin(), 1.0);
    let tries = [u.cross(&v), long.cross(&least)];
    tries.into_iter().find_map(|of| Unit::try_new(of, TOUCHING_M)).unwrap_or(Vector3::z_axis()).into_inner()
}
