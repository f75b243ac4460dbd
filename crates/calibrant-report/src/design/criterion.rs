//! Criteria and distances of their values, in words.

use crate::number_format::{percent, significant};
use calibrant_core::information::Criterion;

/// The name of a criterion with its formula: `criterion A (trace C, in SI units)`.
pub(crate) fn criterion_in_words(criterion: &Criterion) -> String {
    format!("criterion {} ({}{})", criterion.letter(), criterion.formula(), criterion.scaling())
}

/// The same without brackets: `criterion A, trace C, in SI units`.
pub(crate) fn criterion_with_formula(criterion: &Criterion) -> String {
    format!("criterion {}, {}{}", criterion.letter(), criterion.formula(), criterion.scaling())
}

/// The same, with what C is.
pub(crate) fn criterion_explained(criterion: &Criterion) -> String {
    let (letter, formula, scaling) = (criterion.letter(), criterion.formula(), criterion.scaling());
    format!("criterion {letter}, {formula} (C is the covariance of the parameters{scaling})")
}

/// The gap to a bound: in percent, or in nats for criterion D.
#[must_use]
pub fn gap_in_words(criterion: &Criterion, gap: f64) -> String {
    let gap = gap.max(0.0);
    match criterion {
        Criterion::D(_) => format!("{} nats", significant(gap, 2)),
        _ => format!("{} %", significant(100.0 * gap, 2)),
    }
}

/// An excess over a bound. Rounding may put it slightly below zero. A loose bound is a matter of factors.
pub(crate) fn above(excess: f64) -> String {
    match excess {
        _ if excess.abs() < 5e-5 => "< 0.01 %".to_string(),
        _ if excess < 10.0 => percent(excess),
        _ => format!("{} times", significant(excess, 2)),
    }
}

/// The same of a criterion's value: that of D in nats.
pub(crate) fn excess_in_words(criterion: &Criterion, excess: f64) -> String {
    match criterion {
        Criterion::D(_) => format!("{} nats", significant(excess, 2)),
        _ => above(excess),
    }
}
