//! The relaxed problem: soaks may be fractions. It is convex, and solved by simplicial decomposition over the vertices of its linear program.
//!
//! With `G` the negative gradient by the information and `D*` the most that soaks in the time can gain, no campaign has a criterion below
//!
//! `Φ² / (tr(G Λ) + D*)` for I and c, by the inequality of Cauchy and Schwarz; `Φ − (D* − Σ gain λ)` for D, by convexity.

use super::candidates::Candidates;
use super::continuum::any_temperature;
use super::{knapsack, shares};
use crate::criterion::Gradient;
use crate::{Campaign, CampaignCriterion, Soak, golden_section};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use nalgebra::{DMatrix, DVector};

/// A soak, and how many of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelaxedSoak {
    /// The soak.
    pub soak: Soak,
    /// Their number, which may be a fraction.
    pub count: f64,
}

/// The optimum of the relaxed problem.
#[derive(Debug, Clone, PartialEq)]
pub struct RelaxedCampaign {
    /// The soaks.
    pub soaks: Vec<RelaxedSoak>,
    /// The criterion.
    pub value: f64,
    /// No campaign in this time has a lower criterion, of soaks at these temperatures, with waits of half a time constant to six, and up to twelve blocks.
    pub lower_bound: f64,
    /// The same for soaks at any temperatures as far apart, in steps of 0.1 K.
    pub lower_bound_anywhere: f64,
    /// Standard deviation of each channel's polynomial over the range, in its unit.
    pub sd: Vec<f64>,
    /// How fast more time lowers the criterion, per minute.
    pub price_per_min: f64,
}

/// The gap at which the search ends.
const TOLERANCE: f64 = 1e-4;
/// Largest number of vertices that are added.
const ROUNDS: usize = 300;

/// Solves the relaxed problem.
///
/// # Errors
/// As [`design`](crate::design()).
pub fn relaxed(campaign: &Campaign) -> Result<RelaxedCampaign> {
    campaign.check()?;
    let candidates = Candidates::of(campaign, &campaign.temperatures_c());
    let minutes = campaign.soaking_min();
    let best = |gains: &[f64]| knapsack::best(&candidates, gains, campaign.cycles, minutes);
    let known = campaign.known();
    // the first vertex has as much information as there is, wherever
    let much = |k: usize| {
        let of = candidates.of_channels(k).zip(&campaign.channels);
        of.map(|((_, strength), channel)| strength * channel.goal_sd.powi(2)).sum()
    };
    let all: Vec<f64> = (0..candidates.len()).map(much).collect();
    let mut lists = vec![best(&all).soaks];
    let mut atoms = vec![candidates.information(&lists[0])];
    let mut share = DVector::from_element(1, 1.0);
    let (mut lower_bound, mut price) = (f64::NEG_INFINITY, 0.0);
    for _ in 0..ROUNDS {
        share = shares::best(campaign, &known, &atoms, share).ok_or_else(undetermined)?;
        let kept: Vec<usize> = (0..share.len()).filter(|&k| share[k] > 0.0).collect();
        lists = kept.iter().map(|&k| lists[k].clone()).collect();
        atoms = kept.iter().map(|&k| atoms[k].clone()).collect();
        share = DVector::from_iterator(kept.len(), kept.iter().map(|&k| share[k]));
        share /= share.sum();
        let information = shares::mixed(&known, &atoms, &share);
        let gradients = campaign.gradient_of(&information).ok_or_else(undetermined)?;
        let value = campaign.value_of(&information).ok_or_else(undetermined)?;
        let gains = candidates.gains(&gradients);
        let vertex = best(&gains);
        let at = At {
            campaign,
            value,
            spent: spent(&lists, &share, &gains),
            gradients: &gradients,
            known: &known,
        };
        let bound = at.lower_bound(vertex.bound);
        if bound > lower_bound {
            (lower_bound, price) = (bound, vertex.price);
        }
        if campaign.criterion.gap(value, lower_bound) < TOLERANCE || lists.len() == ROUNDS {
            break;
        }
        atoms.push(candidates.information(&vertex.soaks));
        lists.push(vertex.soaks);
        share = towards(campaign, &known, &atoms, &share);
    }
    let information = shares::mixed(&known, &atoms, &share);
    let gradients = campaign.gradient_of(&information).ok_or_else(undetermined)?;
    let value = campaign.value_of(&information).ok_or_else(undetermined)?;
    let spent = spent(&lists, &share, &candidates.gains(&gradients));
    let at = At { campaign, value, spent, gradients: &gradients, known: &known };
    let mut counts = vec![0.0; candidates.len()];
    for (list, share) in lists.iter().zip(share.iter()) {
        list.iter().for_each(|(k, count)| counts[*k] += share * count);
    }
    let soaks = counts.iter().enumerate().filter(|(_, count)| **count > 1e-9);
    Ok(RelaxedCampaign {
        soaks: soaks.map(|(k, &count)| RelaxedSoak { soak: candidates.soak(k), count }).collect(),
        value,
        lower_bound,
        lower_bound_anywhere: at.lower_bound(any_temperature(campaign, &gradients)).min(lower_bound),
        sd: campaign.sd(&information).ok_or_else(undetermined)?,
        price_per_min: price,
    })
}

/// A point of the search.
struct At<'a> {
    campaign: &'a Campaign,
    value: f64,
    /// What its soaks gain.
    spent: f64,
    gradients: &'a [Gradient],
    known: &'a [DMatrix<f64>],
}

impl At<'_> {
    /// The bound, where soaks in the time can gain at most `most`.
    fn lower_bound(&self, most: f64) -> f64 {
        match self.campaign.criterion {
            CampaignCriterion::D => self.value - (most - self.spent),
            CampaignCriterion::I | CampaignCriterion::C(_) => {
                let known =
                    self.gradients.iter().zip(self.known).map(|(of, known)| (&of.gradient * known).trace());
                self.value.powi(2) / (known.sum::<f64>() + most)
            }
        }
    }
}

fn spent(lists: &[Vec<(usize, f64)>], share: &DVector<f64>, gains: &[f64]) -> f64 {
    let of = |list: &Vec<(usize, f64)>| list.iter().map(|(k, count)| gains[*k] * count).sum::<f64>();
    lists.iter().zip(share.iter()).map(|(list, share)| share * of(list)).sum()
}

/// The share of the newest campaign that is best for the others as they are: golden section.
fn towards(
    campaign: &Campaign,
    known: &[DMatrix<f64>],
    atoms: &[Vec<DMatrix<f64>>],
    share: &DVector<f64>,
) -> DVector<f64> {
    let with = |part: f64| share.scale(1.0 - part).push(part);
    let at =
        |part: f64| campaign.value_of(&shares::mixed(known, atoms, &with(part))).unwrap_or(f64::INFINITY);
    with(golden_section::least(at, [0.0, 1.0 - 1e-6], 20))
}

pub(super) fn undetermined() -> Error {
    let message = "no campaign in this time determines all coefficients";
    let help = "give a longer budget_min, or smaller orders (fewer numbers in spread and beyond_sd)";
    Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help))
}
