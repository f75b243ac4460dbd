//! Delimited text: splits it into lines and fields, with quotes, comments and the line ends of every system.

use super::decoding::Checked;
use calibrant_core::error::{InputError, Refusal};

/// One line of a text.
#[derive(Clone, Copy)]
pub struct Line<'t> {
    /// Number, from 1.
    pub number: usize,
    /// The text without its line end.
    pub text: &'t str,
    /// Does a line end follow (so that the line is known to be whole)?
    pub terminated: bool,
}

impl<'t> Line<'t> {
    /// Is there nothing to read: a blank line, or a comment (`#`, `//`, `%`)?
    pub fn is_void(&self) -> bool {
        matches!(self.text.trim_ascii_start().as_bytes(), [] | [b'#' | b'%', ..] | [b'/', b'/', ..])
    }

    /// Are there line ends of another kind in it (CR of an old Mac)? Then it is many lines.
    ///
    /// # Errors
    /// Their number, and the remedy.
    pub fn check_ends(&self) -> Checked<()> {
        let ends = memchr::memchr_iter(b'\r', self.text.trim_ascii_end().as_bytes()).count();
        if ends == 0 {
            return Ok(());
        }
        let are = if ends == 1 { "line end is" } else { "line ends are" };
        let message = format!("{ends} {are} a lone CR, as on an old Mac, others are LF");
        let input_error = InputError::new(
            Refusal::RowMalformed,
            message,
            "end all lines alike: tr '\\r' '\\n' < FILE > OTHER",
        );
        Err(input_error.at_line(self.number).into())
    }

    /// Column of a byte of the line, in characters from 1.
    pub fn column(&self, byte: usize) -> usize {
        1 + self.text.get(..byte).map_or(byte, |before| before.chars().count())
    }

    /// Its fields, where one character separates them.
    pub fn fields(self, delimiter: Delimiter) -> Fields<'t> {
        Fields { line: self.text, at: 0, delimiter, done: false }
    }
}

/// The lines of a text. Line ends: LF, CR LF, or CR where there is no LF before the end of the text.
#[derive(Clone)]
pub struct Lines<'t> {
    rest: &'t str,
    end: u8,
    number: usize,
    /// Does the text end its last line otherwise?
    ends: bool,
}

impl<'t> Lines<'t> {
    pub fn of(text: &'t str) -> Self {
        // an editor may have put a last LF below lines of an old Mac
        let lines = text.trim_end_matches(['\r', '\n']);
        let old = !lines.contains('\n') && (lines.contains('\r') || !text.contains('\n'));
        let (rest, end) = if old { (text.trim_end_matches('\n'), b'\r') } else { (text, b'\n') };
        Self { rest, end, number: 0, ends: rest.len() < text.len() }
    }

    /// Lines that end with LF and follow this number of other lines.
    pub fn after(number: usize, text: &'t str) -> Self {
        Self { rest: text, end: b'\n', number, ends: false }
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
            None => (self.rest, "", self.ends),
        };
        self.rest = rest;
        Some(Line { number: self.number, text: text.strip_suffix('\r').unwrap_or(text), terminated })
    }
}

/// The separator of fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Delimiter {
    /// This character: two in a row have an empty field between them.
    Character(u8),
    /// Any number of spaces and tabs.
    Whitespace,
}

impl Delimiter {
    /// Does this byte separate fields?
    fn is(self, byte: u8) -> bool {
        match self {
            Self::Character(delimiter) => byte == delimiter,
            Self::Whitespace => is_space(byte),
        }
    }

    /// The separator of the fields of this line: the first that occurs of `;`, tab and `,`; otherwise white
    /// space.
    pub fn of(line: &str) -> Self {
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

/// Was the last line of a text cut off within its last number? It has no line end then, and fewer digits than
/// that number has in any of the lines before: `9.8` below `9.80665`.
pub fn last_number_is_cut(text: &str, delimiter: Delimiter) -> bool {
    /// Number of lines that are examined.
    const LOOKED_AT: usize = 64;
    /// Number of these lines that must have a number.
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

/// The fields of a line: the first byte of each, and its text without surrounding blanks and quotes.
pub struct Fields<'t> {
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
    /// The next field, and its number where the field holds nothing else. The end of the field is then that
    /// of the number and need not be sought.
    pub fn next_number(&mut self) -> Option<(usize, &'t str, Option<f64>)> {
        let bytes = self.line.as_bytes();
        let start = self.start();
        let number = if self.done { None } else { fast_float2::parse_partial(&bytes[start..]).ok() };
        if let Some((value, length)) = number {
            let end = start + length;
            let next = bytes.get(end).copied();
            if next.is_none_or(|byte| self.delimiter.is(byte)) {
                self.at = (end + 1).min(bytes.len());
                self.done = next.is_none();
                return Some((start, &self.line[start..end], Some(value)));
            }
        }
        self.next().map(|(start, field)| (start, field, None))
    }

    /// The start of the next field, without blanks.
    fn start(&self) -> usize {
        let bytes = self.line.as_bytes()[self.at..].iter();
        let blanks = match self.delimiter {
            Delimiter::Whitespace => bytes.take_while(|&&byte| is_space(byte)).count(),
            Delimiter::Character(delimiter) => {
                bytes.take_while(|&&byte| matches!(byte, b' ' | b'\t') && byte != delimiter).count()
            }
        };
        self.at + blanks
    }

    fn next_word(&mut self) -> Option<(usize, &'t str)> {
        let bytes = self.line.as_bytes();
        let start = self.start();
        if start == bytes.len() {
            return None;
        }
        let length = bytes[start..].iter().take_while(|&&byte| !is_space(byte)).count();
        self.at = start + length;
        Some((start, unquote(&self.line[start..self.at])))
    }

    fn next_field(&mut self, delimiter: u8) -> (usize, &'t str) {
        let bytes = self.line.as_bytes();
        let start = self.start();
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

/// White space within a line. The first comparison decides for most bytes.
fn is_space(byte: u8) -> bool {
    byte <= b' ' && byte.is_ascii_whitespace()
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
    fn numbers_are_those_of_their_fields() {
        let words = [
            "1",
            "-2.5",
            "+3",
            "3.3108000e+04",
            "1e",
            ".5",
            "5.",
            "",
            "NaN",
            "inf",
            "-nan(ind)",
            "9,8",
            "\"7.5\"",
            "0x1",
            "1_0",
            "--1",
            "1e400",
            "1e-400",
            "4503599627370497.5",
            "9007199254740993",
            "12:30",
            "1 ",
            " 2",
            "é",
        ];
        for delimiter in [
            Delimiter::Whitespace,
            Delimiter::Character(b','),
            Delimiter::Character(b';'),
            Delimiter::Character(b'\t'),
        ] {
            let between = match delimiter {
                Delimiter::Whitespace => "  ".to_owned(),
                Delimiter::Character(byte) => char::from(byte).to_string(),
            };
            for (first, second) in words.iter().flat_map(|first| words.map(|second| (first, second))) {
                let text = &format!(" {first}{between}{second}{between}8");
                let line = Line { number: 1, text, terminated: true };
                let plain: Vec<_> = line.fields(delimiter).collect();
                let mut fields = line.fields(delimiter);
                let numbers: Vec<_> = std::iter::from_fn(|| fields.next_number()).collect();
                assert_eq!(
                    numbers.iter().map(|&(start, field, _)| (start, field)).collect::<Vec<_>>(),
                    plain,
                    "{text:?}"
                );
                for (_, field, number) in numbers {
                    if let Some(number) = number {
                        assert_eq!(field.parse().map(f64::to_bits), Ok(number.to_bits()), "{text:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn numbers_have_the_bits_of_the_standard_library() {
        let mut state = 1_u64;
        for _ in 0..200_000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let value = f64::from_bits(state);
            let decimals = (state >> 60) as usize;
            for text in [
                format!("{value:e}"),
                format!("{:.decimals$}", value.abs().min(1e9)),
                format!("{value:.decimals$e}"),
            ] {
                let line = Line { number: 1, text: &text, terminated: true };
                let (_, field, number) = line.fields(Delimiter::Whitespace).next_number().expect("a field");
                assert_eq!(number.map(f64::to_bits), field.parse().ok().map(f64::to_bits), "{text}");
            }
        }
    }

    #[test]
    fn lines_know_whether_they_are_whole() {
        let of =
            |text| Lines::of(text).map(|line| (line.number, line.text, line.terminated)).collect::<Vec<_>>();
        assert_eq!(of("a\r\nb"), [(1, "a", true), (2, "b", false)]);
        assert_eq!(of("a\rb\r"), [(1, "a", true), (2, "b", true)]);
        assert_eq!(of("\n\n"), [(1, "", true), (2, "", true)]);
        assert_eq!(of("a\r\n"), [(1, "a", true)]);
        for text in ["a\rb\n", "a\rb\r\n", "a\rb\r\n\n"] {
            assert_eq!(of(text), [(1, "a", true), (2, "b", true)], "{text:?}");
        }
        assert_eq!(of("a\rb\nc").len(), 2, "mixed ends are told by the line");
        let ends = |text| Lines::of(text).map(|line| line.check_ends().is_ok()).collect::<Vec<_>>();
        assert_eq!(ends("a\rb\nc"), [false, true]);
        assert_eq!(ends("a\r\r\nc\r\n"), [true, true]);
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
