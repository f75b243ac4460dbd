//! Tables with aligned columns: numbers to the right, words to the left.

use super::super::cell::Cell;
use super::super::table::{Shown, Table};
use super::lines::{self, MARGIN};
use std::ops::Range;

/// Between two columns, where there is room for that, and where there is not.
const GAPS: [usize; 2] = [3, 2];
/// A column is not made narrower than this.
const NARROW: usize = 12;

/// A column ready to print: its lines are broken where it is too wide.
struct Printed {
    heading: Vec<String>,
    /// The lines of each row.
    cells: Vec<Vec<String>>,
    width: usize,
    to_the_right: bool,
}

/// The table; `None` where a terminal shows no row. One that is wider than this continues below with the columns that are left, beside the first
/// column again.
pub(super) fn table(table: &Table, width: usize) -> Option<String> {
    let rows: Vec<&[Cell]> =
        table.rows.iter().filter(|row| row.shown.on_terminal()).map(|row| row.cells.as_slice()).collect();
    if rows.is_empty() {
        return None;
    }
    let places = table.places(Shown::on_terminal);
    let (first, others) = places.split_first()?;
    let numeric = |column: usize| !table.is_list && table.is_numeric(column);
    let room = width.saturating_sub(MARGIN.len());
    let heading = |column: usize| table.columns[column].title();
    let most = if others.is_empty() { room } else { room / 2 };
    let mut columns = vec![printed(&heading(*first), &rows, *first, most, false)];
    let left = room.saturating_sub(columns[0].width + GAPS[1]).max(NARROW);
    columns
        .extend(others.iter().map(|&column| printed(&heading(column), &rows, column, left, numeric(column))));
    let widths: Vec<usize> = columns.iter().map(|column| column.width).collect();
    let wide = widths.iter().sum::<usize>() + GAPS[0] * others.len();
    let gap = if wide <= room { GAPS[0] } else { GAPS[1] };
    let part = |others: Range<usize>| part(&columns, others, gap, rows.len(), !table.is_list);
    Some(parts(&widths, gap, room).into_iter().map(part).collect::<Vec<_>>().join("\n"))
}

fn printed(heading: &str, rows: &[&[Cell]], column: usize, most: usize, to_the_right: bool) -> Printed {
    let heading = lines::cell(heading, most);
    let text = |row: &&[Cell]| row.get(column).map_or_else(String::new, Cell::in_words);
    let cells: Vec<Vec<String>> = rows.iter().map(|row| lines::cell(&text(row), most)).collect();
    let all = || heading.iter().chain(cells.iter().flatten());
    let width = all().map(|line| line.chars().count()).max().unwrap_or(0);
    Printed { heading, cells, width, to_the_right }
}

/// The columns of each part, as many as fit. The first column stands in every part, and is not listed.
fn parts(widths: &[usize], gap: usize, room: usize) -> Vec<Range<usize>> {
    let (mut parts, mut from) = (Vec::new(), 1);
    loop {
        let mut used = widths[0];
        let fits = |column: &usize| {
            used += gap + widths[*column];
            *column == from || used <= room
        };
        let end = (from..widths.len()).take_while(fits).last().map_or(from, |last| last + 1);
        parts.push(from..end);
        from = end;
        if from >= widths.len() {
            return parts;
        }
    }
}

/// A part of the table: its first column, and these.
fn part(columns: &[Printed], others: Range<usize>, gap: usize, rows: usize, with_heading: bool) -> String {
    let shown: Vec<&Printed> = columns[..1].iter().chain(&columns[others]).collect();
    let rule: usize = shown.iter().map(|column| column.width).sum::<usize>() + gap * (shown.len() - 1);
    let mut text = String::new();
    if with_heading {
        text += &row(&shown, gap, |column| &column.heading);
        text += &format!("{MARGIN}{}\n", "─".repeat(rule));
    }
    (0..rows).for_each(|k| text += &row(&shown, gap, |column| &column.cells[k]));
    text
}

/// A row, with as many lines as its highest cell.
fn row<'a>(columns: &[&'a Printed], gap: usize, cell: impl Fn(&'a Printed) -> &'a Vec<String>) -> String {
    let height = columns.iter().map(|column| cell(column).len()).max().unwrap_or(0);
    let line = |k: usize| {
        let padded = |column: &&'a Printed| {
            let text = cell(column).get(k).map_or("", String::as_str);
            let pad = " ".repeat(column.width.saturating_sub(text.chars().count()));
            if column.to_the_right { pad + text } else { text.to_owned() + &pad }
        };
        let cells: Vec<String> = columns.iter().map(padded).collect();
        format!("{MARGIN}{}", cells.join(&" ".repeat(gap))).trim_end().to_owned() + "\n"
    };
    (0..height).map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn biases() -> Table {
        let mut table = Table::new(["axis", "bias", "unit"]);
        table.row(vec![Cell::name("x"), Cell::fixed(1.5, 1), Cell::unit("m/s²")]);
        table
    }

    #[test]
    fn a_wide_table_continues_below_beside_its_first_column() {
        assert_eq!(biases().text(20), "  axis   bias   unit\n  ──────────────────\n  x       1.5   m/s²\n");
        assert_eq!(
            biases().text(17),
            "  axis  bias\n  ──────────\n  x      1.5\n\n  axis  unit\n  ──────────\n  x     m/s²\n"
        );
        // closer together before that
        assert_eq!(biases().text(18), "  axis  bias  unit\n  ────────────────\n  x      1.5  m/s²\n");
        // one column at least, however narrow the terminal
        assert_eq!(biases().text(1).matches("bias").count(), 1);
        let mut alone = Table::new(["alone"]);
        alone.row(vec![Cell::name("y")]);
        assert_eq!(alone.text(80), "  alone\n  ─────\n  y\n");
    }

    #[test]
    fn a_cell_that_is_too_wide_has_several_lines() {
        let mut table = Table::new(["name", "why"]);
        table.row(vec![Cell::name("a"), Cell::text("as many words as there are")]);
        table.row(vec![Cell::name("b"), Cell::Missing]);
        assert_eq!(
            table.text(25),
            "  name   why\n  ───────────────────────\n  a      as many words as\n         there are\n  b      –\n"
        );
        assert!(table.text(25).lines().all(|line| line.chars().count() <= 25));
    }

    #[test]
    fn a_list_has_no_header_and_no_meanings() {
        let mut table = Table::explained();
        table.explain("gravity", "9.81 m/s²".into(), "Assumed.");
        table.explain_on_page("gradient", "0.1".into(), "Small.");
        table.explain("holds used", "9 of 9".into(), "All.");
        assert_eq!(table.text(80), "  gravity      9.81 m/s²\n  holds used   9 of 9\n");
    }
}
