//! Random starts of the search.
//!
//! The information is convex in the motion, so good motions lie at corners of the admissible region. Every
//! other start is a modest random motion, from which the search grows along the directions of most
//! information. The others are corners: the admissible motions that go furthest along a wave of random
//! frequency and phase.

use crate::convex::conic_program::ConicProgram;
use crate::limits::admissible_region::WatchedIntervals;
use crate::local_search::part::{Nodes, Part, mix};
use calibrant_core::simulate::Rng;
use nalgebra::SVector;
use rand::RngExt;

/// A factor far beyond every limit.
const FAR_FACTOR: f64 = 1e6;
/// Number of attempts to move a corner aside that leaves parameters undetermined.
const ATTEMPTS: usize = 5;
/// Part of the way by which such a corner is moved aside.
const ASIDE: f64 = 0.3;
/// A modest motion's share of the limits.
const MODEST: f64 = 0.1;

impl<const D: usize, const P: usize> Part<D, P> {
    /// An admissible motion, enlarged until it touches a limit on every axis where that helps. With noise in
    /// proportion to the jerk it may not help.
    pub(crate) fn stretched_if_better(&self, nodes: Nodes<D>) -> Nodes<D> {
        let stretched = self.stretched(nodes.clone());
        if self.value(&stretched) < self.value(&nodes) { stretched } else { nodes }
    }

    fn stretched(&self, mut nodes: Nodes<D>) -> Nodes<D> {
        for (k, region) in self.regions.iter().enumerate() {
            if region.limits.start.is_some() || region.limits.end.is_some() {
                continue;
            }
            let stretched: Vec<f64> = nodes.iter().map(|node| node[k] * FAR_FACTOR).collect();
            let factor = FAR_FACTOR / (1.0 + region.breach(&stretched));
            nodes.iter_mut().for_each(|node| node[k] *= factor);
        }
        self.restored(nodes)
    }

    /// Start `number`, moved slightly towards a corner where it leaves parameters undetermined. `None` where
    /// the convex solver fails.
    pub(crate) fn start(&self, number: usize, rng: &mut Rng) -> Option<Nodes<D>> {
        let mut start = if number.is_multiple_of(2) { self.modest(rng) } else { self.corner(wave, rng)? };
        for _ in 0..ATTEMPTS {
            if self.value(&start).is_finite() {
                break;
            }
            start = mix(&start, &self.corner(noise, rng)?, ASIDE);
        }
        Some(start)
    }

    /// The admissible motion that goes furthest along a wave, or white noise.
    pub(crate) fn random_corner(&self, rng: &mut Rng) -> Option<Nodes<D>> {
        let direction = if rng.random_bool(0.5) { wave } else { noise };
        self.corner(direction, rng)
    }

    /// A random motion well inside the limits, like the initial one. Its mean is zero where velocity or displacement are limited.
    fn modest(&self, rng: &mut Rng) -> Nodes<D> {
        let mut nodes: Nodes<D> = self.inside.clone();
        for (k, region) in self.regions.iter().enumerate() {
            let largest = region.size / region.tau[1];
            let jerk = region.limits.jerk.map_or(largest, |jerk| jerk.min(largest));
            let mut a = MODEST * region.size * rng.random_range(-1.0..1.0);
            let mut walk = vec![a];
            for i in 0..region.intervals() {
                a += MODEST * jerk * rng.random_range(-1.0..1.0) * (region.tau[i + 1] - region.tau[i]);
                walk.push(a);
            }
            let drifts = region.has_states();
            let mean = if drifts { walk.iter().sum::<f64>() / walk.len() as f64 } else { 0.0 };
            nodes.iter_mut().zip(walk).for_each(|(node, a)| node[k] += a - mean);
        }
        self.restored(nodes)
    }

    /// The admissible motion that goes furthest in a random direction.
    fn corner(&self, direction: impl Fn(usize, &mut Rng) -> Vec<f64>, rng: &mut Rng) -> Option<Nodes<D>> {
        let nodes = self.inside.len();
        let mut program = ConicProgram::default();
        program.add_variables(nodes * D);
        for (k, region) in self.regions.iter().enumerate() {
            region.add_to(&mut program, |i| i * D + k, &WatchedIntervals::default());
            for (i, weight) in direction(nodes, rng).into_iter().enumerate() {
                program.add_linear(i * D + k, -weight);
            }
        }
        let solution = program.solve()?;
        let corner = (0..nodes)
            .map(|i| SVector::from_fn(|k, _| self.regions[k].size * solution.x[i * D + k]))
            .collect();
        Some(self.restored(corner))
    }
}

/// White noise.
fn noise(nodes: usize, rng: &mut Rng) -> Vec<f64> {
    (0..nodes).map(|_| rng.random_range(-1.0..1.0)).collect()
}

/// A wave of random frequency and phase; a little noise decides between corners that are equally far.
fn wave(nodes: usize, rng: &mut Rng) -> Vec<f64> {
    let frequency = rng.random_range(0.0..std::f64::consts::PI);
    let phase = rng.random_range(0.0..std::f64::consts::TAU);
    let noise = noise(nodes, rng).into_iter().enumerate();
    noise.map(|(i, noise)| (frequency * i as f64 + phase).cos() + 0.01 * noise).collect()
}
