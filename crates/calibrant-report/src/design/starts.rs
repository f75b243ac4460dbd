//! The table of the starts of the search.

use crate::number_format::{capitalised, count, counted, percent, short, significant};
use crate::sheet::{Cell, Section, Table};
use calibrant_core::information::Criterion;
use calibrant_core::sensor::Axis;
use calibrant_design::{AT_BEST, DesignStatus, StartOutcome};

/// A table with more rows is folded.
const MOST_UNFOLDED: usize = 40;

/// The starts of the same axes, best first.
pub(crate) struct StartGroup<'a> {
    pub(crate) axes: Vec<Axis>,
    pub(crate) sorted: Vec<&'a StartOutcome>,
    criterion: &'a Criterion,
}

impl StartGroup<'_> {
    /// How far a start ended above the best.
    pub(crate) fn excess(&self, start: &StartOutcome) -> f64 {
        self.criterion.gap(start.value, self.sorted[0].value)
    }

    pub(crate) fn reached(&self) -> usize {
        self.sorted.iter().filter(|start| self.excess(start).abs() <= AT_BEST).count()
    }
}

pub(crate) fn groups<'a>(starts: &'a [StartOutcome], criterion: &'a Criterion) -> Vec<StartGroup<'a>> {
    let mut groups: Vec<StartGroup<'a>> = Vec::new();
    for start in starts {
        match groups.iter_mut().find(|group| group.axes == start.axes) {
            Some(group) => group.sorted.push(start),
            None => groups.push(StartGroup { axes: start.axes.clone(), sorted: vec![start], criterion }),
        }
    }
    for group in &mut groups {
        group.sorted.sort_by(|a, b| a.value.total_cmp(&b.value));
    }
    groups
}

/// `axis x`, `axes x, y, z`.
pub(crate) fn name(axes: &[Axis]) -> String {
    let letters: Vec<String> = axes.iter().map(ToString::to_string).collect();
    format!("{} {}", if axes.len() == 1 { "axis" } else { "axes" }, letters.join(", "))
}

/// One sentence for each group: how many starts reached its best value.
pub(crate) fn sentences(starts: &[StartOutcome], criterion: &Criterion) -> Vec<String> {
    let within = match criterion {
        Criterion::D(_) => format!("{} nats", significant(AT_BEST, 1)),
        _ => format!("{} %", short(100.0 * AT_BEST)),
    };
    groups(starts, criterion)
        .iter()
        .map(|group| {
            let all = group.sorted.len();
            format!(
                "{}: {} of {} ended within {within} of the best value.",
                capitalised(&name(&group.axes)),
                group.reached(),
                counted(all, "start")
            )
        })
        .collect()
}

/// All starts, best first.
fn start_table(starts: &[StartOutcome], criterion: &Criterion) -> Table {
    let excess_label =
        if matches!(criterion, Criterion::D(_)) { "above the best (nats)" } else { "above the best" };
    let columns = [
        "rank",
        "axes",
        "start",
        "value where it began",
        "value where it ended",
        excess_label,
        "iterations",
        "ended",
    ];
    let mut table = Table::new(columns);
    for group in groups(starts, criterion) {
        for (rank, start) in group.sorted.iter().enumerate() {
            let excess = group.excess(start);
            let excess = match criterion {
                Criterion::D(_) => significant(excess, 2),
                _ if excess == 0.0 => "0 %".to_string(),
                _ if excess <= AT_BEST => format!("< {} %", short(100.0 * AT_BEST)),
                _ => percent(excess),
            };
            let cells = vec![
                Cell::Name((rank + 1).to_string()),
                Cell::Text(group.axes.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")),
                Cell::Text(if start.number == 0 {
                    "initial motion".into()
                } else {
                    start.number.to_string()
                }),
                Cell::Number(significant(start.initial_value, 5)),
                Cell::Number(significant(start.value, 8)),
                Cell::Number(excess),
                Cell::Number(start.iterations.to_string()),
            ];
            table.row(cells.into_iter().chain([ended(start.status)]).collect());
        }
    }
    table
}

/// Adds the table of the starts; folded where there are many.
pub(crate) fn add_start_table(section: &mut Section<'_>, starts: &[StartOutcome], criterion: &Criterion) {
    let table = start_table(starts, criterion);
    if starts.len() > MOST_UNFOLDED {
        let mut within = Section::default();
        within.table(table);
        section.folded(format!("All {} starts, best first", count(starts.len())), within);
    } else {
        section.table(table);
    }
}

/// The cell of how a search ended.
pub(crate) fn ended(ended: DesignStatus) -> Cell {
    let words = status(ended).to_owned();
    if ended == DesignStatus::Converged { Cell::Text(words) } else { Cell::Mark(words) }
}

/// How a search ended, in words.
pub(crate) fn status(status: DesignStatus) -> &'static str {
    match status {
        DesignStatus::Converged => "converged",
        DesignStatus::IterationLimit => "iteration limit",
        DesignStatus::Stalled => "stalled",
        DesignStatus::Interrupted => "interrupted",
    }
}
