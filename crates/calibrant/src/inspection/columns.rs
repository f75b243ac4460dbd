//! The columns of a recording.

use calibrant_io::{ColumnUnit, ImuColumn};
use calibrant_report::number_format::counted;
use calibrant_report::{Cell, Section, Table};

/// Largest number of characters of a column's name in the table.
const LONGEST_NAME: usize = 40;
/// Largest number of unused columns that are shown.
const MOST_COLUMNS: usize = 50;

/// A file with its columns.
pub(super) fn file(heading: String, columns: &[ImuColumn]) -> Section<'static> {
    let mut section = Section::new(heading);
    let mut table = Table::new(["column", "meaning", "unit", "used"]);
    let shown = |(k, column): &(usize, &ImuColumn)| *k < MOST_COLUMNS || column.is_used();
    let shown: Vec<_> = columns.iter().enumerate().filter(shown).collect();
    shown.iter().for_each(|(_, column)| table.row(row(column)));
    section.table(table);
    let more = columns.len() - shown.len();
    if more > 0 {
        section.paragraph(format!("and {} that are not used", counted(more, "more column")));
    }
    section
}

fn row(column: &ImuColumn) -> Vec<Cell> {
    let name = match column.name.char_indices().nth(LONGEST_NAME) {
        Some((end, _)) => format!("{}…", &column.name[..end]),
        None => column.name.clone(),
    };
    vec![
        Cell::Name(name),
        Cell::Text(column.meaning.to_string()),
        Cell::unit(column.unit.map_or("", ColumnUnit::symbol)),
        Cell::Text(column.unused.as_deref().map_or_else(|| "yes".to_owned(), |why| format!("no: {why}"))),
    ]
}
