//! Where the search starts: at random, from kicked motions, and from the axes of good ones combined.
//!
//! The information is convex in the motion, so good motions lie at corners of the admissible region. Every
//! other start is a modest random motion, from which the search grows along the directions of most
//! information. The others are corners: the admissible motions that go furthest along a wave of random
//! frequency and phase.
//!
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
//!
//! Starts for a full sensor: optima of the single axes, combined.
//!
//! The axes of a full sensor share parameters, so its motion is one problem of three times the size. But a
//! good one moves every axis about as well as it could be moved alone, and uncorrelated with the others. So
//! each axis is designed by itself first, which costs little. Then many triples of its optima are drawn, some
//! backwards in time, and the best ones are where the search begins.

use crate::DesignSettings;
use crate::convex::ConicProgram;
use crate::limits::WatchedIntervals;
use crate::local_search::{Nodes, Part, mix};
use calibrant_core::simulate::{Purpose, Rng, stream};
use nalgebra::SVector;
use rand::RngExt;
use rayon::prelude::*;

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

/// Triples drawn for each one that is kept.
const DRAWN: usize = 200;
/// Designs of a single axis for each one that is kept.
const DESIGNED: usize = 3;
/// First random streams of the combinations, and of the single axes.
const COMBINED: u64 = 1 << 32;
const SINGLE: u64 = 1 << 33;

impl<const D: usize, const P: usize> Part<D, P> {
    /// The best `count` combinations of optima of single axes. `axes` are the problems of each axis alone.
    pub(crate) fn combined(
        &self,
        axes: [&Part<1, 2>; D],
        count: usize,
        settings: &DesignSettings,
    ) -> Vec<Nodes<D>> {
        let mut pools: Vec<Vec<Nodes<1>>> = Vec::new();
        for (k, axis) in axes.iter().enumerate() {
            match axes[..k].iter().position(|other| other.is_like(axis)) {
                Some(same) => pools.push(pools[same].clone()),
                None => pools.push(axis.optima(settings)),
            }
        }
        if pools.iter().any(Vec::is_empty) {
            return Vec::new();
        }
        let mut drawn: Vec<(f64, Nodes<D>)> = (0..DRAWN * count)
            .into_par_iter()
            .filter(|_| !settings.interruption.is_asked())
            .map(|number| {
                let mut rng = stream(settings.seed, Purpose::Start, COMBINED + number as u64);
                let mut nodes = vec![SVector::zeros(); self.inside.len()];
                for (k, pool) in pools.iter().enumerate() {
                    let one = &pool[rng.random_range(0..pool.len())];
                    let backwards = rng.random_bool(0.5);
                    for i in 0..nodes.len() {
                        nodes[i][k] = one[if backwards { nodes.len() - 1 - i } else { i }][0];
                    }
                }
                let nodes = self.restored(nodes);
                (self.value(&nodes), nodes)
            })
            .collect();
        drawn.retain(|(value, _)| value.is_finite());
        drawn.sort_by(|one, other| one.0.total_cmp(&other.0));
        drawn.dedup_by(|one, other| one.0 == other.0);
        drawn.into_iter().take(count).map(|(_, nodes)| nodes).collect()
    }

    /// Optima from random starts, the best of them.
    fn optima(&self, settings: &DesignSettings) -> Vec<Nodes<D>> {
        let mut found: Vec<_> = (0..DESIGNED * settings.starts)
            .into_par_iter()
            .filter(|_| !settings.interruption.is_asked())
            .filter_map(|number| {
                let mut rng = stream(settings.seed, Purpose::Start, SINGLE + number as u64);
                let outcome = self.improve(self.start(number, &mut rng)?, settings);
                outcome.value.is_finite().then_some(outcome)
            })
            .collect();
        found.sort_by(|one, other| one.value.total_cmp(&other.value));
        found.truncate(found.len().div_ceil(DESIGNED));
        found.into_iter().map(|outcome| outcome.nodes).collect()
    }
}
