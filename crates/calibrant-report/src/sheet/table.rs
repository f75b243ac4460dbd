//! Tables of typed cells. Columns and rows say where they are shown.

use super::cell::Cell;
use crate::number_format::capitalised;

/// The printers that show a part of a sheet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shown {
    /// On pages and on terminals.
    #[default]
    Everywhere,
    /// On pages only: details, explanations, long tables.
    OnPage,
    /// On terminals only.
    OnTerminal,
}

impl Shown {
    /// Does a page show it?
    pub(super) fn on_page(self) -> bool {
        self != Self::OnTerminal
    }

    /// Does a terminal show it?
    pub(super) fn on_terminal(self) -> bool {
        self != Self::OnPage
    }
}

/// A column: its heading, what it means, and where it is shown.
#[derive(Debug, Clone)]
#[must_use]
pub struct Column {
    heading: String,
    /// The unit of its numbers; empty where they have none or several.
    unit: String,
    note: String,
    pub(super) shown: Shown,
}

impl Column {
    /// A column with this heading.
    pub fn new(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), unit: String::new(), note: String::new(), shown: Shown::Everywhere }
    }

    /// Its numbers are in this unit, which stands in the heading.
    pub fn in_unit(mut self, symbol: &str) -> Self {
        self.unit = symbol.to_owned();
        self
    }

    /// The heading with the unit.
    pub(super) fn title(&self) -> String {
        if self.unit.is_empty() { self.heading.clone() } else { format!("{} ({})", self.heading, self.unit) }
    }

    /// What the column means, for pages: a sentence without its full stop, or several.
    pub fn noted(mut self, note: impl Into<String>) -> Self {
        self.note = note.into();
        self
    }

    /// The column where it is shown there.
    pub fn shown(mut self, shown: Shown) -> Self {
        self.shown = shown;
        self
    }

    /// A column of pages alone.
    pub fn on_page(heading: impl Into<String>) -> Self {
        Self::new(heading).shown(Shown::OnPage)
    }

    /// The note with the name of the column before it; none without a note.
    pub(super) fn explanation(&self) -> Option<String> {
        (!self.note.is_empty()).then(|| format!("{}: {}.", capitalised(&self.heading), self.note))
    }
}

impl<T: Into<String>> From<T> for Column {
    fn from(heading: T) -> Self {
        Self::new(heading)
    }
}

#[derive(Debug, Clone)]
pub(super) struct Row {
    pub(super) cells: Vec<Cell>,
    /// The computation did not use what the row is about.
    pub(super) left_out: bool,
    pub(super) shown: Shown,
}

/// A table: columns, and rows of as many cells.
#[derive(Debug, Clone, Default)]
#[must_use]
pub struct Table {
    pub(super) columns: Vec<Column>,
    pub(super) rows: Vec<Row>,
    /// A list of numbers, each with its name and, on pages, its meaning.
    pub(super) is_list: bool,
    pub(super) shown: Shown,
}

impl Table {
    /// A table of these columns.
    pub fn new(columns: impl IntoIterator<Item = impl Into<Column>>) -> Self {
        Self { columns: columns.into_iter().map(Into::into).collect(), ..Self::default() }
    }

    /// A list of numbers, each with its name and its meaning. Terminals leave out the meaning.
    pub fn explained() -> Self {
        let columns = [Column::new(""), Column::new("value"), Column::on_page("meaning")];
        Self { is_list: true, ..Self::new(columns) }
    }

    /// The table where it is shown there.
    pub fn shown(mut self, shown: Shown) -> Self {
        self.shown = shown;
        self
    }

    /// The table of pages alone.
    pub fn on_page(self) -> Self {
        self.shown(Shown::OnPage)
    }

    /// Appends a number with its meaning.
    pub fn explain(&mut self, name: &str, value: String, meaning: &str) {
        self.row(explained(name, value, meaning));
    }

    /// Appends a number with its meaning, for pages alone.
    pub fn explain_on_page(&mut self, name: &str, value: String, meaning: &str) {
        self.row_shown(Shown::OnPage, explained(name, value, meaning));
    }

    /// Appends a row.
    pub fn row(&mut self, cells: Vec<Cell>) {
        self.row_shown(Shown::Everywhere, cells);
    }

    /// Appends a row where it is shown there.
    pub fn row_shown(&mut self, shown: Shown, cells: Vec<Cell>) {
        self.rows.push(Row { cells, left_out: false, shown });
    }

    /// Appends a row that the computation did not use.
    pub fn row_left_out(&mut self, cells: Vec<Cell>) {
        self.rows.push(Row { cells, left_out: true, shown: Shown::Everywhere });
    }

    /// Appends a row with a last cell that says whether the computation used it, or why not.
    pub fn row_used(&mut self, mut cells: Vec<Cell>, why_not: Option<impl std::fmt::Display>) {
        match why_not {
            None => {
                cells.push(Cell::text("yes"));
                self.row(cells);
            }
            Some(why) => {
                cells.push(Cell::Mark(format!("no: {why}")));
                self.row_left_out(cells);
            }
        }
    }

    /// The notes of the columns, each with its heading.
    pub(crate) fn notes(&self) -> Vec<String> {
        self.columns.iter().filter_map(Column::explanation).collect()
    }

    /// Has it no rows?
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Columns that `wanted` accepts, by place.
    pub(super) fn places(&self, wanted: fn(Shown) -> bool) -> Vec<usize> {
        (0..self.columns.len()).filter(|&k| wanted(self.columns[k].shown)).collect()
    }

    /// Does the column hold numbers?
    pub(super) fn is_numeric(&self, column: usize) -> bool {
        self.rows.iter().any(|row| row.cells.get(column).is_some_and(Cell::is_number))
    }
}

/// The cells of a number with its meaning.
pub(crate) fn explained(name: &str, value: String, meaning: &str) -> Vec<Cell> {
    vec![Cell::name(name), Cell::Number(value), Cell::Words(meaning.to_owned())]
}
