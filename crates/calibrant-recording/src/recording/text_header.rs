//! The lines above the rows of a text: comments, lines of `key: value`, and the header.

use crate::text::decoding::{Checked, refuse};
use crate::text::delimited::{Delimiter, Line, Lines};
use calibrant_core::error::{InputError, Refusal};

/// The beginning of a text, up to its first row.
pub(crate) struct Head<'t> {
    /// Comments and lines of `key: value`.
    pub(crate) preamble: Vec<Line<'t>>,
    /// Line with the names of the columns.
    header: Option<Line<'t>>,
    /// First row, where there is no header or where it is a comment.
    pub(crate) first_row: Option<Line<'t>>,
    pub(crate) delimiter: Delimiter,
    /// The names of the columns; empty where there is no header.
    pub(crate) names: Vec<&'t str>,
    /// Their units, where a row below the names has them.
    pub(crate) units: Vec<&'t str>,
    /// The text after the header, or after the first row.
    pub(crate) rest: Lines<'t>,
}

impl<'t> Head<'t> {
    /// Finds the header.
    pub(crate) fn find(text: &'t str) -> Checked<Self> {
        let mut preamble = Vec::new();
        let mut rest = Lines::of(text);
        // the lines above the header of a DOT export are no comments
        let mut is_dot = false;
        for line in rest.by_ref() {
            let plain = line.text.trim_ascii();
            if plain.is_empty() {
                continue;
            }
            if plain.starts_with('{') {
                return Err(no_json(text).at_line(line.number).into());
            }
            is_dot |= is_separator(plain) || plain.starts_with("DeviceTag");
            let is_euroc =
                plain.strip_prefix('#').is_some_and(|name| name.trim_start().starts_with("timestamp"));
            if (line.is_void() && !is_euroc) || is_separator(plain) || is_key(plain) {
                preamble.push(line);
                continue;
            }
            line.check_ends()?;
            let delimiter = delimiter_of(line.text);
            let names = fields(line, delimiter);
            if is_dot && !is_xsens(&names) && (names.len() < 4 || delimiter == Delimiter::Whitespace) {
                preamble.push(line);
                continue;
            }
            return Ok(match Table::below(line, &rest) {
                Some(table) => Self::of(table, preamble),
                None => Self::at(line, preamble, rest),
            });
        }
        let (code, message) = match preamble.iter().any(|line| !line.is_void()) {
            _ if text.trim().is_empty() => (Refusal::FileEmpty, "the file is empty"),
            true => (Refusal::HeaderMissing, "there is no header with the names of the columns"),
            false => (Refusal::FileEmpty, "the file has only comments"),
        };
        refuse(
            code,
            message,
            "a recording has a header, such as t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps, and a row for each sample",
        )
    }

    /// The head of rows that its reader has found itself.
    pub(crate) fn above_rows(header: Line<'t>, delimiter: Delimiter, rest: Lines<'t>) -> Self {
        Self { header: Some(header), ..Self::without_names(Vec::new(), None, delimiter, rest) }
    }

    fn at(line: Line<'t>, preamble: Vec<Line<'t>>, rest: Lines<'t>) -> Self {
        let delimiter = mixed(line, &rest).unwrap_or_else(|| delimiter_of(line.text));
        let names = fields(line, delimiter);
        if !names.iter().any(is_number) && names.iter().any(|name| !name.is_empty()) {
            return Self {
                header: Some(line),
                names,
                ..Self::without_names(preamble, None, delimiter, rest)
            };
        }
        // the comment above the first row, if it has a name for each column
        let commented = preamble.last().copied().filter(|comment| comment.is_void()).and_then(|comment| {
            let plain = comment.text.trim_ascii().trim_start_matches(['#', '%', '/']).trim_ascii();
            let found = fields(Line { text: plain, ..comment }, delimiter);
            (found.len() == names.len() && names.len() > 3 && !found.iter().any(is_number))
                .then_some((comment, found))
        });
        let head = Self::without_names(preamble, Some(line), delimiter, rest);
        match commented {
            Some((comment, names)) => Self { header: Some(comment), names, ..head },
            None => head,
        }
    }

    /// Of a table below other lines.
    fn of(Table { above, header, units, row, rest }: Table<'t>, mut preamble: Vec<Line<'t>>) -> Self {
        let Some(header) = header else {
            preamble.extend(above);
            return Self::at(row, preamble, rest);
        };
        let delimiter = delimiter_of(row.text);
        preamble.extend(above);
        Self {
            header: Some(header),
            names: fields(header, delimiter),
            units: units.map_or_else(Vec::new, |units| fields(units, delimiter)),
            ..Self::without_names(preamble, Some(row), delimiter, rest)
        }
    }

    fn without_names(
        preamble: Vec<Line<'t>>,
        first_row: Option<Line<'t>>,
        delimiter: Delimiter,
        rest: Lines<'t>,
    ) -> Self {
        Self { preamble, header: None, first_row, delimiter, names: Vec::new(), units: Vec::new(), rest }
    }

    /// Number of the line with the names, or of the first row.
    pub(crate) fn line(&self) -> usize {
        self.header.or(self.first_row).map_or(1, |line| line.number)
    }

    /// Number of columns.
    pub(crate) fn fields(&self) -> usize {
        match self.first_row {
            Some(line) => fields(line, self.delimiter).len(),
            None => self.names.len(),
        }
    }

    /// The names of the columns in lower case.
    pub(crate) fn lower_names(&self) -> Vec<String> {
        self.names.iter().map(|name| name.to_lowercase()).collect()
    }

    /// The value after `key:` in the lines above the header.
    pub(crate) fn value(&self, key: &str) -> Option<&'t str> {
        self.preamble.iter().find_map(|line| {
            let plain = line.text.trim_ascii().trim_start_matches(['/', '#', '%']).trim_ascii();
            let rest = plain.strip_prefix(key)?.trim_ascii_start().strip_prefix(':')?;
            Some(rest.trim_matches([' ', '\t', ',', ';', '"']))
        })
    }

    /// The number, such as `100.0` of `100.0Hz`, after `key:` in the lines above the header.
    pub(crate) fn number(&self, key: &str) -> Option<f64> {
        let value = self.value(key)?;
        let end = value.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(value.len());
        value[..end].parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0)
    }

    /// The one sample rate that comments state, Hz: `data_rate = 100.0 Hz`, `ODR: 104 Hz`, `sample_rate_hz=200`. `None` where they state several.
    pub(crate) fn rate_in_comments(&self) -> Option<f64> {
        const KEYS: [&str; 6] = ["data_rate", "data rate", "sampl", "update rate", "odr", "output rate"];
        let stated = |line: &Line<'_>| {
            let text = line.text.to_lowercase();
            let after = |key: &str| text.split_once(key).map(|(_, rest)| rest.to_owned());
            KEYS.iter().find_map(|key| number_of_hz(&after(key)?))
        };
        let mut rates = self.preamble.iter().filter_map(stated);
        let first = rates.next()?;
        rates.all(|other| other == first).then_some(first)
    }

    /// Is there a line `sep=,` (for Excel)?
    pub(crate) fn has_separator_line(&self) -> bool {
        self.preamble.iter().any(|line| is_separator(line.text.trim_ascii()))
    }
}

/// The rows below a line that is neither their header nor one of them: titles, a banner, or a header with a row of units.
struct Table<'t> {
    /// The lines above, without the header.
    above: Vec<Line<'t>>,
    header: Option<Line<'t>>,
    units: Option<Line<'t>>,
    /// The first row, and what follows it.
    row: Line<'t>,
    rest: Lines<'t>,
}

impl<'t> Table<'t> {
    /// Most lines above a table.
    const MOST: usize = 60;

    /// `None` where the next line continues the first, or no table follows.
    fn below(first: Line<'t>, rest: &Lines<'t>) -> Option<Self> {
        let count = |line: Line<'t>, like: Line<'t>| fields(line, delimiter_of(like.text)).len();
        let next = rest.clone().find(|line| !line.is_void())?;
        let is_as_long = |like| count(next, like).abs_diff(count(first, like)) <= 2;
        let has_numbers = fields(next, delimiter_of(first.text)).iter().any(is_number);
        if is_row(first) || has_numbers && [first, next].into_iter().any(is_as_long) {
            return None;
        }
        let (mut above, mut rest) = (vec![first], rest.clone());
        let row = loop {
            let line = rest.next().filter(|_| above.len() < Self::MOST)?;
            if line.text.trim_ascii().is_empty() {
                continue;
            }
            let following = rest.clone().find(|line| !line.is_void());
            let goes_on = |next: Line<'t>| is_row(next) && count(next, next) == count(line, line);
            if is_row(line) && following.is_none_or(goes_on) {
                break line;
            }
            above.push(line);
        };
        let is_of_words = |line: &Line<'t>| {
            count(*line, row) == count(row, row)
                && !fields(*line, delimiter_of(row.text)).iter().any(is_number)
        };
        let header = above.pop_if(|line| is_of_words(line));
        let (header, units) = match (header, above.pop_if(|line| header.is_some() && is_of_words(line))) {
            (units, Some(header)) => (Some(header), units),
            (header, None) => (header, None),
        };
        // a header of another length is no banner: the rows are wrong
        let is_header = delimiter_of(first.text) != Delimiter::Whitespace && count(first, first) > 2;
        (header.is_some() || !is_header).then_some(Self { above, header, units, row, rest })
    }
}

/// Does it hold numbers: three at least, and half of its fields?
fn is_row(line: Line<'_>) -> bool {
    let fields = fields(line, delimiter_of(line.text));
    let numbers = fields.iter().filter(|field| is_number(field)).count();
    numbers >= 3 && 2 * numbers >= fields.len()
}

/// Fields of a line, without the empty one after a delimiter at its end.
fn fields(line: Line<'_>, delimiter: Delimiter) -> Vec<&str> {
    let mut fields: Vec<&str> = line.fields(delimiter).map(|(_, field)| field).collect();
    if fields.len() > 1 && fields.last().is_some_and(|field| field.is_empty()) {
        fields.pop();
    }
    fields
}

/// The separator of the fields of this line. Where single spaces separate names, two spaces in a row have an
/// empty field between them.
fn delimiter_of(line: &str) -> Delimiter {
    match Delimiter::of(line) {
        Delimiter::Whitespace if line.starts_with("PacketCounter ") && !line.contains("  ") => {
            Delimiter::Character(b' ')
        }
        delimiter => delimiter,
    }
}

/// White space, where tabs and spaces both separate the numbers below this line, or in it.
fn mixed(line: Line<'_>, rest: &Lines<'_>) -> Option<Delimiter> {
    let tab = Delimiter::Character(b'\t');
    if delimiter_of(line.text) != tab {
        return None;
    }
    let words = |line: Line<'_>| fields(line, Delimiter::Whitespace).len();
    let row = rest.clone().find(|line| !line.is_void()).unwrap_or(line);
    let are_numbers = fields(row, Delimiter::Whitespace).iter().all(is_number);
    let is_mixed = [line, row].into_iter().any(|line| fields(line, tab).len() < words(line));
    (are_numbers && is_mixed && words(line) == words(row)).then_some(Delimiter::Whitespace)
}

/// The error for JSON in place of a recording.
fn no_json(text: &str) -> InputError {
    match text.contains("\"parameters\"") || text.contains("\"K_a\"") {
        true => InputError::new(
            Refusal::FormatUnknown,
            "this is JSON, a calibration as it seems, not a recording",
            "`calibrant convert` and `compare` read calibrations, `apply` corrects a recording by one",
        ),
        false => InputError::new(
            Refusal::FormatUnknown,
            "this is JSON, not a recording",
            "a recording is a table: a header such as t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps, and a row for each sample",
        ),
    }
}

/// The number of `… = 100.0 Hz` or of `…_hz: 100`: the first one, if the unit stands beside it.
fn number_of_hz(text: &str) -> Option<f64> {
    let start = text.find(|c: char| c.is_ascii_digit())?;
    let end =
        text[start..].find(|c: char| !c.is_ascii_digit() && c != '.').map_or(text.len(), |at| start + at);
    let has_unit = text[..start].contains("hz") || text[end..].trim_start().starts_with("hz");
    let number: f64 = text[start..end].parse().ok()?;
    (has_unit && number > 0.0).then_some(number)
}

fn is_number(field: &&str) -> bool {
    field.parse::<f64>().is_ok() || field.replacen(',', ".", 1).parse::<f64>().is_ok()
}

/// Is it `sep=,`, the line that states the delimiter for Excel?
fn is_separator(line: &str) -> bool {
    let line = line.trim_matches('"');
    (4..=5).contains(&line.len()) && line.starts_with("sep=")
}

/// `key:` or `key:,value`, as above the header of a DOT export.
fn is_key(line: &str) -> bool {
    let first = line.split([',', ';', '\t']).next().unwrap_or_default().trim_matches([' ', '"']);
    first.ends_with(':') && first.len() > 1
}

fn is_xsens(names: &[&str]) -> bool {
    names.iter().any(|name| ["PacketCounter", "SampleTimeFine", "Acc_X", "Gyr_X"].contains(name))
}
