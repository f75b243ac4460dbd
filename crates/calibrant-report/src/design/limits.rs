//! The table of limits, and their use by a motion.

use crate::number_format::{percent, short, significant};
use crate::sheet::{Cell, Table};
use calibrant_core::motion::{JerkControlledMotion, Limits};
use calibrant_core::sensor::{Axis, Parameter};
use calibrant_design::{LimitKind, LimitUse, limit_use};

/// A limit is active from this share of its use on.
const ACTIVE: f64 = 0.9999;

/// The axes of these parameters of a design.
pub(crate) fn axes(parameters: &[Parameter]) -> &'static [Axis] {
    let biases = parameters.iter().filter(|parameter| parameter.name.starts_with("bias.")).count();
    &Axis::ALL[..biases.min(3)]
}

/// How far a motion of these axes uses the limits.
pub(crate) fn uses(
    limits: &Limits,
    parameters: &[Parameter],
    motion: &JerkControlledMotion,
) -> Vec<LimitUse> {
    limit_use(limits, axes(parameters).len(), motion)
}

/// One row for each limit of each axis, at the time of its largest use.
pub(crate) fn limit_table(uses: &[LimitUse], name: &str) -> Table {
    let reached = format!("largest of the {name}");
    let columns = ["limit", "axis", "unit", "allowed", reached.as_str(), "at time (s)", "used"];
    let mut table = Table::new(columns);
    let mut rows = uses.to_vec();
    rows.sort_by_key(|found| (found.kind, found.axis));
    // axes that do the same share a row
    let mut lines: Vec<(bool, String, [Cell; 6])> = Vec::new();
    for found in rows {
        let (axis, line) = (found.axis.to_string(), line(&found));
        match lines.iter_mut().find(|other| other.2 == line) {
            Some(other) => other.1.push_str(&format!(", {axis}")),
            None => lines.push((found.is_violated(), axis, line)),
        }
    }
    for (is_violated, axes, line) in lines {
        let mut cells = Vec::from(line);
        cells.insert(1, Cell::Text(axes));
        if is_violated { table.row_left_out(cells) } else { table.row(cells) }
    }
    table
}

/// Kind, unit, allowed, largest magnitude, time and use of a limit.
fn line(found: &LimitUse) -> [Cell; 6] {
    let (kind, unit) = (found.kind, found.kind.unit());
    let prescribed =
        matches!(kind, LimitKind::RestAtEnd | LimitKind::StartAcceleration | LimitKind::EndAcceleration);
    let share = (found.value / found.limit).abs();
    let used = match () {
        () if found.is_violated() => {
            Cell::Mark(format!("broken by {} {unit}", significant(found.excess(), 3)))
        }
        () if prescribed => Cell::text("kept"),
        () if share >= ACTIVE => Cell::text("100 %: the limit is active"),
        () => Cell::Text(percent(share)),
    };
    let sign = if prescribed { "" } else { "± " };
    let value = match prescribed {
        true if found.is_violated() => found.value,
        true => found.limit,
        false => found.value.abs(),
    };
    let allowed = Cell::Number(format!("{sign}{}", short(found.limit)));
    let [value, time] = [Cell::significant(value, 4), Cell::fixed(found.time_s, 2)];
    [Cell::name(kind.name()), Cell::text(unit), allowed, value, time, used]
}
