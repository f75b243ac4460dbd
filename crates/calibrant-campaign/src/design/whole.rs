//! Whole soaks from fractions of them: rounding, then moves of one place, or of two where time must be paid.

use super::RelaxedCampaign;
use super::candidates::Candidates;
use crate::campaign::MOST_BLOCKS;
use crate::{Campaign, Soak};

/// Largest number of moves.
const MOVES: usize = 400;
/// A move lowers the criterion by this share at least.
const LOWER: f64 = 1e-9;
/// Moves that look best to first order are tried, up to this many that turn out worse.
const TRIES: usize = 60;

/// A place in a cycle, and what is done there: a candidate, or nothing.
type Plan = Vec<Option<usize>>;

pub(super) fn whole(campaign: &Campaign, relaxed: &RelaxedCampaign) -> Vec<Soak> {
    let search = Search { campaign, candidates: Candidates::of(campaign, &campaign.temperatures_c()) };
    let mut plan = search.within_time(search.rounded(relaxed));
    search.fill(&mut plan, relaxed);
    let mut now = search.value(&plan);
    for _ in 0..MOVES {
        let Some((next, then)) = search.better(&plan, now) else { break };
        (plan, now) = (next, then);
    }
    let mut soaks = search.soaks(&plan);
    let key = |soak: &Soak| (soak.direction, soak.direction.sign() * soak.temperature_c);
    soaks.sort_by(|one, other| {
        let ((d, t), (e, u)) = (key(one), key(other));
        d.cmp(&e).then(t.total_cmp(&u))
    });
    soaks
}

struct Search<'a> {
    campaign: &'a Campaign,
    candidates: Candidates,
}

impl Search<'_> {
    fn place(&self, slot: usize) -> usize {
        slot / self.campaign.cycles
    }

    /// The nearest whole soaks: at each place those with most of the fractions there.
    fn rounded(&self, relaxed: &RelaxedCampaign) -> Plan {
        let slots = self.candidates.places.len() * self.campaign.cycles;
        let mut plan = vec![None; slots];
        for (place, &(t, d)) in self.candidates.places.iter().enumerate() {
            let here = |of: &&super::RelaxedSoak| of.soak.temperature_c == t && of.soak.direction == d;
            let count: f64 = relaxed.soaks.iter().filter(here).map(|of| of.count).sum();
            let most = relaxed.soaks.iter().filter(here).max_by(|a, b| a.count.total_cmp(&b.count));
            let Some(most) = most else { continue };
            let first = place * self.candidates.choices();
            let k =
                (first..first + self.candidates.choices()).find(|&k| self.candidates.soak(k) == most.soak);
            let whole = (count.round() as usize).min(self.campaign.cycles);
            plan[place * self.campaign.cycles..][..whole].fill(k);
        }
        plan
    }

    /// Leaves out soaks, those with the least effect on the criterion, until the others fit.
    fn within_time(&self, mut plan: Plan) -> Plan {
        while self.minutes(&plan) > self.campaign.soaking_min() + 1e-9 {
            let lighter = (0..plan.len()).filter(|&slot| plan[slot].is_some()).map(|slot| {
                let mut lighter = plan.clone();
                lighter[slot] = lighter[slot].filter(|k| k % MOST_BLOCKS > 0).map(|k| k - 1);
                let value = self.value(&lighter);
                (lighter, value)
            });
            match lighter.min_by(|one, other| one.1.total_cmp(&other.1)) {
                Some((lighter, _)) => plan = lighter,
                None => break,
            }
        }
        plan
    }

    /// Adds short soaks where the fractions are largest, as long as they fit, if the plan has none.
    fn fill(&self, plan: &mut Plan, relaxed: &RelaxedCampaign) {
        if plan.iter().any(Option::is_some) {
            return;
        }
        let mut fractions: Vec<_> = relaxed.soaks.iter().collect();
        fractions.sort_by(|one, other| other.count.total_cmp(&one.count));
        for of in fractions {
            let here =
                |(t, d): &(f64, crate::Direction)| (*t, *d) == (of.soak.temperature_c, of.soak.direction);
            let Some(place) = self.candidates.places.iter().position(here) else { continue };
            let (slot, shortest) = (place * self.campaign.cycles, place * self.candidates.choices());
            let before = plan[slot].replace(shortest);
            if self.minutes(plan) > self.campaign.soaking_min() + 1e-9 {
                plan[slot] = before;
            }
        }
    }

    fn minutes(&self, plan: &Plan) -> f64 {
        plan.iter().flatten().map(|&k| self.candidates.minutes(k)).sum()
    }

    fn soaks(&self, plan: &Plan) -> Vec<Soak> {
        plan.iter().flatten().map(|&k| self.candidates.soak(k)).collect()
    }

    fn value(&self, plan: &Plan) -> f64 {
        let information = self.campaign.information(&self.soaks(plan));
        self.campaign.value_of(&information).unwrap_or(f64::INFINITY)
    }

    /// What may stand at a place instead: the neighbours in wait and blocks, nothing, or a short soak.
    fn instead(&self, plan: &Plan, slot: usize) -> Vec<Option<usize>> {
        let first = self.place(slot) * self.candidates.choices();
        let Some(k) = plan[slot] else {
            let waits = self.candidates.waits_min.len().min(3);
            return (0..waits).map(|wait| Some(first + wait * MOST_BLOCKS)).collect();
        };
        let (wait, n) = ((k - first) / MOST_BLOCKS, (k - first) % MOST_BLOCKS);
        let waits = wait.saturating_sub(1)..(wait + 2).min(self.candidates.waits_min.len());
        let near = waits.flat_map(|w| (n.saturating_sub(1)..(n + 2).min(MOST_BLOCKS)).map(move |n| (w, n)));
        let near = near.map(|(w, n)| Some(first + w * MOST_BLOCKS + n)).filter(|other| *other != Some(k));
        near.chain([None]).collect()
    }

    /// The first of the most promising moves that lowers the criterion. To first order a move gains what its soaks gain; by convexity, never more.
    fn better(&self, plan: &Plan, now: f64) -> Option<(Plan, f64)> {
        let information = self.campaign.information(&self.soaks(plan));
        let gains = self.candidates.gains(&self.campaign.gradient_of(&information)?);
        let of = |k: Option<usize>| k.map_or((0.0, 0.0), |k| (gains[k], self.candidates.minutes(k)));
        let single: Vec<(usize, Option<usize>, f64, f64)> = (0..plan.len())
            .flat_map(|slot| self.instead(plan, slot).into_iter().map(move |to| (slot, to)))
            .map(|(slot, to)| {
                let (before, after) = (of(plan[slot]), of(to));
                (slot, to, after.0 - before.0, after.1 - before.1)
            })
            .collect();
        let left = self.campaign.soaking_min() - self.minutes(plan) + 1e-9;
        let mut moves: Vec<(f64, usize, Option<usize>)> = Vec::new();
        for (one, first) in single.iter().enumerate() {
            if first.3 <= left && first.2 > 0.0 {
                moves.push((first.2, one, None));
            }
            for (other, second) in single.iter().enumerate().take(one) {
                if second.0 != first.0 && first.3 + second.3 <= left && first.2 + second.2 > 0.0 {
                    moves.push((first.2 + second.2, one, Some(other)));
                }
            }
        }
        moves.sort_by(|one, other| other.0.total_cmp(&one.0));
        let tried = moves.iter().take(TRIES).map(|&(_, one, other)| {
            let mut next = plan.clone();
            for k in [Some(one), other].into_iter().flatten() {
                next[single[k].0] = single[k].1;
            }
            let then = self.value(&next);
            (next, then)
        });
        tried
            .min_by(|one, other| one.1.total_cmp(&other.1))
            .filter(|(_, then)| *then < now - LOWER * now.abs())
    }
}
