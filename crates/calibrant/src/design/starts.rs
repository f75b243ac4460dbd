//! Where the search begins.
//!
//! The criterion is the convex-to-be-maximised kind: good motions lie at the corners of the admissible region. So a start is a corner, the admissible
//! motion that goes furthest in a random direction: every other one white noise, the others a wave of random frequency and phase.

use super::conic::ConicProgram;
use super::local::{Nodes, Part};
use super::region::Watch;
use crate::simulate::Rng;
use nalgebra::SVector;
use rand::RngExt;

/// Far beyond every limit.
const STRETCH: f64 = 1e6;

impl<const D: usize, const P: usize> Part<D, P> {
    /// An admissible motion, stretched until it touches a limit on every axis.
    pub(super) fn stretched(&self, mut nodes: Nodes<D>) -> Nodes<D> {
        for (k, region) in self.regions.iter().enumerate() {
            if region.limits.start.is_some() || region.limits.end.is_some() {
                continue;
            }
            let stretched: Vec<f64> = nodes.iter().map(|node| node[k] * STRETCH).collect();
            let factor = STRETCH / (1.0 + region.breach(&stretched));
            nodes.iter_mut().for_each(|node| node[k] *= factor);
        }
        self.restored(nodes)
    }

    /// The corner of start `number`; `None` where the convex solver fails.
    pub(super) fn corner(&self, number: usize, rng: &mut Rng) -> Option<Nodes<D>> {
        let nodes = self.inside.len();
        let mut program = ConicProgram::default();
        program.add_variables(nodes * D);
        for (k, region) in self.regions.iter().enumerate() {
            region.add_to(&mut program, |i| i * D + k, &Watch::default());
            let frequency = rng.random_range(0.0..std::f64::consts::PI);
            let phase = rng.random_range(0.0..std::f64::consts::TAU);
            for i in 0..nodes {
                let noise: f64 = rng.random_range(-1.0..1.0);
                let wave = (frequency * i as f64 + phase).cos();
                program.add_linear(
                    i * D + k,
                    if number.is_multiple_of(2) { noise } else { wave + 0.01 * noise },
                );
            }
        }
        let solution = program.solve()?;
        let corner = (0..nodes)
            .map(|i| SVector::from_fn(|k, _| self.regions[k].size * solution.x[i * D + k]))
            .collect();
        Some(self.restored(corner))
    }
}
