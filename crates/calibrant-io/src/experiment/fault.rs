//! What is wrong with a value of an experiment file, as serde finds it.

use super::remedies::remedy;
use calibrant_core::error::Refusal;
use calibrant_recording::text::similar_word::{nearest, shorten};
use serde::de::{Error, Expected, Unexpected};
use std::fmt;

/// What is wrong, and with which key. A text of serde is the message and, on a second line, the remedy. In a box: every step of serde returns one.
#[derive(Debug)]
pub(super) struct Fault(pub(super) Box<Wrong>);

/// The content of a [`Fault`].
#[derive(Debug)]
pub(super) struct Wrong {
    pub(super) code: Refusal,
    /// The key at fault, once it is known; before, that of a missing field in its table.
    pub(super) key: String,
    is_placed: bool,
    pub(super) message: String,
    pub(super) help: String,
    /// The keys that are known, where one is not.
    pub(super) known: &'static [&'static str],
}

impl Fault {
    fn new(code: Refusal, message: impl Into<String>, help: impl Into<String>) -> Self {
        let (message, help) = (message.into(), help.into());
        Self(Box::new(Wrong { code, key: String::new(), is_placed: false, message, help, known: &[] }))
    }

    /// A value of another kind than is needed.
    pub(super) fn of_kind(needed: &str, found: Unexpected<'_>, help: &str) -> Self {
        let (found, help) = match found {
            Unexpected::Str(text) if text.trim().parse::<f64>().is_ok() => {
                ("a string", "write it without the quotes")
            }
            Unexpected::Str(_) => ("a string", help),
            Unexpected::Unsigned(_) | Unexpected::Signed(_) => ("a whole number", help),
            Unexpected::Float(_) => ("a number with a decimal point", help),
            Unexpected::Bool(_) => ("true or false", help),
            Unexpected::Seq => ("an array", help),
            Unexpected::Map if needed == "a number" => ("a table: a name with a dot needs quotes", help),
            Unexpected::Map => ("a table", help),
            _ => ("a date", help),
        };
        Self::new(Refusal::ValueInvalid, format!("{needed} is needed here, not {found}"), help)
    }

    /// The same fault, about this key where none is known yet.
    pub(super) fn at(mut self, key: &str) -> Self {
        let wrong = self.0.as_mut();
        if !wrong.is_placed {
            wrong.key = joined(key, &wrong.key);
            wrong.is_placed = true;
            if wrong.help.is_empty() {
                wrong.help = remedy(&wrong.key).into();
            }
        }
        self
    }
}

/// The key of an entry of a table.
pub(super) fn joined(table: &str, key: &str) -> String {
    match (table, key) {
        ("", key) => shorten(key),
        (table, "") => table.to_owned(),
        (table, key) => format!("{table}.{}", shorten(key)),
    }
}

/// These words as answers to a question.
pub(super) fn choice(words: &[&str]) -> String {
    let all: Vec<_> = words.iter().map(|word| format!("\"{word}\"")).collect();
    if all.len() == 1 { format!("write {}", all[0]) } else { format!("one of {}", all.join(", ")) }
}

/// What is said of a word that is none of these: the message and, on a second line, the remedy.
pub(super) fn unknown_word(word: &str, words: &[&str]) -> String {
    let near = nearest(word, words.iter().copied());
    let hint = near.map_or(String::new(), |word| format!("did you mean \"{word}\"? "));
    format!("\"{}\" is not known here\n{hint}{}", shorten(word), choice(words))
}

impl Error for Fault {
    fn custom<T: fmt::Display>(text: T) -> Self {
        let text = text.to_string();
        let (message, help) = text.split_once('\n').unwrap_or((&text, ""));
        Self::new(Refusal::ValueInvalid, message, help)
    }

    fn invalid_type(found: Unexpected<'_>, needed: &dyn Expected) -> Self {
        let text = needed.to_string();
        let (needed, help) = text.split_once('\n').unwrap_or((&text, ""));
        Self::of_kind(needed, found, help)
    }

    fn invalid_value(found: Unexpected<'_>, needed: &dyn Expected) -> Self {
        let text = needed.to_string();
        let help = text.split_once('\n').map_or("", |(_, help)| help);
        let found = match found {
            Unexpected::Signed(number) => number.to_string(),
            Unexpected::Str(text) => shorten(text),
            other => other.to_string(),
        };
        Self::new(Refusal::ValueInvalid, format!("{found} is out of range"), help)
    }

    fn unknown_variant(word: &str, words: &'static [&'static str]) -> Self {
        Self::custom(unknown_word(word, words))
    }

    fn unknown_field(key: &str, known: &'static [&'static str]) -> Self {
        let mut fault = Self::new(Refusal::KeyUnknown, "unknown key", "");
        (fault.0.key, fault.0.known) = (shorten(key), known);
        fault
    }

    fn missing_field(key: &'static str) -> Self {
        let mut fault = Self::new(Refusal::KeyMissing, "this required key is missing", "");
        fault.0.key = key.into();
        fault
    }
}

impl std::error::Error for Fault {}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`: {} ({})", self.0.key, self.0.message, self.0.help)
    }
}
