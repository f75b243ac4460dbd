//! Kicks: starts that are made from the optima found so far.
//!
//! An optimum is a sequence of swings, and a better one often differs in a few of them. A kick changes part
//! of a good motion and keeps the rest:
//!
//! - it goes most of the way to a random corner of the admissible region,
//! - it mirrors the motion of one axis in a window of time, or shifts it,
//! - it continues one optimum with another from some time on,
//! - for several axes, it takes over one axis of another optimum, forwards or backwards in time.
//!
//! The admissible motion nearest to the result is the start: a change in one place would otherwise carry the
//! displacement away for the rest of the motion.

use crate::convex::conic_program::ConicProgram;
use crate::limits::admissible_region::WatchedIntervals;
use crate::local_search::part::{Nodes, Part, mix};
use calibrant_core::simulate::Rng;
use nalgebra::SVector;
use rand::RngExt;

/// The part of the way to a corner that a kick goes: shorter ones come back.
const WAY: std::ops::Range<f64> = 0.4..0.9;
/// Number of optima from which kicks are made.
const PARENTS: usize = 10;
/// Largest shift, as a share of the motion.
const SHIFT: f64 = 0.2;

impl<const D: usize, const P: usize> Part<D, P> {
    /// A kick from one of the `optima`, the best first.
    pub(crate) fn kicked(&self, optima: &[&Nodes<D>], rng: &mut Rng) -> Option<Nodes<D>> {
        let parents = optima.len().min(PARENTS);
        // the better, the more often
        let draw = |rng: &mut Rng| {
            let share: f64 = rng.random_range(0.0..1.0);
            optima[(share * share * parents as f64) as usize]
        };
        let mut child = draw(rng).clone();
        let nodes = child.len();
        let axis = rng.random_range(0..D);
        match rng.random_range(0..5) {
            0 => {
                let part = rng.random_range(WAY);
                return Some(self.restored(mix(&child, &self.random_corner(rng)?, part)));
            }
            1 => {
                let length = rng.random_range(2..=(nodes / 2).max(2));
                let first = rng.random_range(0..=nodes - length.min(nodes));
                child[first..(first + length).min(nodes)]
                    .iter_mut()
                    .for_each(|node| node[axis] = -node[axis]);
            }
            2 => {
                let most = ((SHIFT * nodes as f64) as usize).max(1);
                let by = rng.random_range(1..=most);
                let old = child.clone();
                let backwards = rng.random_bool(0.5);
                for (i, node) in child.iter_mut().enumerate() {
                    let from = if backwards { i + by } else { (i + nodes) - by } % nodes;
                    node[axis] = old[from][axis];
                }
            }
            3 if D > 1 => {
                let (other, theirs) = (draw(rng), rng.random_range(0..D));
                let reversed = rng.random_bool(0.5);
                for (i, node) in child.iter_mut().enumerate() {
                    let from = if reversed { nodes - 1 - i } else { i };
                    node[axis] = other[from][theirs];
                }
            }
            _ => {
                let (other, cut) = (draw(rng), rng.random_range(1..nodes));
                let sign = if rng.random_bool(0.5) { 1.0 } else { -1.0 };
                let axes = if rng.random_bool(0.5) { 0..D } else { axis..axis + 1 };
                for i in cut..nodes {
                    axes.clone().for_each(|k| child[i][k] = sign * other[i][k]);
                }
            }
        }
        self.nearest(&child)
    }

    /// The admissible motion nearest to given nodes.
    fn nearest(&self, nodes: &[SVector<f64, D>]) -> Option<Nodes<D>> {
        let mut nearest = nodes.to_vec();
        for (k, region) in self.regions.iter().enumerate() {
            let mut program = ConicProgram::default();
            program.add_variables(nodes.len());
            region.add_to(&mut program, |i| i, &WatchedIntervals::default());
            for (i, node) in nodes.iter().enumerate() {
                program.add_square(i, 1.0);
                program.add_linear(i, -node[k] / region.size);
            }
            let solution = program.solve()?;
            nearest.iter_mut().zip(&solution.x).for_each(|(node, x)| node[k] = region.size * x);
        }
        Some(self.restored(nearest))
    }
}
