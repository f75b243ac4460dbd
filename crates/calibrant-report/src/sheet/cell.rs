//! A cell of a table: what it holds, and with how many digits a number is shown.

use crate::number_format;

/// One cell of a table.
#[derive(Debug, Clone, PartialEq)]
#[must_use]
pub enum Cell {
    /// The name of the row.
    Name(String),
    /// The name of the row, with the address of its own page.
    Link {
        /// The name.
        text: String,
        /// The page, as a relative path.
        address: String,
    },
    /// A number. Not a number is shown as missing.
    Value {
        /// The number, in the unit of its column.
        value: f64,
        /// Its digits.
        digits: Digits,
    },
    /// A number in SI. Terminals show it so, as the files have it; pages in a unit that leaves few zeros.
    Scaled {
        /// The number.
        value: f64,
        /// Its digits.
        digits: Digits,
        /// Number on pages over number in SI.
        factor: f64,
    },
    /// A unit in SI, and the one of pages.
    Unit {
        /// The symbol on terminals.
        symbol: String,
        /// The symbol on pages; empty for a pure number.
        on_page: String,
    },
    /// A value with its standard deviation, both in the unit of the column. Their digits follow from the standard deviation.
    Estimate {
        /// The value.
        value: f64,
        /// Its standard deviation.
        sd: f64,
    },
    /// Several numbers, or a number with its unit: as it is, aligned as numbers are, and never broken on a page.
    Number(String),
    /// A short text.
    Text(String),
    /// A longer text that explains.
    Words(String),
    /// A short text that should be noticed.
    Mark(String),
    /// One word that should be noticed.
    Flag(String),
    /// Nothing is known.
    Missing,
}

/// How many digits a number has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Digits {
    /// This many significant digits.
    Significant(usize),
    /// This many decimals.
    Fixed(usize),
    /// A sign, and this many decimals.
    Signed(usize),
    /// Two significant digits of this standard deviation, which itself is not shown.
    RoundedTo(f64),
    /// At most six significant digits, no trailing zeros.
    Short,
    /// A fraction in per cent.
    Percent,
    /// Two digits, never 0.
    Probability,
}

impl Digits {
    pub(super) fn text(self, value: f64) -> String {
        match self {
            _ if !value.is_finite() => number_format::UNKNOWN.to_owned(),
            Self::Significant(digits) => number_format::significant(value, digits),
            Self::Fixed(decimals) => number_format::fixed(value, decimals),
            Self::Signed(decimals) => number_format::signed(value, decimals),
            Self::RoundedTo(sd) => number_format::rounded_to(value, sd),
            Self::Short => number_format::short(value),
            Self::Percent => number_format::percent(value),
            Self::Probability => number_format::probability(value),
        }
    }
}

impl Cell {
    /// The name of the row.
    pub fn name(text: impl Into<String>) -> Self {
        Self::Name(text.into())
    }

    /// A short text.
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// The symbol of a unit. None for a number that says what it is.
    pub fn unit(symbol: &str) -> Self {
        if symbol.is_empty() { Self::Missing } else { Self::Text(symbol.to_owned()) }
    }

    /// A number to this many significant digits.
    pub fn significant(value: f64, digits: usize) -> Self {
        Self::Value { value, digits: Digits::Significant(digits) }
    }

    /// A number in SI to this many significant digits, and what pages multiply it by.
    pub fn scaled(value: f64, digits: usize, factor: f64) -> Self {
        Self::Scaled { value, digits: Digits::Significant(digits), factor }
    }

    /// A standard deviation in SI, to four significant digits, and what pages multiply it by. One that is not finite is undetermined.
    pub fn sd(value: f64, factor: f64) -> Self {
        match value.is_finite() {
            true => Self::scaled(value, 4, factor),
            false => Self::Number("undetermined".into()),
        }
    }

    /// A number with this many decimals.
    pub fn fixed(value: f64, decimals: usize) -> Self {
        Self::Value { value, digits: Digits::Fixed(decimals) }
    }

    /// A given number: at most six significant digits, no trailing zeros.
    pub fn short(value: f64) -> Self {
        Self::Value { value, digits: Digits::Short }
    }

    /// A fraction in per cent.
    pub fn percent(fraction: f64) -> Self {
        Self::Value { value: fraction, digits: Digits::Percent }
    }

    /// A probability.
    pub fn probability(p: f64) -> Self {
        Self::Value { value: p, digits: Digits::Probability }
    }

    /// A value with its standard deviation.
    pub fn estimate(value: f64, sd: f64) -> Self {
        Self::Estimate { value, sd }
    }

    /// A whole number.
    pub fn count(n: usize) -> Self {
        Self::Number(number_format::count(n))
    }

    pub(super) fn on_page(&self) -> String {
        match self {
            Self::Scaled { value, digits, factor } => digits.text(value * factor),
            Self::Unit { on_page, .. } if on_page.is_empty() => number_format::UNKNOWN.to_owned(),
            Self::Unit { on_page, .. } => on_page.clone(),
            other => other.in_words(),
        }
    }

    pub(super) fn in_words(&self) -> String {
        match self {
            Self::Scaled { value, digits, .. } => digits.text(*value),
            Self::Unit { symbol, .. } => symbol.clone(),
            Self::Value { value, digits } => digits.text(*value),
            Self::Estimate { value, sd } => number_format::with_sd(*value, *sd),
            Self::Missing => number_format::UNKNOWN.to_owned(),
            Self::Name(text)
            | Self::Link { text, .. }
            | Self::Number(text)
            | Self::Text(text)
            | Self::Words(text)
            | Self::Mark(text)
            | Self::Flag(text) => text.clone(),
        }
    }

    /// Is it aligned as numbers are?
    pub(super) fn is_number(&self) -> bool {
        matches!(self, Self::Value { .. } | Self::Scaled { .. } | Self::Estimate { .. } | Self::Number(_))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_has_the_digits_of_its_rule_and_none_is_a_dash() {
        let says = |cell: Cell| cell.in_words();
        assert_eq!(says(Cell::significant(9.806_65, 4)), "9.807");
        assert_eq!(says(Cell::estimate(1.0, 0.0996)), "1.00 ± 0.10");
        assert_eq!(says(Cell::percent(0.123)), "12 %");
        assert_eq!(says(Cell::Value { value: -0.04, digits: Digits::Signed(1) }), "0.0");
        assert_eq!(says(Cell::Value { value: 1.234_56, digits: Digits::RoundedTo(0.012) }), "1.235");
        assert_eq!(
            [says(Cell::probability(f64::NAN)), says(Cell::Missing), says(Cell::unit(""))],
            ["–", "–", "–"]
        );
    }
}
