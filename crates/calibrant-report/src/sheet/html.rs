//! A sheet as a page.

use super::cell::Cell;
use super::document::{Grade, Sheet, SheetVerdict};
use super::section::{Piece, Plot, Section};
use super::table::{Shown, Table};
use crate::cited::without_thesis;
use crate::figure::FigureFiles;
use crate::html::{escape, facts, list, page, paragraph};
use calibrant_core::sensor::SensorKind;
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
        let mut sections: Vec<(&str, String)> =
            shown.par_iter().map(|section| (section.heading.as_str(), body(section))).collect();
        if !self.of_thesis {
            sections.iter_mut().for_each(|(_, body)| *body = without_thesis(body));
        }
        sections.retain(|(_, body)| !body.is_empty());
        if !self.inputs.is_empty() {
            sections.push(("Inputs", facts(&self.inputs) + "\n"));
        }
        let verdict = self.verdict.as_ref().map_or_else(String::new, verdict);
        let html = page(&self.title, &(facts(&self.head) + &verdict), &sections, &self.footer);
        if self.head.is_empty() { html } else { html.replacen("<main>", "<main class=\"certificate\">", 1) }
    }
}

impl Sheet<'_> {
    /// The figures of the page as files, in their order.
    #[must_use]
    pub fn figures(&self) -> Vec<FigureFiles> {
        let shown = self.sections.iter().filter(|section| section.shown.on_page());
        let pieces: Vec<&Piece<'_>> =
            shown.flat_map(|section| &section.pieces).map(|(_, piece)| piece).collect();
        pieces.into_par_iter().flat_map(plots).filter_map(|plot| Some((plot.0)()?.files())).collect()
    }
}

/// The figures of a piece.
fn plots<'p, 'a>(piece: &'p Piece<'a>) -> Vec<&'p Plot<'a>> {
    match piece {
        Piece::Figure(plot) => vec![plot],
        Piece::Folded(_, pieces) => pieces.iter().flat_map(plots).collect(),
        _ => Vec::new(),
    }
}

/// The pieces of a section, after the sentence on its purpose.
fn body(section: &Section<'_>) -> String {
    let lead = match section.heading.is_empty() || section.lead.is_empty() {
        true => String::new(),
        false => paragraph(&section.lead) + "\n",
    };
    let shown: Vec<&Piece<'_>> =
        section.pieces.iter().filter(|(shown, _)| shown.on_page()).map(|(_, piece)| piece).collect();
    let pieces: Vec<String> = shown.into_par_iter().map(html).collect();
    pieces.into_iter().filter(|html| !html.is_empty()).fold(lead, |body, html| body + &html + "\n")
}

fn html(piece: &Piece<'_>) -> String {
    match piece {
        Piece::Subheading(text) => format!("<h3>{}</h3>", escape(text)),
        Piece::Paragraph(text) => paragraph(text),
        Piece::List(items) => list(items),
        Piece::Facts(all) => facts(all),
        Piece::Tables(tables) => match tables.as_slice() {
            [one] => one.html(),
            several => {
                let each: String = several.iter().map(|one| format!("<div>{}</div>", one.html())).collect();
                format!("<div class=\"pair\">{each}</div>")
            }
        },
        Piece::Drawn(drawing) => (drawing.0)(),
        Piece::Figure(plot) => (plot.0)().map_or_else(String::new, |figure| figure.html()),
        Piece::Folded(summary, pieces) => {
            let within: String = pieces.iter().map(html).collect();
            format!("<details><summary>{}</summary>{within}</details>", escape(summary))
        }
    }
}

/// The verdict in a prominent box: a word, a sentence, and headed lists that qualify it.
fn verdict(verdict: &SheetVerdict) -> String {
    let class = match verdict.grade {
        Grade::Good => "good",
        Grade::Caution => "caution",
        Grade::Bad => "bad",
    };
    let remark = |(heading, items): &(String, Vec<String>)| {
        format!("<p><strong>{}</strong></p>{}", escape(heading), list(items))
    };
    let lists: String = verdict.remarks.iter().map(remark).collect();
    format!(
        "<div class=\"verdict {class}\"><p><span class=\"word\">{}</span> {}</p>{lists}</div>",
        escape(&verdict.word),
        escape(&verdict.sentence)
    )
}

impl Table {
    /// A table; it scrolls sideways by itself where the page is too narrow.
    pub(crate) fn html(&self) -> String {
        let columns = self.places(Shown::on_page);
        let class = |column: usize| if self.is_numeric(column) { " class=\"n\"" } else { "" };
        let rows = || self.rows.iter().filter(|row| row.shown.on_page());
        let explains = rows().flat_map(|row| &row.cells).any(|cell| matches!(cell, Cell::Words(_)));
        // on a phone, the words stand below name and value; a row of several numbers has no room for that
        let numbers = columns.iter().filter(|&&column| self.is_numeric(column)).count();
        let is_list = explains && numbers <= 1;
        let is_long = is_list && columns.len() > 4;
        let heading = |&column: &usize| {
            format!("<th scope=\"col\"{}>{}</th>", class(column), escape(&self.columns[column].title()))
        };
        let head: String = columns.iter().map(heading).collect();
        let mut body = String::new();
        for row in rows() {
            body.push_str(if row.left_out { "<tr class=\"out\">" } else { "<tr>" });
            let cells = columns.iter().filter_map(|&column| Some((column, row.cells.get(column)?)));
            for (column, found) in cells {
                let html = cell(found, class(column));
                // a phone shows no headings of such a table
                match is_long && self.is_numeric(column) {
                    true => {
                        let heading = escape(&self.columns[column].title());
                        body.push_str(&html.replacen("<td", &format!("<td data-of=\"{heading}\""), 1));
                    }
                    false => body.push_str(&html),
                }
            }
            body.push_str("</tr>\n");
        }
        let explained = match (is_list, is_long) {
            (true, true) => " class=\"explained many\"",
            (true, false) => " class=\"explained\"",
            _ => "",
        };
        format!(
            "<div class=\"scroll\"><table{explained}><thead><tr>{head}</tr></thead>\n<tbody>\n{body}</tbody></table></div>"
        )
    }
}

/// A cell, in a column of this class.
fn cell(cell: &Cell, class: &str) -> String {
    // each line of a text is one on the page
    let text = escape(&cell.on_page()).replace('\n', "<br>");
    match cell {
        Cell::Name(name) => format!("<th scope=\"row\"{}>{}</th>", long(name), breakable(&text)),
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

/// The name of a parameter, which may go on in a second line after that of its sensor.
fn breakable(name: &str) -> String {
    let of_sensor =
        SensorKind::ALL.iter().any(|kind| name.split_once('.').is_some_and(|of| of.0 == kind.name()));
    if of_sensor { name.replacen('.', ".<wbr>", 1) } else { name.to_owned() }
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
