//! A sheet for a terminal: nothing is wider than it.

mod columns;
mod lines;

pub use lines::{paragraph, wrapped};

use super::document::{Sheet, SheetVerdict};
use super::section::{Piece, Section};
use super::table::{Shown, Table};

impl Sheet<'_> {
    /// The sheet as text whose lines have at most this many characters.
    ///
    /// A table that is too wide continues below, beside its first column again.
    #[must_use]
    pub fn text(&self, width: usize) -> String {
        let verdict = self.verdict.as_ref().and_then(|verdict| opening(verdict, width));
        let shown = self.sections.iter().filter(|section| section.shown.on_terminal());
        let sections = shown.filter_map(|section| text(section, width));
        verdict.into_iter().chain(sections).collect::<Vec<_>>().join("\n")
    }
}

/// The verdict, and the sentence on what was found.
fn opening(verdict: &SheetVerdict, width: usize) -> Option<String> {
    let sign = |c: char| !c.is_alphanumeric();
    let line = verdict.line.as_deref().unwrap_or_else(|| verdict.word.trim_start_matches(sign));
    if line.is_empty() {
        return None;
    }
    let line = wrapped(line, width) + "\n";
    match verdict.sentence.as_str() {
        "" => Some(line),
        sentence => Some(format!("{line}\n{}", paragraph(sentence, width))),
    }
}

/// A section, with its heading; `None` if it says nothing here.
fn text(section: &Section<'_>, width: usize) -> Option<String> {
    let mut body = String::new();
    // tables and headings stand apart, lines below each other
    let mut last_is_line = None;
    for (_, piece) in section.pieces.iter().filter(|(shown, _)| shown.on_terminal()) {
        let Some((is_line, text)) = block(piece, width) else { continue };
        if last_is_line.is_some_and(|last| !(last && is_line)) {
            body.push('\n');
        }
        body.push_str(&text);
        last_is_line = Some(is_line);
    }
    match section.on_terminal.as_ref().unwrap_or(&section.heading).as_str() {
        _ if body.is_empty() => None,
        "" => Some(body),
        heading => Some(format!("{}\n{body}", wrapped(&heading.replace(['\n', '\t'], " "), width))),
    }
}

/// A piece, and whether it is lines that may follow other lines.
fn block(piece: &Piece<'_>, width: usize) -> Option<(bool, String)> {
    match piece {
        Piece::Subheading(text) => Some((false, lines::hanging(text, width))),
        Piece::Paragraph(text) => Some((true, lines::hanging(text, width))),
        Piece::List(items) => Some((true, items.iter().map(|item| lines::hanging(item, width)).collect())),
        Piece::Facts(facts) => Some((true, lines::facts(facts, width))),
        Piece::Tables(tables) => {
            let tables: Vec<String> = tables
                .iter()
                .filter(|table| table.shown.on_terminal())
                .filter_map(|table| columns::table(table, width))
                .collect();
            (!tables.is_empty()).then(|| (false, tables.join("\n")))
        }
        Piece::Drawn(_) | Piece::Figure(_) | Piece::Folded(..) => None,
    }
}

impl Table {
    /// The table alone as text whose lines have at most this many characters. Nothing for one without rows.
    #[must_use]
    pub fn text(&self, width: usize) -> String {
        match self.shown {
            Shown::OnPage => String::new(),
            _ => columns::table(self, width).unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Cell, Grade};
    use super::*;

    fn sheet() -> Sheet<'static> {
        let mut parameters = Section::new("Parameters");
        let mut table = Table::new(["axis", "bias"]);
        table.row(vec![Cell::name("x"), Cell::estimate(1.5, 0.25)]);
        parameters.table(table);
        parameters.line("one line");
        parameters.explanation("For pages alone.");
        parameters.paragraph("another line");
        let mut details = Section::on_page("Details");
        details.paragraph("Long.");
        let verdict = SheetVerdict::new(Grade::Good, "✓ Usable.", "It was calibrated.")
            .with("Remarks", vec!["a remark".into()])
            .on_terminal("verdict: ok");
        Sheet { verdict: Some(verdict), sections: vec![parameters, details], ..Sheet::default() }
    }

    #[test]
    fn the_verdict_stands_first_and_what_is_for_pages_is_left_out() {
        assert_eq!(
            sheet().text(80),
            "verdict: ok\n\n  It was calibrated.\n\nParameters\n  axis          bias\n  ──────────────────\n  x      1.50 ± 0.25\n\n  one line\n  another line\n"
        );
    }

    #[test]
    fn a_page_has_the_remarks_and_the_details_and_no_lines_of_terminals() {
        let html = sheet().html();
        for says in ["✓ Usable.", "a remark", "For pages alone.", "another line", "Details", "Long."] {
            assert!(html.contains(says), "{says}");
        }
        assert!(!html.contains("one line") && !html.contains("verdict: ok"));
    }
}
