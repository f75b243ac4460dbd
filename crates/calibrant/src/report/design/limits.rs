//! The limits and how far a motion uses them.

use crate::design::{LimitKind, LimitUse};
use crate::report::number;
use crate::report::table::{Cell, Table};

/// A limit used to at least this share holds the motion back.
const ACTIVE: f64 = 0.9999;

/// One row for each limit of each axis, at the time when the motion is worst.
pub(in crate::report) fn limit_table(uses: &[LimitUse], name: &str) -> String {
    let reached = format!("largest of the {name}");
    let columns = ["limit", "axis", "unit", "allowed", reached.as_str(), "at time (s)", "used"];
    let mut table = Table::new("", &columns);
    let mut rows = uses.to_vec();
    rows.sort_by_key(|found| (found.kind, found.axis));
    if rows.is_empty() {
        return "<p>There are no limits.</p>".to_string();
    }
    for found in rows {
        let prescribed = matches!(
            found.kind,
            LimitKind::RestAtEnd | LimitKind::StartAcceleration | LimitKind::EndAcceleration
        );
        let share = (found.value / found.limit).abs();
        let used = match () {
            () if found.is_violated() => {
                format!("broken by {} {}", number::significant(found.excess(), 3), found.kind.unit())
            }
            () if prescribed => "kept".to_string(),
            () if share >= ACTIVE => "100 %: holds the motion back".to_string(),
            () => number::percent(share),
        };
        let allowed = match found.kind {
            _ if prescribed => number::short(found.limit),
            _ => format!("± {}", number::short(found.limit)),
        };
        let value = if prescribed && !found.is_violated() { found.limit } else { found.value };
        let mut cells = vec![
            Cell::Name(found.kind.name().to_string()),
            Cell::Text(found.axis.to_string()),
            Cell::Text(found.kind.unit().to_string()),
            Cell::Number(allowed),
            Cell::Number(number::significant(value, 4)),
            Cell::Number(number::fixed(found.time_s, 2)),
        ];
        if found.is_violated() {
            cells.push(Cell::Mark(used));
            table.row_left_out(cells);
        } else {
            cells.push(Cell::Text(used));
            table.row(cells);
        }
    }
    table.html()
}
