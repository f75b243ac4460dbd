//! The rounds of one iteration: a program of chains is solved again with the limits that its minimum broke between the
//! nodes, until it breaks none.

use super::{Nodes, Part, Peaks, mix};
use crate::convex::{ChainProgram, Stage, Stages};
use nalgebra::SVector;

/// Rounds of limits between the nodes.
const ROUNDS: usize = 12;
/// A breach between the nodes that may remain, absolute and relative to what is gained.
const BREACH: (f64, f64) = (1e-9, 0.3);
/// Share of the way to the motion inside all limits at which the interior-point method starts: from a motion far from
/// the solution, and from the solution of the last round.
const START: f64 = 0.1;
const AGAIN: f64 = 0.01;
/// Its gap there, relative to that share.
const GAP: f64 = 10.0;

/// Factors on the gap at the start of a program with a matrix, where the method got stuck.
const WIDER: [f64; 3] = [1e2, 1e4, 1e8];

/// What the rounds of one iteration leave for those of the next.
pub(crate) struct Rounds<const D: usize> {
    peaks: [Peaks; D],
    /// What the last model promised.
    promise: f64,
}

impl<const D: usize> Rounds<D> {
    pub(crate) fn new() -> Self {
        Self { peaks: std::array::from_fn(|_| Peaks::default()), promise: 1.0 }
    }

    /// The minimum of a program, and what it promises: the decrease of the objective from `a`. The program is made of
    /// limits between the nodes, and its stages may need more than the motion.
    pub(crate) fn solve<const P: usize>(
        &mut self,
        part: &Part<D, P>,
        a: &[SVector<f64, D>],
        program: impl Fn(&[Peaks; D]) -> ChainProgram,
        complete: impl Fn(&mut Stages),
    ) -> Option<(Nodes<D>, f64)> {
        let own =
            |nodes: &[SVector<f64, D>], k: usize| nodes.iter().map(|node| node[k]).collect::<Vec<f64>>();
        let near = (10.0 * self.promise).clamp(AGAIN / 10.0, START);
        let mut start = mix(&part.inside, a, 1.0 - near);
        let mut gap = GAP * near;
        for round in 1.. {
            let program = program(&self.peaks);
            let mut stages: Vec<Vec<Stage>> =
                part.regions.iter().enumerate().map(|(k, region)| region.stages(&own(&start, k))).collect();
            complete(&mut stages);
            let mut found = program.solve(stages.clone(), gap)?;
            // far from the best motion an eigenvalue may grow many times over, and the iteration must begin as far from the boundary
            for wider in WIDER {
                if program.matrix.is_none() || found.gap <= 0.1 * found.gained {
                    break;
                }
                let other = program.solve(stages.clone(), gap * wider)?;
                if other.gained > found.gained {
                    found = other;
                }
            }
            let next: Nodes<D> = (0..a.len())
                .map(|i| SVector::from_fn(|k, _| part.regions[k].size * found.stages[k][i][0]))
                .collect();
            let mut breach = 0.0_f64;
            for (k, region) in part.regions.iter().enumerate() {
                breach = breach.max(region.breach(&own(&next, k)));
                self.peaks[k].update(region, &own(&next, k));
            }
            self.promise = found.gained.max(found.gap);
            if round == ROUNDS || breach <= BREACH.0 + BREACH.1 * found.gained {
                for (k, region) in part.regions.iter().enumerate() {
                    self.peaks[k].forget(region, &found.stages[k]);
                }
                return Some((next, self.promise));
            }
            start = mix(&part.inside, &part.restored(next), 1.0 - AGAIN);
            gap = GAP * AGAIN;
        }
        None
    }
}
