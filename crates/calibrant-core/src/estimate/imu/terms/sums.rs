//! The sums over the terms: `χ²`, its degrees of freedom, and the normal equations.
//!
//! The unknown directions `f_j` of the holds are a chain, and what stands between them is its links. With the quantities as its border, this is an arrowhead.

use crate::arrowhead::{Arrowhead, Increment, Link};
use crate::estimate::imu::model::{ImuModel, State};
use crate::estimate::imu::terms::known::Known;
use crate::estimate::imu::terms::list::{TERMS, terms};
use crate::estimate::imu::terms::term::{At, Derivatives, Place, Residual, Term};
use crate::solve::Equations;

/// `χ²` at a point.
pub(crate) fn chi2(at: &At<'_>) -> f64 {
    let of_hold = |k: usize| terms(Place::Hold).map(|term| chi2_of(term, at, k)).sum::<f64>();
    let of_holds: f64 = (0..at.model.holds.len()).map(of_hold).sum();
    let others = TERMS.into_iter().filter(|term| term.place() != Place::Hold);
    others.map(|term| chi2_of_all(term, at)).fold(of_holds, |sum, of_term| sum + of_term)
}

fn chi2_of(term: &dyn Term, at: &At<'_>, k: usize) -> f64 {
    term.residual(at, k).map_or(0.0, |residual| residual.chi2())
}

fn chi2_of_all(term: &dyn Term, at: &At<'_>) -> f64 {
    (0..term.count(at.model)).map(|k| chi2_of(term, at, k)).sum()
}

impl ImuModel<'_> {
    /// The part of `χ²` that what is known beforehand has.
    pub(in crate::estimate) fn prior_chi2(&self, state: &State) -> f64 {
        chi2_of_all(&Known, &At { model: self, state, rotations: &[] })
    }
}

/// Its degrees of freedom: observations less unknowns.
pub(crate) fn degrees_of_freedom(at: &At<'_>) -> usize {
    let counted =
        |term: &dyn Term| (0..term.count(at.model)).filter(|k| term.residual(at, *k).is_some()).count();
    let observed: usize = TERMS.into_iter().map(|term| term.rows() * counted(term)).sum();
    let directions = at.model.holds.iter().filter(|hold| hold.known.is_none()).count();
    observed.saturating_sub(at.model.quantities.len() + 2 * directions)
}

/// The normal equations at a point. `None` where a direction is not determined.
pub(crate) fn normal_equations<const P: usize>(at: &At<'_>) -> Option<Equations<2, P>> {
    let is_free = |hold: usize| at.model.holds[hold].known.is_none();
    let mut alone = Link::<2, P>::zero();
    for term in terms(Place::Alone).rev() {
        (0..term.count(at.model)).for_each(|k| add(&mut alone, term, (at, k), [false; 2]));
    }
    let Link { c: mut border, gp: rhs, .. } = alone;
    let mut unreduced = border.diagonal();
    // places without a quantity
    for k in at.model.quantities.len()..P {
        border[(k, k)] = 1.0;
    }
    let link = |hold: usize| {
        let mut link = Link::<2, P>::zero();
        for term in terms(Place::Hold) {
            add(&mut link, term, (at, hold), [false, is_free(hold)]);
        }
        if let Some(before) = hold.checked_sub(1) {
            for term in terms(Place::BetweenHolds).filter(|term| before < term.count(at.model)) {
                add(&mut link, term, (at, before), [is_free(before), is_free(hold)]);
            }
        }
        unreduced += link.c.diagonal();
        link
    };
    let increment = |hold: usize| Increment { fixed: [!is_free(hold); 2], ..Increment::unknown() };
    let system = Arrowhead::eliminate(at.model.holds.len(), link, increment, border, rhs).ok()?;
    Some((system, unreduced))
}

/// Adds one observation. A direction that is not free does not turn.
fn add<const P: usize>(
    link: &mut Link<2, P>,
    term: &dyn Term,
    (at, k): (&At<'_>, usize),
    is_free: [bool; 2],
) {
    let Some(Residual { r, weight }) = term.residual(at, k) else { return };
    let Derivatives { by_directions: [before, here], by_quantities } = term.derivatives(at, k);
    let (before, here) = (before.filter(|_| is_free[0]), here.filter(|_| is_free[1]));
    let (w, g) = (weight.matrix(), by_quantities.fixed_columns::<P>(0));
    let wr = w * r;
    // most terms see the quantities of one sensor: the other columns are zero
    let is_seen = |k: &usize| g.column(*k).iter().any(|entry| *entry != 0.0);
    let seen = (0..P).find(is_seen).unwrap_or(P)..(0..P).rfind(is_seen).map_or(P, |last| last + 1);
    for j in seen.clone() {
        let weighted = w * g.column(j);
        for i in seen.clone() {
            link.c[(i, j)] += g.column(i).dot(&weighted);
        }
        link.gp[j] += g.column(j).dot(&wr);
        for (b, by_direction) in [(&mut link.b0, &before), (&mut link.b1, &here)] {
            if let Some(by_direction) = by_direction {
                b.set_column(j, &(b.column(j) + by_direction.tr_mul(&weighted)));
            }
        }
    }
    if let Some(before) = &before {
        link.h00 += before.tr_mul(&(w * before));
        link.g0 += before.tr_mul(&wr);
    }
    if let Some(here) = &here {
        link.h11 += here.tr_mul(&(w * here));
        link.g1 += here.tr_mul(&wr);
    }
    if let (Some(before), Some(here)) = (&before, &here) {
        link.h01 += before.tr_mul(&(w * here));
    }
}
