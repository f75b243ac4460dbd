//! Starts for a full sensor: optima of the single axes, combined.
//!
//! The axes of a full sensor share parameters, so its motion is one problem of three times the size. But a
//! good one moves every axis about as well as it could be moved alone, and uncorrelated with the others. So
//! each axis is designed by itself first, which costs little. Then many triples of its optima are drawn, some
//! backwards in time, and the best ones are where the search begins.

use crate::DesignSettings;
use crate::local_search::part::{Nodes, Part};
use calibrant_core::simulate::{Purpose, stream};
use nalgebra::SVector;
use rand::RngExt;
use rayon::prelude::*;

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
