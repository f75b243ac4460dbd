//! A sheet as a page.

use super::cell::Cell;
use super::document::Sheet;
use super::section::{Piece, Section};
use super::shown::Shown;
use super::table::Table;
use super::verdict::{Grade, SheetVerdict};
use crate::html::{Page, escape, facts, list, verdict_box};
use rayon::prelude::*;

impl Sheet<'_> {
    /// The sheet as one HTML file.
    ///
    /// The file needs nothing else and fetches nothing. A small script shows values under the pointer and zooms; without it, the page is complete. It
    /// suits a wide screen, a phone and A4 paper. Figures are drawn now, in parallel.
    #[must_use]
    pub fn html(&self) -> String {
        let shown: Vec<&Section<'_>> =
            self.sections.iter().filter(|section| section.shown.on_page()).collect();
        let bodies: Vec<Vec<String>> = shown.par_iter().map(|section| body(section)).collect();
        let verdict = self.verdict.as_ref().map_or_else(String::new, verdict);
        let mut page = Page::opened(&self.title, verdict);
        for (section, body) in shown.into_iter().zip(bodies) {
            if !section.heading.is_empty() {
                page.section(&section.heading, &section.lead);
            }
            body.into_iter().filter(|html| !html.is_empty()).for_each(|html| page.push(html));
        }
        page.finish(&self.title, &self.inputs, &self.footer)
    }
}

/// The pieces of a section.
fn body(section: &Section<'_>) -> Vec<String> {
    let of = |(shown, piece): &(Shown, Piece<'_>)| match shown.on_page() {
        true => html(piece),
        false => String::new(),
    };
    section.pieces.par_iter().map(of).collect()
}

fn html(piece: &Piece<'_>) -> String {
    match piece {
        Piece::Subheading(text) => format!("<h3>{}</h3>", escape(text)),
        Piece::Paragraph(text) => format!("<p>{}</p>", escape(text)),
        Piece::List(items) => list(items),
        Piece::Facts(all) => facts(all.iter().map(|(label, value)| (label.as_str(), value.as_str()))),
        Piece::Tables(tables) => match tables.as_slice() {
            [one] => table(one),
            several => {
                let each: String = several.iter().map(|one| format!("<div>{}</div>", table(one))).collect();
                format!("<div class=\"pair\">{each}</div>")
            }
        },
        Piece::Drawn(draw) => draw(),
        Piece::Folded(summary, pieces) => {
            let within: String = pieces.iter().map(html).collect();
            format!("<details><summary>{}</summary>{within}</details>", escape(summary))
        }
    }
}

fn verdict(verdict: &SheetVerdict) -> String {
    let class = match verdict.grade {
        Grade::Good => "good",
        Grade::Caution => "caution",
        Grade::Bad => "bad",
    };
    let remarks: Vec<(&str, Vec<String>)> =
        verdict.remarks.iter().map(|(heading, items)| (heading.as_str(), items.clone())).collect();
    verdict_box(class, &verdict.word, &verdict.sentence, &remarks)
}

impl Table {
    /// The table alone.
    pub(crate) fn html(&self) -> String {
        table(self)
    }
}

/// A table; it scrolls sideways by itself where the page is too narrow.
fn table(table: &Table) -> String {
    let columns = table.places(Shown::on_page);
    let class = |column: usize| if table.is_numeric(column) { " class=\"n\"" } else { "" };
    let heading = |&column: &usize| {
        format!("<th scope=\"col\"{}>{}</th>", class(column), escape(&table.columns[column].title()))
    };
    let head: String = columns.iter().map(heading).collect();
    let rows = || table.rows.iter().filter(|row| row.shown.on_page());
    let mut body = String::new();
    for row in rows() {
        body.push_str(if row.left_out { "<tr class=\"out\">" } else { "<tr>" });
        let cells = columns.iter().filter_map(|&column| Some((column, row.cells.get(column)?)));
        cells.for_each(|(column, found)| body.push_str(&cell(found, class(column))));
        body.push_str("</tr>\n");
    }
    let explains = rows().flat_map(|row| &row.cells).any(|cell| matches!(cell, Cell::Words(_)));
    // on a phone, the words stand below name and value; a row of several numbers has no room for that
    let numbers = columns.iter().filter(|&&column| table.is_numeric(column)).count();
    let explained = if explains && numbers <= 1 { " class=\"explained\"" } else { "" };
    format!(
        "<div class=\"scroll\"><table{explained}><thead><tr>{head}</tr></thead>\n<tbody>\n{body}</tbody></table></div>"
    )
}

/// A cell, in a column of this class.
fn cell(cell: &Cell, class: &str) -> String {
    let text = escape(&cell.on_page());
    match cell {
        Cell::Name(name) => format!("<th scope=\"row\"{}>{text}</th>", long(name)),
        Cell::Link { text: name, address } => {
            let address = escape(&encoded(address));
            format!("<th scope=\"row\"{}><a href=\"{address}\">{text}</a></th>", long(name))
        }
        Cell::Value { .. } | Cell::Scaled { .. } | Cell::Estimate { .. } | Cell::Number(_) => {
            format!("<td class=\"n\">{text}</td>")
        }
        Cell::Missing => format!("<td{class}>{text}</td>"),
        Cell::Text(_) | Cell::Unit { .. } => format!("<td>{text}</td>"),
        Cell::Words(_) => format!("<td class=\"words\">{text}</td>"),
        Cell::Mark(_) => format!("<td class=\"mark\">{text}</td>"),
        Cell::Flag(_) => format!("<td class=\"flag\">{text}</td>"),
    }
}

/// A name with more letters than this is broken into lines.
const LONG_NAME: usize = 36;

/// The class of a name that would push the other columns off the page.
fn long(name: &str) -> &'static str {
    if name.chars().count() > LONG_NAME { " class=\"long\"" } else { "" }
}

/// A relative path as an address: signs that have a meaning in addresses are encoded.
fn encoded(path: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte);
    let sign = |byte: u8| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    path.bytes().map(sign).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_encoded() {
        assert_eq!(encoded("a b#1?/µ:\"/report.html"), "a%20b%231%3F/%C2%B5%3A%22/report.html");
    }
}
