//! Tables on the console, with aligned columns.

use super::width;
use calibrant::report::{Cell, Table};

/// Rows of cells as a table with aligned columns: the first left, the others right. A table that is wider than the terminal continues below
/// with the columns that are left, beside the first column again.
pub(crate) fn table(header: &[&str], rows: &[Vec<String>]) -> String {
    let mut table = Table::new(header.iter().copied());
    for row in rows {
        let (first, others) =
            row.split_first().map_or((None, &[][..]), |(first, others)| (Some(first), others));
        table.row(
            first
                .cloned()
                .map(Cell::Name)
                .into_iter()
                .chain(others.iter().cloned().map(Cell::Number))
                .collect(),
        );
    }
    table.text(width::get())
}
