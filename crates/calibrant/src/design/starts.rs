//! Where the search begins.
//!
//! The criterion is the convex-to-be-maximised kind: good motions lie at the corners of the admissible region. So a start is a corner, the admissible
//! motion that goes furthest in a random direction. Directions are white noise, a wave of random frequency and phase, and a jerk at its limit all the
//! time whose sign is random but for the turns at the limit of the acceleration: the best there is where noise grows with the jerk.

use super::conic::ConicProgram;
use super::local::{Nodes, Part};
use super::region::{Region, Watch};
use crate::simulate::Rng;
use nalgebra::SVector;
use rand::RngExt;

/// Far beyond every limit.
const STRETCH: f64 = 1e6;
/// How often a corner that leaves parameters undetermined is moved aside, and how far.
const ATTEMPTS: usize = 5;
const ASIDE: f64 = 0.3;

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

    /// The corner of start `number`, moved a little towards other corners where it leaves parameters undetermined; `None` where the convex solver fails.
    pub(super) fn corner(&self, number: usize, rng: &mut Rng) -> Option<Nodes<D>> {
        let mut start = self.furthest(number, rng)?;
        for _ in 0..ATTEMPTS {
            if self.value(&start).is_finite() {
                break;
            }
            start = mix(&start, &self.furthest(0, rng)?, ASIDE);
        }
        Some(start)
    }

    /// An optimum, moved towards a random corner by a random part of the way.
    pub(super) fn kicked(&self, optimum: &[SVector<f64, D>], rng: &mut Rng) -> Option<Nodes<D>> {
        let part = rng.random_range(0.05..0.6);
        let number = rng.random_range(0..3);
        Some(self.restored(mix(optimum, &self.furthest(number, rng)?, part)))
    }

    /// The admissible motion that goes furthest in a random direction of kind `number % 3`.
    fn furthest(&self, number: usize, rng: &mut Rng) -> Option<Nodes<D>> {
        let nodes = self.inside.len();
        let mut program = ConicProgram::default();
        program.add_variables(nodes * D);
        for (k, region) in self.regions.iter().enumerate() {
            region.add_to(&mut program, |i| i * D + k, &Watch::default());
            for (i, weight) in direction(number, region, rng).into_iter().enumerate() {
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

/// The point this part of the way from one motion to another.
fn mix<const D: usize>(from: &[SVector<f64, D>], to: &[SVector<f64, D>], part: f64) -> Nodes<D> {
    from.iter().zip(to).map(|(from, to)| from + (to - from) * part).collect()
}

/// The direction of start `number`, by node.
fn direction(number: usize, region: &Region, rng: &mut Rng) -> Vec<f64> {
    let nodes = region.intervals() + 1;
    let frequency = rng.random_range(0.0..std::f64::consts::PI);
    let phase = rng.random_range(0.0..std::f64::consts::TAU);
    let noise: Vec<f64> = (0..nodes).map(|_| rng.random_range(-1.0..1.0)).collect();
    match number % 3 {
        0 => noise,
        1 => (0..nodes).map(|i| (frequency * i as f64 + phase).cos() + 0.01 * noise[i]).collect(),
        _ => {
            let largest = region.limits.acceleration.or(region.limits.intercept).unwrap_or(f64::INFINITY);
            let jerk = region.limits.jerk.unwrap_or(region.size / region.tau[1]);
            let mut a = noise[0] * region.size;
            let mut weights = vec![0.01 * noise[0]; nodes];
            for i in 0..nodes - 1 {
                let step = jerk * (region.tau[i + 1] - region.tau[i]);
                let sign = if (a + step).abs() > largest && (a - step).abs() < largest {
                    -1.0
                } else if (a - step).abs() > largest && (a + step).abs() < largest {
                    1.0
                } else {
                    noise[i + 1].signum()
                };
                a += sign * step;
                weights[i] -= sign;
                weights[i + 1] += sign;
            }
            weights
        }
    }
}
