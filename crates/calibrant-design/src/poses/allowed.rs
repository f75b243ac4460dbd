//! The directions in which the sensor may be held.

use nalgebra::Vector3;
use rand::{Rng, RngExt};

/// The directions of the specific force (up), in the sensor's axes, that a hold may have.
#[derive(Debug, Clone, PartialEq)]
pub enum Allowed {
    /// All of them.
    Anywhere,
    /// These, as unit vectors.
    Of(Vec<Vector3<f64>>),
    /// Those within an angle of these unit vectors, rad.
    Near(Vec<Vector3<f64>>, f64),
}

impl Allowed {
    /// The directions of a cube: its 6 faces, 18 with the edges, 26 with the corners.
    #[must_use]
    pub fn cube(edges: bool, corners: bool) -> Self {
        let mut directions = Vec::new();
        for steps in 1..=1 + 2 * usize::from(edges || corners) {
            for number in 0..27_i32 {
                let v = Vector3::new(number / 9 - 1, number / 3 % 3 - 1, number % 3 - 1);
                let wanted = [true, edges, corners];
                if v.abs().sum() as usize == steps && wanted[steps - 1] {
                    directions.push(v.cast::<f64>().normalize());
                }
            }
        }
        Self::Of(directions)
    }

    /// The allowed direction next to `direction`, which must not be zero.
    #[must_use]
    pub(super) fn nearest(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        let unit = direction.normalize();
        let nearest_of = |list: &[Vector3<f64>]| {
            list.iter().copied().max_by(|a, b| a.dot(&unit).total_cmp(&b.dot(&unit))).unwrap_or(unit)
        };
        match self {
            Self::Anywhere => unit,
            Self::Of(list) => nearest_of(list),
            Self::Near(list, within) => {
                let axis = nearest_of(list);
                let across = unit - axis * axis.dot(&unit);
                if axis.angle(&unit) <= *within {
                    return unit;
                }
                let across = across.try_normalize(1e-12).unwrap_or_else(|| perpendicular(&axis));
                axis * within.cos() + across * within.sin()
            }
        }
    }

    /// Are there whole regions of directions, in which a pose can move a little?
    pub(super) fn is_continuous(&self) -> bool {
        !matches!(self, Self::Of(_))
    }

    /// A random allowed direction.
    pub(super) fn draw(&self, rng: &mut impl Rng) -> Vector3<f64> {
        match self {
            Self::Anywhere => {
                let z: f64 = rng.random_range(-1.0..1.0);
                let turn = rng.random_range(0.0..std::f64::consts::TAU);
                let radius = (1.0 - z * z).sqrt();
                Vector3::new(radius * turn.cos(), radius * turn.sin(), z)
            }
            Self::Of(list) => list[rng.random_range(0..list.len())],
            Self::Near(list, within) => {
                let axis = list[rng.random_range(0..list.len())];
                let across = perpendicular(&axis);
                let turn = rng.random_range(0.0..std::f64::consts::TAU);
                let across = across * turn.cos() + axis.cross(&across) * turn.sin();
                // the axis and the rim are often best
                let angle = within * rng.random_range(0.0..1.5_f64).min(1.0);
                axis * angle.cos() + across * angle.sin()
            }
        }
    }

    /// Some allowed directions, which determine what all of them determine: of each cone the axis and two circles, so that no polynomial
    /// of degree 2 is zero on them and not on the cone.
    pub(super) fn sample(&self) -> Vec<Vector3<f64>> {
        /// Directions on a circle, and cells along the edge of the grid where all are allowed.
        const COUNT: usize = 8;
        let Self::Near(list, within) = self else { return self.grid(COUNT).0 };
        let on_circles = |axis: &Vector3<f64>| {
            let (axis, one) = (*axis, perpendicular(axis));
            let other = axis.cross(&one);
            let on_circle = move |k: usize| {
                let angle = if k < COUNT { *within } else { 0.5 * within };
                let (sin, cos) = (std::f64::consts::TAU * k as f64 / COUNT as f64).sin_cos();
                axis * angle.cos() + (one * cos + other * sin) * angle.sin()
            };
            (0..2 * COUNT).map(on_circle).chain([axis])
        };
        list.iter().flat_map(on_circles).collect()
    }

    /// Directions so dense that every allowed one is within an angle of one of them, and that angle, rad.
    ///
    /// The grid is that of the centres of the cells of a cube's faces, `cells` along each edge, seen from the
    /// centre of the cube. The half diagonal of a cell bounds the angle.
    pub(super) fn grid(&self, cells: usize) -> (Vec<Vector3<f64>>, f64) {
        let radius = std::f64::consts::SQRT_2 / cells as f64;
        let on_cube = || {
            let place = move |k: usize| (2 * k + 1) as f64 / cells as f64 - 1.0;
            (0..6 * cells * cells).map(move |number| {
                let (face, cell) = (number / (cells * cells), number % (cells * cells));
                let sign = if face % 2 == 0 { 1.0 } else { -1.0 };
                let mut v = Vector3::zeros();
                v[face / 2] = sign;
                v[(face / 2 + 1) % 3] = place(cell / cells);
                v[(face / 2 + 2) % 3] = place(cell % cells);
                v.normalize()
            })
        };
        match self {
            Self::Anywhere => (on_cube().collect(), radius),
            Self::Of(list) => (list.clone(), 0.0),
            Self::Near(list, within) => {
                let cosine = (within + radius).min(std::f64::consts::PI).cos();
                let near = |u: &Vector3<f64>| list.iter().any(|axis| axis.dot(u) >= cosine);
                (on_cube().filter(near).collect(), radius)
            }
        }
    }
}

/// A unit vector perpendicular to `axis`.
pub(super) fn perpendicular(axis: &Vector3<f64>) -> Vector3<f64> {
    axis.cross(&Vector3::ith(axis.iamin(), 1.0)).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant_core::simulate::{Purpose, stream};

    #[test]
    fn every_direction_is_near_a_point_of_the_grid() {
        let mut rng = stream(1, Purpose::Start, 0);
        for allowed in [Allowed::Anywhere, Allowed::Near(vec![Vector3::x(), -Vector3::z()], 0.3)] {
            let (grid, radius) = allowed.grid(40);
            for _ in 0..200 {
                let u = allowed.draw(&mut rng);
                assert!((allowed.nearest(&u) - u).norm() < 1e-9, "{u}");
                assert!(grid.iter().any(|point| point.angle(&u) <= radius), "{u}");
            }
        }
    }

    #[test]
    fn a_cube_has_six_eighteen_and_twenty_six_directions() {
        for (edges, corners, count) in [(false, false, 6), (true, false, 18), (true, true, 26)] {
            let Allowed::Of(list) = Allowed::cube(edges, corners) else { panic!("a list") };
            assert_eq!(list.len(), count);
            assert!(list.iter().all(|u| (u.norm() - 1.0).abs() < 1e-15));
            assert!(list.iter().enumerate().all(|(k, u)| list[..k].iter().all(|v| u.angle(v) > 0.5)));
        }
    }

    #[test]
    fn a_direction_outside_a_cone_goes_to_its_rim() {
        let cone = Allowed::Near(vec![Vector3::z()], 0.2);
        let rim = cone.nearest(&Vector3::new(3.0, 0.0, 3.0));
        assert!((rim - Vector3::new(0.2_f64.sin(), 0.0, 0.2_f64.cos())).norm() < 1e-15);
    }
}
