//! A section of a sheet: its pieces in order.

use super::table::{Shown, Table};
use crate::figure::Drawable;
use std::fmt;

/// A piece of a section.
#[derive(Debug)]
pub(super) enum Piece<'a> {
    Subheading(String),
    Paragraph(String),
    /// Sentences, one below the other.
    List(Vec<String>),
    /// Labels, each with its value.
    Facts(Vec<(String, String)>),
    /// Tables: beside each other on a page, where there are several.
    Tables(Vec<Table>),
    /// What only a page can show, as HTML, made when it is printed: a figure, a matrix.
    Drawn(Drawing<'a>),
    /// A figure, drawn when a page is printed or its files are asked for.
    Figure(Plot<'a>),
    /// Pieces that a page shows on demand, under this summary.
    Folded(String, Vec<Piece<'a>>),
}

/// HTML that is made when a page is printed.
pub(super) struct Drawing<'a>(pub(super) Box<dyn Fn() -> String + Send + Sync + 'a>);

/// A figure that is made when it is needed; `None` where there is nothing to draw.
pub(super) struct Plot<'a>(pub(super) Box<dyn Fn() -> Option<Box<dyn Drawable>> + Send + Sync + 'a>);

impl fmt::Debug for Plot<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("Plot")
    }
}

impl fmt::Debug for Drawing<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str("Drawing")
    }
}

/// A section: a heading, a sentence on its purpose, and its pieces.
#[derive(Debug, Default)]
#[must_use]
pub struct Section<'a> {
    pub(super) heading: String,
    /// The heading on terminals, where it is another one.
    pub(super) on_terminal: Option<String>,
    pub(super) lead: String,
    pub(super) pieces: Vec<(Shown, Piece<'a>)>,
    pub(super) shown: Shown,
}

impl<'a> Section<'a> {
    /// A section on pages and terminals. One without a heading stands at the beginning of a sheet.
    pub fn new(heading: impl Into<String>) -> Self {
        Self { heading: heading.into(), ..Self::default() }
    }

    /// A section on pages alone.
    pub fn on_page(heading: impl Into<String>) -> Self {
        Self { shown: Shown::OnPage, ..Self::new(heading) }
    }

    /// A sentence on its purpose, for pages.
    pub fn lead(mut self, lead: impl Into<String>) -> Self {
        self.lead = lead.into();
        self
    }

    /// Its heading on terminals, in place of the one of pages; nothing for none.
    pub fn on_terminal(mut self, heading: impl Into<String>) -> Self {
        self.on_terminal = Some(heading.into());
        self
    }

    /// The section for pages alone.
    pub fn for_page(self) -> Self {
        Self { shown: Shown::OnPage, ..self }
    }

    /// A heading within the section.
    pub fn subheading(&mut self, heading: impl Into<String>) {
        self.push(Shown::Everywhere, Piece::Subheading(heading.into()));
    }

    /// A heading within the section, on pages alone.
    pub fn heading_on_page(&mut self, heading: impl Into<String>) {
        self.push(Shown::OnPage, Piece::Subheading(heading.into()));
    }

    /// A paragraph, or a line of a terminal.
    pub fn paragraph(&mut self, text: impl Into<String>) {
        self.push(Shown::Everywhere, Piece::Paragraph(text.into()));
    }

    /// A paragraph that explains, on pages alone.
    pub fn explanation(&mut self, text: impl Into<String>) {
        self.push(Shown::OnPage, Piece::Paragraph(text.into()));
    }

    /// A line on terminals alone.
    pub fn line(&mut self, text: impl Into<String>) {
        self.push(Shown::OnTerminal, Piece::Paragraph(text.into()));
    }

    /// Sentences, one below the other.
    pub fn list(&mut self, items: Vec<String>) {
        if !items.is_empty() {
            self.push(Shown::Everywhere, Piece::List(items));
        }
    }

    /// Labels with their values.
    pub fn facts(&mut self, facts: Vec<(String, String)>) {
        if !facts.is_empty() {
            self.push(Shown::Everywhere, Piece::Facts(facts));
        }
    }

    /// A table. Below it stand the notes of its columns, once in a section. A table without rows is left out.
    pub fn table(&mut self, table: Table) {
        self.tables(vec![table]);
    }

    /// Tables that stand beside each other on a page.
    pub fn tables(&mut self, tables: Vec<Table>) {
        let tables: Vec<Table> = tables.into_iter().filter(|table| !table.is_empty()).collect();
        let Some(first) = tables.first() else { return };
        let notes: Vec<String> = tables.iter().flat_map(Table::notes).collect();
        let shown = first.shown;
        self.push(shown, Piece::Tables(tables));
        let is_new = |note: &String| {
            let says =
                |piece: &Piece<'_>| matches!(piece, Piece::Paragraph(text) if text.contains(note.as_str()));
            !self.pieces.iter().any(|(_, piece)| says(piece))
        };
        let mut fresh: Vec<String> = notes.into_iter().filter(is_new).collect();
        fresh.dedup();
        if shown.on_page() && !fresh.is_empty() {
            self.explanation(fresh.join(" "));
        }
    }

    /// A figure, or other HTML of pages alone. It is made when a page is printed, all at the same time.
    pub fn drawn(&mut self, html: impl Fn() -> String + Send + Sync + 'a) {
        self.push(Shown::OnPage, Piece::Drawn(Drawing(Box::new(html))));
    }

    /// A figure, drawn when a page is printed; `None` where there is nothing to draw.
    pub(crate) fn figure<D: Drawable + 'static>(
        &mut self,
        figure: impl Fn() -> Option<D> + Send + Sync + 'a,
    ) {
        let boxed = move || figure().map(|drawable| Box::new(drawable) as Box<dyn Drawable>);
        self.push(Shown::OnPage, Piece::Figure(Plot(Box::new(boxed))));
    }

    /// A table of pages alone, under a heading of its own.
    pub fn on_page_below(&mut self, heading: impl Into<String>, table: Table) {
        self.heading_on_page(heading);
        self.table(table.on_page());
    }

    /// What a page shows on demand, under this summary.
    pub fn folded(&mut self, summary: impl Into<String>, within: Section<'a>) {
        let pieces = within.pieces.into_iter().map(|(_, piece)| piece).collect();
        self.push(Shown::OnPage, Piece::Folded(summary.into(), pieces));
    }

    fn push(&mut self, shown: Shown, piece: Piece<'a>) {
        self.pieces.push((shown, piece));
    }
}
