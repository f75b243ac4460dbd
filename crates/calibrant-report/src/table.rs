//! Tables as HTML: a header, rows of cells, numbers to the right.

use super::html::escape;

/// One cell of a table.
#[derive(Debug, Clone)]
pub(super) enum Cell {
    /// The name of the row.
    Name(String),
    /// The name of the row, with the address of its own page.
    Link { text: String, address: String },
    /// A number, or its replacement: right-aligned, never broken.
    Number(String),
    /// A short text.
    Text(String),
    /// A longer text that explains.
    Words(String),
    /// A short text that should be noticed.
    Mark(String),
    /// One word that should be noticed.
    Flag(String),
}

/// A table under construction.
#[derive(Debug, Default)]
pub(super) struct Table {
    caption: String,
    columns: Vec<String>,
    rows: Vec<(bool, Vec<Cell>)>,
}

impl Table {
    /// A table of these columns.
    pub(super) fn new(caption: &str, columns: &[&str]) -> Self {
        let columns = columns.iter().map(ToString::to_string).collect();
        Self { caption: caption.to_string(), columns, rows: Vec::new() }
    }

    /// A table of numbers, each with its meaning.
    pub(super) fn explained() -> Self {
        Self::new("", &["", "value", "meaning"])
    }

    /// Appends a number with its meaning.
    pub(super) fn explain(&mut self, name: &str, value: String, meaning: &str) {
        self.row(vec![Cell::Name(name.to_string()), Cell::Number(value), Cell::Words(meaning.to_string())]);
    }

    /// Appends a row.
    pub(super) fn row(&mut self, cells: Vec<Cell>) {
        self.rows.push((false, cells));
    }

    /// Appends a row that the computation did not use.
    pub(super) fn row_left_out(&mut self, cells: Vec<Cell>) {
        self.rows.push((true, cells));
    }

    /// The table as HTML; it scrolls sideways by itself where the page is too narrow.
    pub(super) fn html(&self) -> String {
        let numeric = |column: usize| {
            self.rows.iter().any(|(_, cells)| matches!(cells.get(column), Some(Cell::Number(_))))
        };
        let head: String = self
            .columns
            .iter()
            .enumerate()
            .map(|(i, name)| {
                let class = if numeric(i) { " class=\"n\"" } else { "" };
                format!("<th scope=\"col\"{class}>{}</th>", escape(name))
            })
            .collect();
        let mut body = String::new();
        for (left_out, cells) in &self.rows {
            body.push_str(if *left_out { "<tr class=\"out\">" } else { "<tr>" });
            for cell in cells {
                body.push_str(&cell.html());
            }
            body.push_str("</tr>\n");
        }
        let caption = match self.caption.as_str() {
            "" => String::new(),
            text => format!("<caption>{}</caption>", escape(text)),
        };
        let explains =
            self.rows.iter().flat_map(|(_, cells)| cells).any(|cell| matches!(cell, Cell::Words(_)));
        // on a phone, the words stand below name and value; a row of several numbers has no room for that
        let numbers = (0..self.columns.len()).filter(|&column| numeric(column)).count();
        let class = if explains && numbers <= 1 { " class=\"explained\"" } else { "" };
        format!(
            "<div class=\"scroll\"><table{class}>{caption}<thead><tr>{head}</tr></thead>\n<tbody>\n{body}</tbody></table></div>"
        )
    }
}

impl Cell {
    fn html(&self) -> String {
        match self {
            Self::Name(text) => format!("<th scope=\"row\"{}>{}</th>", long(text), escape(text)),
            Self::Link { text, address } => {
                let (address, name) = (escape(&encoded(address)), escape(text));
                format!("<th scope=\"row\"{}><a href=\"{address}\">{name}</a></th>", long(text))
            }
            Self::Number(text) => format!("<td class=\"n\">{}</td>", escape(text)),
            Self::Text(text) => format!("<td>{}</td>", escape(text)),
            Self::Words(text) => format!("<td class=\"words\">{}</td>", escape(text)),
            Self::Mark(text) => format!("<td class=\"mark\">{}</td>", escape(text)),
            Self::Flag(text) => format!("<td class=\"flag\">{}</td>", escape(text)),
        }
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
