//! Acceptance limits as rows of a table.

use crate::html::Page;
use crate::number_format::{self, UNKNOWN};
use crate::table::{Cell, Table};
use calibrant_core::acceptance::{CheckedLimit, Decision};

/// Header and a row for each limit: the figure, what is accepted, and the decision.
#[must_use]
pub fn limit_rows(limits: &[CheckedLimit]) -> ([&'static str; 5], Vec<[String; 5]>) {
    let row = |limit: &CheckedLimit| {
        let figure = &limit.figure;
        let value = match figure.sd {
            _ if figure.value.is_nan() => UNKNOWN.into(),
            Some(sd) => number_format::with_sd(figure.value, sd),
            None => number_format::significant(figure.value, 4),
        };
        let unknown = || UNKNOWN.to_owned();
        let range = limit.range.map(|(least, most)| {
            format!("{} to {}", number_format::short(least), number_format::short(most))
        });
        [
            figure.name.clone(),
            value,
            range.unwrap_or_else(unknown),
            limit.largest_sd.map_or_else(unknown, number_format::short),
            in_words(limit.decision).into(),
        ]
    };
    (["limit of", "value ± sd", "accepted", "largest sd", "decision"], limits.iter().map(row).collect())
}

fn in_words(decision: Decision) -> &'static str {
    match decision {
        Decision::Pass => "pass",
        Decision::NotChecked => "not checked",
        Decision::TooClose => "too close to say",
        Decision::Fail => "FAIL",
    }
}

/// A section with all limits; none without any.
pub(super) fn limit_section(page: &mut Page, limits: &[CheckedLimit]) {
    if limits.is_empty() {
        return;
    }
    page.section(
        "Limits",
        "What [accept] asks. A value passes if it is inside the limits by 1.645 of its standard deviations, and fails if it is outside by as much (ISO 14253-1, 95 %). Between the two it is too close to say.",
    );
    let (header, rows) = limit_rows(limits);
    let mut table = Table::new("", &header);
    for ([name, value, accepted, sd, decision], limit) in rows.into_iter().zip(limits) {
        let decision = match limit.decision {
            Decision::Pass => Cell::Text(decision),
            _ => Cell::Mark(decision),
        };
        table.row(vec![
            Cell::Name(name),
            Cell::Number(value),
            Cell::Number(accepted),
            Cell::Number(sd),
            decision,
        ]);
    }
    page.push(table.html());
}
