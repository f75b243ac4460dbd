//! The smallest capsule around a shape that a search finds.
//!
//! For given ends the smallest radius is the largest distance of a point from the segment. So the volume is a function of six numbers, and the simplex search of
//! Nelder and Mead (`nelder1965`) lowers it from three starts: along each principal axis of the points. It sees the points that are farthest in
//! one of [`DIRECTIONS`] directions; the radius is then taken from all. So the capsule contains the shape whatever the search found.

use super::Capsule;
use nalgebra::{Isometry3, Matrix3, SVector, Vector3};
use std::f64::consts::{PI, TAU};

/// Directions in which the farthest points are taken. They are 0.18 rad apart: a point between them sticks out by at most 0.4 % of its distance.
const DIRECTIONS: usize = 400;
/// Corners of the polygon around a circle: it is 0.5 % wider.
const CORNERS: usize = 32;
/// Evaluations of one search, and how often it begins anew at its best point: a simplex can collapse.
const EVALUATIONS: usize = 600;
const RESTARTS: usize = 3;
/// What rounding may take from the radius.
const ROUNDING: f64 = 1.0 + 1e-12;

/// A shape of a link in its own axes; m.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// The convex hull of points.
    Points(Vec<Vector3<f64>>),
    /// A box around the origin, by half of its edges.
    Box {
        /// Half of each edge.
        half_m: Vector3<f64>,
    },
    /// A cylinder about z, its middle at the origin.
    Cylinder {
        /// Its radius.
        radius_m: f64,
        /// Its length.
        length_m: f64,
    },
    /// A ball around the origin.
    Sphere {
        /// Its radius.
        radius_m: f64,
    },
}

/// A capsule that contains a shape, as small as the search makes it. `None` for a shape without points.
///
/// # Examples
/// A rod of 1 m is a capsule of its own length and radius, nearly.
/// ```
/// use calibrant_machine_design::world::*;
/// use nalgebra::Isometry3;
/// let rod = Shape::Cylinder { radius_m: 0.01, length_m: 1.0 };
/// let capsule = capsule_around(&rod, &Isometry3::identity()).expect("it has points");
/// assert!(capsule.radius_m > 0.01 && capsule.radius_m < 0.0125, "{capsule:?}");
/// ```
#[must_use]
pub fn capsule_around(shape: &Shape, pose: &Isometry3<f64>) -> Option<Capsule> {
    let points: Vec<Vector3<f64>> = match shape {
        Shape::Sphere { radius_m } => return Some(Capsule::ball(pose.translation.vector, *radius_m)),
        Shape::Points(points) => points.clone(),
        Shape::Box { half_m } => {
            let sign = |bit: usize, corner: usize| if corner >> bit & 1 == 1 { 1.0 } else { -1.0 };
            (0..8).map(|corner| half_m.map_with_location(|i, _, h| h * sign(i, corner))).collect()
        }
        Shape::Cylinder { radius_m, length_m } => {
            let around = radius_m / (PI / CORNERS as f64).cos();
            let corner = |k: usize, z: f64| {
                let (sin, cos) = (TAU * k as f64 / CORNERS as f64).sin_cos();
                Vector3::new(around * cos, around * sin, z)
            };
            let ends = [-length_m / 2.0, length_m / 2.0];
            ends.iter().flat_map(|z| (0..CORNERS).map(|k| corner(k, *z))).collect()
        }
    };
    around_points(&points).map(|capsule| capsule.placed(pose))
}

fn around_points(points: &[Vector3<f64>]) -> Option<Capsule> {
    let farthest = farthest_points(points);
    let middle = farthest.iter().sum::<Vector3<f64>>() / farthest.len().max(1) as f64;
    let spread: Matrix3<f64> = farthest.iter().map(|p| (p - middle) * (p - middle).transpose()).sum();
    let axes = spread.symmetric_eigen().eigenvectors;
    let searched = (0..3).map(|k| search(&farthest, start(&farthest, &middle, &axes.column(k).into())));
    let best = searched.min_by(|one, other| one.volume_m3().total_cmp(&other.volume_m3()))?;
    points.first()?;
    let radius_m = ROUNDING * radius(points, &best.ends_m);
    Some(Capsule { radius_m, ..best })
}

/// The points that are farthest in one of many directions, each once: Fibonacci's spiral over the sphere.
fn farthest_points(points: &[Vector3<f64>]) -> Vec<Vector3<f64>> {
    if points.len() <= DIRECTIONS {
        return points.to_vec();
    }
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let farthest = |k: usize| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / DIRECTIONS as f64;
        let (sin, cos) = (golden * k as f64).sin_cos();
        let across = (1.0 - z * z).sqrt();
        let direction = Vector3::new(across * cos, across * sin, z);
        let along = |i: &usize| points[*i].dot(&direction);
        (0..points.len()).max_by(|i, j| along(i).total_cmp(&along(j)))
    };
    let mut places: Vec<usize> = (0..DIRECTIONS).filter_map(farthest).collect();
    places.sort_unstable();
    places.dedup();
    places.into_iter().map(|i| points[i]).collect()
}

/// Radius of the smallest capsule of these ends around the points.
fn radius(points: &[Vector3<f64>], ends: &[Vector3<f64>; 2]) -> f64 {
    let along = ends[1] - ends[0];
    let square = along.norm_squared();
    let distance = |point: &Vector3<f64>| {
        let from = point - ends[0];
        let share = if square > 0.0 { (from.dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
        (from - along * share).norm_squared()
    };
    points.iter().map(distance).fold(0.0, f64::max).sqrt()
}

/// A segment along an axis, so short that the ends of the points are within its caps.
fn start(points: &[Vector3<f64>], middle: &Vector3<f64>, axis: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let along = |point: &Vector3<f64>| (point - middle).dot(axis);
    let across = |point: &Vector3<f64>| (point - middle - axis * along(point)).norm();
    let radius = points.iter().map(across).fold(0.0, f64::max);
    let low = points.iter().map(along).fold(f64::MAX, f64::min) + radius;
    let high = points.iter().map(along).fold(f64::MIN, f64::max) - radius;
    let (low, high) = if low < high { (low, high) } else { ((low + high) / 2.0, (low + high) / 2.0) };
    [middle + axis * low, middle + axis * high]
}

type Ends = SVector<f64, 6>;

/// Nelder and Mead's search for the ends of least volume.
fn search(points: &[Vector3<f64>], start: [Vector3<f64>; 2]) -> Capsule {
    let capsule = |at: &Ends| {
        let ends_m = [at.fixed_rows::<3>(0).into(), at.fixed_rows::<3>(3).into()];
        Capsule { ends_m, radius_m: radius(points, &ends_m) }
    };
    let volume = |at: &Ends| capsule(at).volume_m3();
    let mut best = Ends::from_iterator(start.iter().flat_map(|end| end.iter().copied()));
    let size = radius(points, &[start[0]; 2]);
    for restart in 0..RESTARTS {
        let edge = size * 0.2_f64.powi(restart as i32 + 1);
        best = simplex_search(&volume, best, edge);
    }
    capsule(&best)
}

fn simplex_search(value: &impl Fn(&Ends) -> f64, from: Ends, edge: f64) -> Ends {
    let corner = |at: Ends| (value(&at), at);
    let mut simplex: Vec<(f64, Ends)> =
        std::iter::once(from).chain((0..6).map(|i| from + Ends::ith(i, edge))).map(corner).collect();
    for _ in 0..EVALUATIONS / 2 {
        simplex.sort_by(|one, other| one.0.total_cmp(&other.0));
        let middle = simplex[..6].iter().map(|(_, at)| at).sum::<Ends>() / 6.0;
        let worst = simplex[6];
        let towards = |by: f64| corner(middle + (middle - worst.1) * by);
        let reflected = towards(1.0);
        let tried = if reflected.0 < simplex[0].0 {
            let stretched = towards(2.0);
            if stretched.0 < reflected.0 { stretched } else { reflected }
        } else if reflected.0 < simplex[5].0 {
            reflected
        } else {
            towards(if reflected.0 < worst.0 { 0.5 } else { -0.5 })
        };
        if tried.0 < worst.0.min(reflected.0).max(simplex[5].0) || tried.0 < worst.0 {
            simplex[6] = tried;
        } else {
            let best = simplex[0].1;
            simplex.iter_mut().skip(1).for_each(|of| *of = corner((best + of.1) / 2.0));
        }
    }
    simplex.into_iter().min_by(|one, other| one.0.total_cmp(&other.0)).map_or(from, |(_, at)| at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chains_for_tests::Numbers;

    /// A box whose edges are h, h and long: the best capsule has its axis in the middle, so only half-length and radius are open.
    fn best_by_grid(half: &Vector3<f64>) -> f64 {
        let corner = Vector3::new(half.x, half.y, 0.0).norm_squared();
        let volume = |s: f64| {
            let radius = (corner + (half.z - s) * (half.z - s)).sqrt();
            PI * radius * radius * (2.0 * s + 4.0 / 3.0 * radius)
        };
        (0..=20_000).map(|k| volume(half.z * f64::from(k) / 20_000.0)).fold(f64::MAX, f64::min)
    }

    #[test]
    fn the_capsule_around_a_long_box_has_the_least_volume() {
        for (k, half_m) in [[0.05, 0.05, 0.3], [0.04, 0.04, 0.1], [0.1, 0.1, 0.5]].into_iter().enumerate() {
            let half_m = Vector3::from(half_m);
            let mut numbers = Numbers(k as u64);
            let pose = Isometry3::new(numbers.vector(1.0), numbers.vector(2.0));
            let capsule = capsule_around(&Shape::Box { half_m }, &pose).expect("it has points");
            let ratio = capsule.volume_m3() / best_by_grid(&half_m);
            assert!((0.999..1.005).contains(&ratio), "{half_m:?}: {ratio}");
        }
    }

    #[test]
    fn a_capsule_contains_all_points_and_none_of_them_has_no_capsule() {
        let mut numbers = Numbers(9);
        let stretch = Vector3::new(0.3, 0.1, 0.05);
        let points: Vec<_> = (0..3000).map(|_| numbers.vector(1.0).component_mul(&stretch)).collect();
        let capsule = around_points(&points).expect("there are points");
        let outside = radius(&points, &capsule.ends_m) - capsule.radius_m;
        assert!(outside <= 0.0, "{outside}");
        assert!(around_points(&[]).is_none());
        let flat = around_points(&[Vector3::x(), Vector3::zeros()]).expect("there are points");
        assert!((flat.ends_m[0] - flat.ends_m[1]).norm() + 2.0 * flat.radius_m < 1.01, "{flat:?}");
    }
}
