//! Tables on the console, with aligned columns.

use super::width;
use std::ops::Range;

/// Between two columns, and before the first.
const GAP: &str = "   ";
const MARGIN: &str = "  ";

/// Rows of cells as a table with aligned columns: the first left, the others right. A table that is wider than the terminal continues below
/// with the columns that are left, beside the first column again.
pub(crate) fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    folded(header, rows, width::of_terminal().unwrap_or(usize::MAX))
}

fn folded(header: &[&str], rows: &[Vec<String>], width: usize) -> String {
    let header: Vec<String> = header.iter().map(|cell| (*cell).to_owned()).collect();
    let of_column = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column)).chain(header.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..header.len()).map(of_column).collect();
    let part = |columns: Range<usize>| part(&header, rows, &widths, columns);
    parts(&widths, width).into_iter().map(part).collect::<Vec<_>>().join("\n")
}

/// The columns of each part, as many as fit. The first column stands in every part, and is not listed.
fn parts(widths: &[usize], width: usize) -> Vec<Range<usize>> {
    let first = MARGIN.len() + widths.first().copied().unwrap_or(0);
    let (mut parts, mut from) = (Vec::new(), 1);
    loop {
        let mut used = first;
        let fits = |column: &usize| {
            used += GAP.len() + widths[*column];
            *column == from || used <= width
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
fn part(header: &[String], rows: &[Vec<String>], widths: &[usize], columns: Range<usize>) -> String {
    let line = |cells: &[String]| {
        let pad = |column: usize, cell: &str| " ".repeat(widths[column].saturating_sub(cell.chars().count()));
        let first = cells.first().map_or("", String::as_str);
        let mut line = format!("{MARGIN}{first}{}", pad(0, first));
        for column in columns.clone() {
            let Some(cell) = cells.get(column) else { continue };
            line.push_str(&format!("{GAP}{}{cell}", pad(column, cell)));
        }
        line.trim_end().to_owned() + "\n"
    };
    let rule = widths.first().copied().unwrap_or(0)
        + columns.clone().map(|column| GAP.len() + widths[column]).sum::<usize>();
    let body: String = rows.iter().map(|row| line(row)).collect();
    format!("{}{MARGIN}{}\n{body}", line(header), "─".repeat(rule))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wide_table_continues_below_beside_its_first_column() {
        let rows = [vec!["x".to_owned(), "1.5".to_owned(), "m/s²".to_owned()]];
        let header = ["axis", "bias", "unit"];
        let whole = "  axis   bias   unit\n  ──────────────────\n  x       1.5   m/s²\n";
        assert_eq!(folded(&header, &rows, 20), whole);
        assert_eq!(
            folded(&header, &rows, 19),
            "  axis   bias\n  ───────────\n  x       1.5\n\n  axis   unit\n  ───────────\n  x      m/s²\n"
        );
        // one column at least, however narrow the terminal
        assert_eq!(folded(&header, &rows, 1).matches("axis").count(), 2);
        assert_eq!(folded(&["alone"], &[vec!["y".into()]], 80), "  alone\n  ─────\n  y\n");
    }
}
