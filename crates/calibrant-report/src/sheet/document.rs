//! The sheet itself, and what it says first: can the result be used?

use super::section::Section;

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
    /// Labels and facts below the title, as at the head of a certificate. On paper such a sheet has its first section on a page of its own.
    pub head: Vec<(String, String)>,
    /// What is said first.
    pub verdict: Option<SheetVerdict>,
    /// The sections in their order.
    pub sections: Vec<Section<'a>>,
    /// Label and value of each input, which pages show at the end.
    pub inputs: Vec<(String, String)>,
    /// The lines at the foot of the page.
    pub footer: Vec<String>,
    /// Is it of an experiment of the thesis (`vamvaka2021`)? Only then are its figures named.
    pub of_thesis: bool,
}

/// How good a result is: the colour of its verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Grade {
    /// It can be used.
    Good,
    /// It must be looked at first.
    Caution,
    /// It must not be used.
    Bad,
}

/// The verdict of a sheet.
#[derive(Debug, Clone)]
#[must_use]
pub struct SheetVerdict {
    pub(super) grade: Grade,
    pub(super) word: String,
    pub(super) sentence: String,
    pub(super) remarks: Vec<(String, Vec<String>)>,
    pub(super) line: Option<String>,
}

impl SheetVerdict {
    /// A verdict in a word with its sign (`✓ Usable.`), and a sentence on what was done and found.
    pub fn new(grade: Grade, word: impl Into<String>, sentence: impl Into<String>) -> Self {
        let (word, sentence) = (word.into(), sentence.into());
        Self { grade, word, sentence, remarks: Vec::new(), line: None }
    }

    /// Adds a headed list that qualifies the verdict. Pages show it; a command prints its diagnostics by itself.
    pub fn with(mut self, heading: &str, items: Vec<String>) -> Self {
        if !items.is_empty() {
            self.remarks.push((heading.to_owned(), items));
        }
        self
    }

    /// The line that terminals show in place of the word: `verdict: ok`. An empty one hides the verdict there.
    pub fn on_terminal(mut self, line: impl Into<String>) -> Self {
        self.line = Some(line.into());
        self
    }
}
