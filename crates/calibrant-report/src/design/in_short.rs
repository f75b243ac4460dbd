//! A design in a few lines, for terminals.

use super::axes;
use crate::number_format::{counted, short, significant};
use calibrant_core::information::Criterion;
use calibrant_design::{AT_BEST, Design, LimitUse, limit_use};

/// The name of a criterion with its formula: `criterion A (trace C, in SI units)`.
pub(crate) fn criterion_in_words(criterion: &Criterion) -> String {
    format!("criterion {} ({}{})", criterion.letter(), criterion.formula(), criterion.scaling())
}

/// The values of the criterion for both motions.
pub(super) fn values(design: &Design) -> String {
    let above = if design.floor > 0.0 {
        format!(", above {} of the tilt, which no motion changes", significant(design.floor, 4))
    } else {
        String::new()
    };
    format!(
        "{}: {} initial, {} optimal{above}",
        criterion_in_words(&design.criterion),
        significant(design.initial.value - design.floor, 5),
        significant(design.optimal.value - design.floor, 5)
    )
}

/// The value that no motion can beat; `None` without a certificate.
pub(super) fn bound(design: &Design) -> Option<String> {
    let certificate = design.certificate.as_ref()?;
    let least = significant(certificate.lower_bound - design.floor, 4);
    Some(format!(
        "no admissible motion is below {least}, {} less",
        gap_in_words(&design.criterion, certificate.gap)
    ))
}

/// The starts of the search; `None` where none is recorded.
pub(super) fn starts(design: &Design) -> Option<String> {
    let all = design.starts.len();
    let at_best = match &design.criterion {
        _ if !design.optimal.value.is_finite() => String::new(),
        Criterion::D(_) => format!(", {} within {AT_BEST} nats of the best", design.starts_at_best()),
        _ => format!(", {} within {} % of the best", design.starts_at_best(), short(100.0 * AT_BEST)),
    };
    (all > 0).then(|| {
        format!(
            "{}, {} converged{at_best}; {}",
            counted(all, "start"),
            design.starts_converged(),
            counted(design.iterations, "iteration")
        )
    })
}

/// The limits that the optimal motion reaches to within a thousandth.
pub(super) fn reached_limits(design: &Design) -> Option<String> {
    let uses = limit_use(&design.limits, axes(&design.parameters).len(), &design.optimal.motion);
    let is_reached = |found: &&LimitUse| found.limit > 0.0 && found.value.abs() >= 0.999 * found.limit;
    let mut names: Vec<&str> = uses.iter().filter(is_reached).map(|found| found.kind.name()).collect();
    names.sort_unstable();
    names.dedup();
    (!names.is_empty()).then(|| format!("the motion reaches its limits of {}", names.join(", ")))
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
