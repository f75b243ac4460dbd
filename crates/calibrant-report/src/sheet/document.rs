//! The sheet itself.

use super::section::Section;
use super::verdict::SheetVerdict;

/// A result for people: title, verdict, sections, and where it comes from.
///
/// # Examples
/// ```
/// use calibrant_report::{Cell, Section, Sheet, Table};
///
/// let mut parameters = Section::new("Parameters");
/// let mut table = Table::new(["parameter", "estimate ± sd", "unit"]);
/// table.row(vec![Cell::name("bias.x"), Cell::estimate(0.083_12, 0.000_21), Cell::unit("m/s²")]);
/// parameters.table(table);
/// let sheet = Sheet { title: "Calibration".into(), sections: vec![parameters], ..Sheet::default() };
/// assert!(sheet.text(80).contains("  bias.x      0.08312 ± 0.00021   m/s²\n"));
/// assert!(sheet.html().contains("<td class=\"n\">0.08312 ± 0.00021</td><td>m/s²</td>"));
/// ```
#[derive(Debug, Default)]
pub struct Sheet<'a> {
    /// The title of the page.
    pub title: String,
    /// What is said first.
    pub verdict: Option<SheetVerdict>,
    /// The sections in their order.
    pub sections: Vec<Section<'a>>,
    /// Label and value of each input, which pages show at the end.
    pub inputs: Vec<(String, String)>,
    /// The lines at the foot of the page.
    pub footer: Vec<String>,
}
