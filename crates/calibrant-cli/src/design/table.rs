//! The table of a design on the console.

use crate::console;
use calibrant::design::{AT_BEST, Design, LimitUse, limit_use};
use calibrant::information::Criterion;
use calibrant::report::number_format::{counted, short, significant};

/// Initial and optimal motion and the bound for each parameter, the criterion, the starts, and the statement of the
/// certificate.
pub(crate) fn design(design: &Design) -> String {
    let (before, after) = (design.initial.sd(), design.optimal.sd());
    let bound = design.certificate.as_ref().map(|certificate| &certificate.sd_lower_bound);
    let rows: Vec<_> = design
        .parameters
        .iter()
        .enumerate()
        .map(|(k, parameter)| {
            vec![
                parameter.name.clone(),
                parameter.unit.to_owned(),
                significant(before[k], 4),
                significant(after[k], 4),
                factor(before[k] / after[k]),
                bound.and_then(|bound| bound.get(k)).map_or_else(|| "–".into(), |sd| significant(*sd, 4)),
            ]
        })
        .collect();
    let header = ["parameter", "unit", "sd initial", "sd optimal", "better by", "sd at least"];
    let mut text = criterion(design) + &console::table(&header, &rows) + &starts(design);
    let axes = design.parameters.iter().filter(|parameter| parameter.name.starts_with("bias.")).count();
    let reached = reached(&limit_use(&design.limits, axes, &design.optimal.motion));
    if !reached.is_empty() {
        text.push_str(&format!("  the motion reaches its limits of {reached}\n"));
    }
    text + "\n" + &console::paragraph(&design.statement())
}

fn criterion(design: &Design) -> String {
    let (criterion, digits) = (&design.criterion, 5);
    let above = if design.floor > 0.0 {
        format!(", above {} of the tilt, which no motion changes", significant(design.floor, 4))
    } else {
        String::new()
    };
    format!(
        "criterion {} ({}{}): {} initial, {} optimal{above}\n",
        criterion.letter(),
        criterion.formula(),
        criterion.scaling(),
        significant(design.initial.value - design.floor, digits),
        significant(design.optimal.value - design.floor, digits)
    )
}

fn starts(design: &Design) -> String {
    let all = design.starts.len();
    if all == 0 {
        return String::new();
    }
    let at_best = match &design.criterion {
        _ if !design.optimal.value.is_finite() => String::new(),
        Criterion::D(_) => format!(", {} within {AT_BEST} nats of the best", design.starts_at_best()),
        _ => format!(", {} within {} % of the best", design.starts_at_best(), short(100.0 * AT_BEST)),
    };
    format!(
        "  {}, {} converged{at_best}; {}\n",
        counted(all, "start"),
        design.starts_converged(),
        counted(design.iterations, "iteration")
    )
}

/// The limits that a motion reaches to within a thousandth.
fn reached(uses: &[LimitUse]) -> String {
    let mut names: Vec<&str> = uses
        .iter()
        .filter(|found| found.limit > 0.0 && found.value.abs() >= 0.999 * found.limit)
        .map(|found| found.kind.name())
        .collect();
    names.sort_unstable();
    names.dedup();
    names.join(", ")
}

/// The gap to a bound: in percent, or in nats for criterion D.
pub(crate) fn gap(criterion: &Criterion, gap: f64) -> String {
    let gap = gap.max(0.0);
    match criterion {
        Criterion::D(_) => format!("{} nats", significant(gap, 2)),
        _ => format!("{} %", significant(100.0 * gap, 2)),
    }
}

/// `3.1×`.
pub(crate) fn factor(ratio: f64) -> String {
    if ratio.is_finite() { format!("{}×", significant(ratio, 3)) } else { "–".into() }
}
