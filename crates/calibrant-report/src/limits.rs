//! Acceptance limits as a section.

use crate::number_format::short;
use crate::sheet::{Cell, Section, Table};
use calibrant_core::acceptance::{CheckedLimit, Decision};

/// A section with all limits; none without any.
pub(super) fn limit_section<'a>(limits: &[CheckedLimit]) -> Option<Section<'a>> {
    if limits.is_empty() {
        return None;
    }
    let mut section = Section::new("Limits").lead(
        "What [accept] asks. A value passes if it is inside the limits by 1.645 of its standard deviations, and fails if it is outside by as much (ISO 14253-1, 95 %). Between the two it is too close to say.",
    );
    let mut table = Table::new(["limit of", "value ± sd", "accepted", "largest sd", "decision"]);
    limits.iter().for_each(|limit| table.row(row(limit)));
    section.table(table);
    Some(section)
}

fn row(limit: &CheckedLimit) -> Vec<Cell> {
    let figure = &limit.figure;
    let value = match figure.sd {
        Some(sd) if !figure.value.is_nan() => Cell::estimate(figure.value, sd),
        _ => Cell::significant(figure.value, 4),
    };
    let range = limit.range.map(|(least, most)| Cell::Number(format!("{} to {}", short(least), short(most))));
    let decision = in_words(limit.decision).to_owned();
    vec![
        Cell::name(&*figure.name),
        value,
        range.unwrap_or(Cell::Missing),
        limit.largest_sd.map_or(Cell::Missing, Cell::short),
        if limit.decision == Decision::Pass { Cell::Text(decision) } else { Cell::Mark(decision) },
    ]
}

fn in_words(decision: Decision) -> &'static str {
    match decision {
        Decision::Pass => "pass",
        Decision::NotChecked => "not checked",
        Decision::TooClose => "too close to say",
        Decision::Fail => "FAIL",
    }
}
