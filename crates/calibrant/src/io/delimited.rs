//! Lines and fields of delimited text: what separates them, quotes, comments, line ends of every system.

/// One line of a text.
#[derive(Clone, Copy)]
pub(super) struct Line<'t> {
    /// Number, from 1.
    pub(super) number: usize,
    /// The text without its line end.
    pub(super) text: &'t str,
    /// Does a line end follow (so that the line is known to be whole)?
    pub(super) terminated: bool,
}

impl<'t> Line<'t> {
    /// Is there nothing to read: a blank line, or a comment (`#`, `//`, `%`)?
    pub(super) fn is_void(&self) -> bool {
        matches!(self.text.trim_ascii_start().as_bytes(), [] | [b'#' | b'%', ..] | [b'/', b'/', ..])
    }

    /// Column of a byte of the line, in characters from 1.
    pub(super) fn column(&self, byte: usize) -> usize {
        1 + self.text.get(..byte).map_or(byte, |before| before.chars().count())
    }

    /// Its fields, where one character separates them.
    pub(super) fn fields(self, delimiter: Delimiter) -> Fields<'t> {
        Fields { line: self.text, at: 0, delimiter, done: false }
    }
}

/// The lines of a text. Line ends: LF, CR LF, or CR where there is no LF at all.
pub(super) struct Lines<'t> {
    rest: &'t str,
    end: u8,
    number: usize,
}

impl<'t> Lines<'t> {
    pub(super) fn of(text: &'t str) -> Self {
        Self { rest: text, end: if text.contains('\n') { b'\n' } else { b'\r' }, number: 0 }
    }
}

impl<'t> Iterator for Lines<'t> {
    type Item = Line<'t>;

    fn next(&mut self) -> Option<Line<'t>> {
        if self.rest.is_empty() {
            return None;
        }
        self.number += 1;
        let (text, rest, terminated) = match memchr::memchr(self.end, self.rest.as_bytes()) {
            Some(at) => (&self.rest[..at], &self.rest[at + 1..], true),
            None => (self.rest, "", false),
        };
        self.rest = rest;
        Some(Line { number: self.number, text: text.strip_suffix('\r').unwrap_or(text), terminated })
    }
}

/// What separates fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Delimiter {
    /// This character: two in a row have an empty field between them.
    Character(u8),
    /// Any number of spaces and tabs.
    Whitespace,
}

impl Delimiter {
    /// What separates the fields of this line: the first that occurs of `;`, tab and `,`; otherwise white space.
    pub(super) fn of(line: &str) -> Self {
        if line.contains(';') {
            Self::Character(b';')
        } else if line.contains('\t') && !line.starts_with([' ', '\t']) && !line.contains(',') {
            Self::Character(b'\t')
        } else if line.contains(',') {
            Self::Character(b',')
        } else {
            Self::Whitespace
        }
    }
}

/// Was the last line of a text cut off within its last number? It has no line end then, and fewer digits than that number has in any of the lines before: `9.8` below `9.80665`.
pub(super) fn last_number_is_cut(text: &str, delimiter: Delimiter) -> bool {
    /// Lines that are looked at, and how many of them must have a number.
    const LOOKED_AT: usize = 64;
    const NEEDED: usize = 8;
    if text.ends_with(['\n', '\r']) {
        return false;
    }
    let digits = |text: &str| {
        let field = Line { number: 0, text, terminated: true }.fields(delimiter).last()?.1;
        field.parse::<f64>().ok()?;
        Some(field.split_once('.').map_or_else(|| (0, field.len()), |(_, decimals)| (decimals.len(), 0)))
    };
    let mut lines = text.rsplit('\n').map(|line| line.strip_suffix('\r').unwrap_or(line));
    let Some(last) = lines.next().and_then(digits) else { return false };
    let others: Vec<_> = lines.take(LOOKED_AT).filter_map(digits).collect();
    others.len() >= NEEDED && others.iter().all(|other| last < *other)
}

/// The fields of a line: where each begins (byte), and its text without surrounding blanks and quotes.
pub(super) struct Fields<'t> {
    line: &'t str,
    at: usize,
    delimiter: Delimiter,
    done: bool,
}

impl<'t> Iterator for Fields<'t> {
    type Item = (usize, &'t str);

    fn next(&mut self) -> Option<(usize, &'t str)> {
        match self.delimiter {
            Delimiter::Whitespace => self.next_word(),
            Delimiter::Character(_) if self.done => None,
            Delimiter::Character(delimiter) => Some(self.next_field(delimiter)),
        }
    }
}

impl<'t> Fields<'t> {
    fn next_word(&mut self) -> Option<(usize, &'t str)> {
        let bytes = self.line.as_bytes();
        // most bytes are told by the first comparison
        let is_space = |at: usize| bytes[at] <= b' ' && bytes[at].is_ascii_whitespace();
        let mut start = self.at;
        while start < bytes.len() && is_space(start) {
            start += 1;
        }
        if start == bytes.len() {
            return None;
        }
        self.at = start + 1;
        while self.at < bytes.len() && !is_space(self.at) {
            self.at += 1;
        }
        Some((start, unquote(&self.line[start..self.at])))
    }

    fn next_field(&mut self, delimiter: u8) -> (usize, &'t str) {
        let bytes = self.line.as_bytes();
        let mut start = self.at;
        while start < bytes.len() && matches!(bytes[start], b' ' | b'\t') && bytes[start] != delimiter {
            start += 1;
        }
        // a quoted field may hold the delimiter; its closing quote is the first one, as numbers and names hold none
        let closing = match bytes.get(start) {
            Some(b'"') => {
                bytes[start + 1..].iter().position(|&byte| byte == b'"').map_or(0, |length| length + 2)
            }
            _ => 0,
        };
        let search = start + closing;
        let end = bytes[search..].iter().position(|&byte| byte == delimiter).map(|length| search + length);
        let field = &self.line[start..end.unwrap_or(bytes.len())];
        match end {
            Some(end) => self.at = end + 1,
            None => self.done = true,
        }
        (start, unquote(field.trim_ascii_end()))
    }
}

fn unquote(field: &str) -> &str {
    if field.as_bytes().first() != Some(&b'"') {
        return field;
    }
    field.strip_prefix('"').and_then(|field| field.strip_suffix('"')).map_or(field, str::trim_ascii)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fields(text: &str, delimiter: Delimiter) -> Vec<&str> {
        Line { number: 1, text, terminated: true }.fields(delimiter).map(|(_, field)| field).collect()
    }

    #[test]
    fn fields_are_trimmed_unquoted_and_may_be_empty() {
        let comma = Delimiter::Character(b',');
        assert_eq!(fields("1, 2 ,,\"a,b\",", comma), ["1", "2", "", "a,b", ""]);
        assert_eq!(fields("", comma), [""]);
        assert_eq!(fields("\"", comma), ["\""]);
        assert_eq!(fields("  1\t 2  ", Delimiter::Whitespace), ["1", "2"]);
        assert_eq!(fields("1\t\t2", Delimiter::Character(b'\t')), ["1", "", "2"]);
        assert_eq!(fields("", Delimiter::Whitespace), [""; 0]);
    }

    #[test]
    fn a_number_that_lacks_digits_was_cut_off() {
        let comma = Delimiter::Character(b',');
        let is_cut = |other: &str, last: &str| {
            last_number_is_cut(&(format!("1,{other}\n").repeat(9) + "1," + last), comma)
        };
        for (other, last) in [
            ("9.80665", "9.8066"),
            ("9.80665", "9"),
            ("1.25e-03", "1.25e-0"),
            ("32768", "327"),
            ("-0.5", "-0"),
        ] {
            assert!(is_cut(other, last), "{last} below {other}");
            assert!(!is_cut(other, &format!("{last}\n")), "its line is whole");
            assert!(!is_cut(other, other));
        }
        assert!(!is_cut("9.8", "9.80665") && !is_cut("3", "-12") && !is_cut("12", "12"));
        let varying = "1,9.25\n1,9.5\n".repeat(9);
        assert!(!last_number_is_cut(&(varying.clone() + "1,9.0"), comma));
        assert!(last_number_is_cut(&(varying + "1,9"), comma));
        assert!(!last_number_is_cut("1,9.80\n1,9.81\n1,9", comma), "too few to tell");
    }

    #[test]
    fn lines_know_whether_they_are_whole() {
        let of =
            |text| Lines::of(text).map(|line| (line.number, line.text, line.terminated)).collect::<Vec<_>>();
        assert_eq!(of("a\r\nb"), [(1, "a", true), (2, "b", false)]);
        assert_eq!(of("a\rb\r"), [(1, "a", true), (2, "b", true)]);
        assert_eq!(of("\n\n"), [(1, "", true), (2, "", true)]);
        assert!(of("").is_empty());
    }

    #[test]
    fn the_delimiter_is_found_in_the_first_line() {
        assert_eq!(Delimiter::of("0,5;1,5"), Delimiter::Character(b';'));
        assert_eq!(Delimiter::of("a\tb"), Delimiter::Character(b'\t'));
        assert_eq!(Delimiter::of("a, b"), Delimiter::Character(b','));
        assert_eq!(Delimiter::of("  1\t 2"), Delimiter::Whitespace);
    }
}
