//! Balls on the links, which must not meet.

use crate::Surroundings;
use crate::world::{BodyPair, Proximity};
use nalgebra::{IsometryMatrix3, Point3, Vector3};

/// A ball: frame, centre in it, radius.
pub(crate) type Ball = (usize, Vector3<f64>, f64);

/// Balls, of which each pair is a row.
pub(crate) struct Spheres(pub(crate) Vec<Ball>);

impl Spheres {
    fn pairs(&self) -> impl Iterator<Item = (&Ball, &Ball)> {
        (0..self.0.len()).flat_map(move |i| (0..i).map(move |j| (&self.0[i], &self.0[j])))
    }
}

impl Surroundings for Spheres {
    fn rows(&self) -> usize {
        self.pairs().count()
    }

    fn pair(&self, row: usize) -> BodyPair {
        let (a, b) = self.pairs().nth(row).expect("a row");
        let extent = |ball: &Ball| ball.1.norm() + ball.2;
        BodyPair {
            names: [a, b].map(|ball| format!("ball {}", ball.0)),
            frames: [a.0, b.0],
            extents_m: [extent(a), extent(b)],
        }
    }

    fn proximities(&self, frames: &[IsometryMatrix3<f64>], out: &mut [Proximity]) {
        for (near, (a, b)) in out.iter_mut().zip(self.pairs()) {
            let at = |ball: &Ball| (frames[ball.0] * Point3::from(ball.1)).coords;
            let way = at(b) - at(a);
            let normal = way.normalize();
            *near = Proximity {
                distance_m: way.norm() - a.2 - b.2,
                a: (a.0, at(a) + normal * a.2),
                b: (b.0, at(b) - normal * b.2),
                normal,
            };
        }
    }
}
