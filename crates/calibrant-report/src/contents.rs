//! The contents of a page: its sections, each with an address within the page.

/// Fewer sections need no contents.
const FEWEST: usize = 3;

/// A section.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Entry {
    number: usize,
    /// As HTML.
    heading: String,
    /// Unique on the page.
    address: String,
}

/// The sections of these headings, which are HTML, numbered from 1.
pub(super) fn entries(headings: &[&str]) -> Vec<Entry> {
    let mut entries: Vec<Entry> = Vec::new();
    for (k, heading) in headings.iter().enumerate() {
        let words = address(heading);
        let taken = words.is_empty() || entries.iter().any(|other| other.address == words);
        let address = if taken { format!("{words}-{}", k + 1) } else { words };
        entries.push(Entry { number: k + 1, heading: (*heading).to_string(), address });
    }
    entries
}

/// The letters and digits of a heading, words joined by hyphens.
fn address(heading: &str) -> String {
    let plain = heading.to_lowercase();
    let words = plain.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("-")
}

/// The heading of a section.
pub(super) fn heading(Entry { number, heading, address }: &Entry) -> String {
    format!("<h2 id=\"{address}\"><span class=\"number\">{number}</span> {heading}</h2>\n")
}

/// The contents; nothing for a page of few sections.
pub(super) fn list(entries: &[Entry]) -> String {
    if entries.len() < FEWEST {
        return String::new();
    }
    let item = |Entry { number, heading, address }: &Entry| {
        format!("<li><a href=\"#{address}\"><span class=\"number\">{number}</span> {heading}</a></li>")
    };
    let items: String = entries.iter().map(item).collect();
    format!("<nav class=\"contents\" aria-label=\"Contents\"><ol>{items}</ol></nav>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_unique_and_need_no_encoding() {
        let found = entries(&["Correction, raw → true", "Noise", "Noise", "→"]);
        let addresses: Vec<&str> = found.iter().map(|entry| entry.address.as_str()).collect();
        assert_eq!(addresses, ["correction-raw-true", "noise", "noise-3", "-4"]);
        assert!(
            list(&found).contains("<a href=\"#noise-3\">") && heading(&found[2]).contains("id=\"noise-3\"")
        );
        assert!(list(&found[..2]).is_empty());
    }
}
