//! The page: escaped text, numbered sections with their contents, and one file that needs nothing else.

/// Shows values, and zooms, in panels that state the ranges of their axes, then saves figures. It reads the drawings and the legends.
pub(super) const CHART_SCRIPT: &str =
    concat!(include_str!("figure/chart.js"), include_str!("figure/save.js"));

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

/// Fewer sections need no contents.
const FEWEST: usize = 3;

/// The whole file: title, verdict, contents and sections, each with its heading and its HTML, and the lines at the foot. Headings are numbered; a section without one has no number.
pub(super) fn page(raw_title: &str, verdict: &str, sections: &[(&str, String)], footer: &[String]) -> String {
    let title = escape(raw_title);
    let opening = format!("<h1>{title}</h1>\n{verdict}\n");
    let has = |text: &str| opening.contains(text) || sections.iter().any(|(_, html)| html.contains(text));
    let is_alive = has(" data-x=\"");
    let source = has("the thesis").then_some(THESIS);
    let footer: String = footer.iter().map(String::as_str).chain(source).map(paragraph).collect();
    let hint = if is_alive { HINT } else { "" };
    let script = match has("<figure") {
        true => format!("<script>\n{CHART_SCRIPT}</script>\n"),
        false => String::new(),
    };
    let headings: Vec<&str> =
        sections.iter().map(|(heading, _)| *heading).filter(|of| !of.is_empty()).collect();
    let entries = entries(&headings);
    let mut numbered = entries.iter();
    let body: String = sections
        .iter()
        .map(|(name, html)| match name.is_empty() {
            true => html.clone(),
            false => numbered.next().map_or_else(String::new, heading) + html,
        })
        .collect();
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"generator\" content=\"calibrant {}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{}@page {{ @bottom-left {{ content: \"{}\"; font: 8pt sans-serif; }} }}\n</style>\n</head>\n<body>\n<main>\n\
         {opening}{}{body}</main>\n<footer>{footer}{hint}</footer>\n{script}</body>\n</html>\n",
        env!("CARGO_PKG_VERSION"),
        include_str!("style.css"),
        in_css(raw_title),
        contents(&entries)
    )
}

/// Text made safe within a string of a style sheet.
fn in_css(text: &str) -> String {
    let safe = |sign: char| match sign {
        '"' | '\\' | '<' | '&' => format!("\\{:x} ", sign as u32),
        sign if sign.is_control() => " ".to_owned(),
        sign => sign.to_string(),
    };
    text.chars().map(safe).collect()
}

/// A section in the contents: its number, its heading as HTML, and its address, which is unique on the page.
type Entry = (usize, String, String);

/// The sections of these headings, numbered from 1.
fn entries(headings: &[&str]) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    for (number, heading) in (1..).zip(headings) {
        let words = address(heading);
        let taken = words.is_empty() || entries.iter().any(|other| other.2 == words);
        entries.push((number, escape(heading), if taken { format!("{words}-{number}") } else { words }));
    }
    entries
}

/// The address of a heading: letters and digits, words joined by hyphens.
pub(super) fn address(heading: &str) -> String {
    let plain = heading.to_lowercase();
    let words = plain.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-")
}

fn heading((number, heading, address): &Entry) -> String {
    format!("<h2 id=\"{address}\"><span class=\"number\">{number}</span> {heading}</h2>\n")
}

/// The contents; nothing for a page of few sections.
fn contents(entries: &[Entry]) -> String {
    if entries.len() < FEWEST {
        return String::new();
    }
    let item = |(number, heading, address): &Entry| {
        format!("<li><a href=\"#{address}\"><span class=\"number\">{number}</span> {heading}</a></li>")
    };
    let items: String = entries.iter().map(item).collect();
    format!("<nav class=\"contents\" aria-label=\"Contents\"><ol>{items}</ol></nav>\n")
}

pub(super) fn paragraph(text: &str) -> String {
    format!("<p>{}</p>", escape(text))
}

/// An unordered list of plain texts; nothing for none.
pub(super) fn list(items: &[String]) -> String {
    if items.is_empty() {
        return String::new();
    }
    let items: String = items.iter().map(|item| format!("<li>{}</li>", escape(item))).collect();
    format!("<ul>{items}</ul>")
}

pub(super) fn facts(facts: &[(String, String)]) -> String {
    let row = |(label, value): &(String, String)| {
        let class = if value.chars().count() > 40 { " class=\"long\"" } else { "" };
        format!("<div{class}><dt>{}</dt><dd>{}</dd></div>", escape(label), escape(value))
    };
    let rows: String = facts.iter().map(row).collect();
    if rows.is_empty() { rows } else { format!("<dl class=\"facts\">{rows}</dl>") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn user_text_cannot_leave_its_place() {
        assert_eq!(escape("a<b>&\"c\"'d'\u{0}"), "a&lt;b&gt;&amp;&quot;c&quot;&#39;d&#39;\u{fffd}");
        let html = page("</title><b>", "", &[("<script>", paragraph("1 < 2"))], &["x & y".to_string()]);
        assert!(!html.contains("<script") && !html.contains("</title><b>") && html.contains("x &amp; y"));
        assert_eq!(in_css("a\"</style>\n\\"), "a\\22 \\3c /style> \\5c ");
    }

    #[test]
    fn addresses_are_unique_and_need_no_encoding() {
        let found = entries(&["Correction, raw → true", "Noise", "Noise", "→"]);
        let addresses: Vec<&str> = found.iter().map(|entry| entry.2.as_str()).collect();
        assert_eq!(addresses, ["correction-raw-true", "noise", "noise-3", "-4"]);
        let list = contents(&found);
        assert!(list.contains("<a href=\"#noise-3\">") && heading(&found[2]).contains("id=\"noise-3\""));
        assert!(contents(&found[..2]).is_empty());
    }
}
