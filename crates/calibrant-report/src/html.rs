//! The page: escaped text, sections, and one file that needs nothing else.

use super::contents;
use super::figure::{CHART_SCRIPT, renumbered};

/// Text made safe for HTML, also within attributes.
pub(super) fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            c if c.is_control() && c != '\n' && c != '\t' => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

/// What pages call the thesis: `vamvaka2021`.
const THESIS: &str = "“The thesis” is V. Vamvaka, Optimal Experimental Design for Calibration, University of Groningen and Xsens Technologies B.V., 2021 \
                      (vamvaka2021 in references.bib).";

/// How to use the script of the figures.
const HINT: &str = "<p class=\"screen\">Figures: point at a place for its values, drag to zoom along x, double-click to see all again. With the keyboard: Tab, arrows, + and Escape.</p>";

/// A page under construction: its pieces in order.
#[derive(Debug, Default)]
pub(super) struct Page {
    pieces: Vec<Piece>,
}

#[derive(Debug)]
enum Piece {
    Html(String),
    /// A heading of a section, to be numbered.
    Heading(String),
    /// The place of the contents.
    Contents,
}

impl Page {
    /// A page that opens with its title, the verdict, and the contents.
    pub(super) fn opened(title: &str, verdict: String) -> Self {
        let mut page = Self::default();
        page.push(format!("<h1>{}</h1>", escape(title)));
        page.push(verdict);
        page.pieces.push(Piece::Contents);
        page
    }

    /// Appends HTML that is already safe.
    pub(super) fn push(&mut self, html: impl Into<String>) {
        self.pieces.push(Piece::Html(html.into()));
    }

    /// Starts a section: a numbered heading and one sentence on its purpose.
    pub(super) fn section(&mut self, heading: &str, lead: &str) {
        self.pieces.push(Piece::Heading(escape(heading)));
        if !lead.is_empty() {
            self.paragraph(lead);
        }
    }

    /// A paragraph of plain text.
    pub(super) fn paragraph(&mut self, text: &str) {
        self.push(format!("<p>{}</p>", escape(text)));
    }

    /// The whole file. It ends with the inputs: `facts` has the label and the value of each.
    pub(super) fn finish(mut self, title: &str, inputs: &[(String, String)], footer: &[String]) -> String {
        if !inputs.is_empty() {
            self.section("Inputs", "");
            self.push(facts(inputs.iter().map(|(label, value)| (label.as_str(), value.as_str()))));
        }
        let has = |text: &str| {
            self.pieces.iter().any(|piece| matches!(piece, Piece::Html(html) if html.contains(text)))
        };
        let source = has("the thesis").then_some(THESIS).map(str::to_string);
        let footer: String =
            footer.iter().chain(&source).map(|line| format!("<p>{}</p>", escape(line))).collect();
        let head = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"generator\" content=\"calibrant {}\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>{}</title>\n<style>\n{}</style>\n</head>\n<body>\n<main>\n",
            env!("CARGO_PKG_VERSION"),
            escape(title),
            include_str!("style.css"),
        );
        let is_alive = has(" data-x=\"");
        let script = match is_alive {
            true => format!("<script>\n{CHART_SCRIPT}</script>\n"),
            false => String::new(),
        };
        let footer = footer + if is_alive { HINT } else { "" };
        let end = format!("</main>\n<footer>{footer}</footer>\n{script}</body>\n</html>\n");
        let headings: Vec<&str> = (self.pieces.iter())
            .filter_map(
                |piece| if let Piece::Heading(heading) = piece { Some(heading.as_str()) } else { None },
            )
            .collect();
        let entries = contents::entries(&headings);
        let list = contents::list(&entries);
        let mut sections = entries.iter();
        let mut lines = vec![head];
        lines.extend(self.pieces.iter().map(|piece| match piece {
            Piece::Html(html) => format!("{html}\n"),
            Piece::Heading(_) => sections.next().map_or_else(String::new, contents::heading),
            Piece::Contents => list.clone(),
        }));
        lines.push(end);
        renumbered(&lines.concat())
    }
}

/// An unordered list of plain texts; nothing for none.
pub(super) fn list(items: &[String]) -> String {
    if items.is_empty() {
        return String::new();
    }
    let items: String = items.iter().map(|item| format!("<li>{}</li>", escape(item))).collect();
    format!("<ul>{items}</ul>")
}

/// The verdict in a prominent box of this class (`good`, `caution`, `bad`): a word, a sentence, and headed
/// lists that qualify it.
pub(super) fn verdict_box(
    class: &str,
    word: &str,
    sentence: &str,
    remarks: &[(&str, Vec<String>)],
) -> String {
    let lists: String = remarks
        .iter()
        .filter(|(_, items)| !items.is_empty())
        .map(|(heading, items)| format!("<p><strong>{}</strong></p>{}", escape(heading), list(items)))
        .collect();
    format!(
        "<div class=\"verdict {class}\"><p><span class=\"word\">{}</span> {}</p>{lists}</div>",
        escape(word),
        escape(sentence)
    )
}

/// Labels and values in two columns.
pub(super) fn facts<'a>(facts: impl IntoIterator<Item = (&'a str, &'a str)>) -> String {
    let rows: String = facts
        .into_iter()
        .map(|(label, value)| {
            let class = if value.chars().count() > 40 { " class=\"long\"" } else { "" };
            format!("<div{class}><dt>{}</dt><dd>{}</dd></div>", escape(label), escape(value))
        })
        .collect();
    if rows.is_empty() { rows } else { format!("<dl class=\"facts\">{rows}</dl>") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn user_text_cannot_leave_its_place() {
        assert_eq!(escape("a<b>&\"c\"'d'\u{0}"), "a&lt;b&gt;&amp;&quot;c&quot;&#39;d&#39;\u{fffd}");
        let mut page = Page::default();
        page.section("<script>", "1 < 2");
        let html = page.finish("</title><b>", &[], &["x & y".to_string()]);
        assert!(!html.contains("<script") && !html.contains("</title><b>") && html.contains("x &amp; y"));
    }
}
