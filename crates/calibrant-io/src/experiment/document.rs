//! The text of an experiment file, and the places in it at which errors point.

use super::fault::{Fault, Wrong};
use super::known_keys::suggest;
use super::toml_value::TomlValue;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_recording::text::excerpt::error_at;
use calibrant_recording::text::similar_word::shorten;
use serde::Deserialize;
use std::ops::Range;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Largest experiment file, bytes.
pub(super) const LARGEST: u64 = 1 << 20;

/// The text of an experiment file, its origin and its values.
pub(super) struct Document<'a> {
    text: &'a str,
    file: Option<&'a Path>,
    root: DeValue<'a>,
    /// The keys that were set beside the text.
    set: Vec<String>,
}

impl<'a> Document<'a> {
    /// Parses a text. `file` serves only for its name in errors.
    pub(super) fn parse(text: &'a str, file: Option<&'a Path>) -> Result<Self> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut document = Self { text, file, root: DeValue::Table(DeTable::new()), set: Vec::new() };
        if text.len() as u64 > LARGEST {
            let (message, help) =
                ("the experiment file is larger than 1 MiB", "this is hardly the file that you mean");
            return Err(document.refuse(0..0, InputError::new(Refusal::FileUnreadable, message, help)));
        }
        let table = DeTable::parse(text).map_err(|error| document.syntax(&error))?;
        document.root = DeValue::Table(table.into_inner());
        Ok(document)
    }

    /// Gives keys other values than the text has; each [`Setting`] is a TOML of its own.
    pub(super) fn set(&mut self, settings: &'a [Setting]) -> Result<()> {
        for Setting(text) in settings {
            let table = DeTable::parse(text).map_err(|error| no_setting(text, error.message()))?;
            let before = self.set.len();
            merge(&mut self.root, table.into_inner(), "", &mut self.set);
            if self.set.len() == before {
                return Err(no_setting(text, "no key"));
            }
        }
        Ok(())
    }

    /// The directory of the file.
    pub(super) fn directory(&self) -> Option<&'a Path> {
        self.file.and_then(Path::parent)
    }

    /// Has the file this key?
    pub(super) fn has(&self, key: &str) -> bool {
        let mut keys = key.split('.');
        keys.try_fold(&self.root, |value, key| value.as_table()?.get(key).map(Spanned::get_ref)).is_some()
    }

    /// Has the top of the file other keys than these?
    pub(super) fn has_others(&self, keys: &[&str]) -> bool {
        self.root
            .as_table()
            .is_some_and(|table| table.keys().any(|key| !keys.contains(&key.get_ref().as_ref())))
    }

    /// The content, as a type that serde reads.
    pub(super) fn read<'d, T: Deserialize<'d>>(&'d self) -> Result<T> {
        T::deserialize(TomlValue { key: String::new(), value: &self.root }).map_err(|fault| self.of(fault))
    }

    fn of(&self, fault: Fault) -> Error {
        let Wrong { code, key, message, mut help, known, .. } = *fault.0;
        if code == Refusal::KeyUnknown {
            let (section, unknown) = key.rsplit_once('.').unwrap_or(("", &key));
            help = suggest(section, unknown, known, |section| self.has(section));
        }
        self.placed(Error::experiment(InputError::new(code, message, help).about_key(key)))
    }

    /// The error at the place of its key: that of its value, or of the section that lacks it.
    pub(super) fn placed(&self, error: Error) -> Error {
        match error {
            Error::Experiment(input_error) if input_error.line.is_none() => {
                let key = input_error.key.as_deref().unwrap_or_default();
                let is_within = |set: &String| {
                    key.strip_prefix(set.as_str())
                        .is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
                };
                if self.set.iter().any(is_within) {
                    return Error::experiment(InputError { file: None, ..*input_error });
                }
                let span = place(&self.root, key, input_error.code == Refusal::KeyUnknown).unwrap_or(0..0);
                self.refuse(span, *input_error)
            }
            other => other,
        }
    }

    fn refuse(&self, span: Range<usize>, input_error: InputError) -> Error {
        let input_error = error_at(self.text, span, input_error);
        Error::experiment(InputError { file: self.file.map(Path::to_path_buf), ..input_error })
    }

    /// An error of the TOML parser.
    fn syntax(&self, error: &toml::de::Error) -> Error {
        let span = error.span().unwrap_or(0..0);
        let message = error.message().replace('\n', " ");
        let input_error = match self.text.get(span.clone()) {
            Some(key) if message == "duplicate key" => InputError::new(
                Refusal::KeyRepeated,
                format!("the key `{}` is there twice", shorten(key)),
                "keep one of them",
            ),
            _ => InputError::new(
                Refusal::SyntaxInvalid,
                format!("not valid TOML: {message}"),
                "see https://toml.io",
            ),
        };
        self.refuse(span, input_error)
    }
}

/// `section.key = value`, as TOML.
pub(super) struct Setting(String);

impl Setting {
    /// Of a text in which words need no quotes.
    pub(super) fn new(text: &str) -> Self {
        let word = text.split_once('=').filter(|(_, value)| !value.contains(['"', '\'', '\n', '\\']));
        Self(match (DeTable::parse(text), word) {
            (Err(_), Some((key, value))) => format!("{key} = \"{}\"", value.trim()),
            _ => text.to_owned(),
        })
    }
}

fn no_setting(text: &str, why: &str) -> Error {
    let message = format!("`{text}` sets no key: {}", why.replace('\n', " "));
    let help = "write section.key=value, with the value as in the file: holds.poses=36";
    Error::experiment(InputError::new(Refusal::SyntaxInvalid, message, help))
}

/// Puts the values of one table, which is in this section, into another; `set` takes their keys.
fn merge<'a>(into: &mut DeValue<'a>, table: DeTable<'a>, section: &str, set: &mut Vec<String>) {
    let DeValue::Table(into) = into else { return };
    for (name, mut value) in table {
        let key = match section {
            "" => name.get_ref().to_string(),
            section => format!("{section}.{}", name.get_ref()),
        };
        let there = into.get_mut(name.get_ref().as_ref()).filter(|there| there.get_ref().is_table());
        match (there, value.get_mut()) {
            (Some(there), DeValue::Table(inner)) => {
                merge(there.get_mut(), std::mem::take(inner), &key, set);
            }
            _ => {
                into.insert(name, value);
                set.push(key);
            }
        }
    }
}

/// The bytes of the value of this key, or of the innermost value around it; of the key itself where it is not
/// known. Names in a key may have dots themselves.
fn place(value: &DeValue<'_>, key: &str, of_key: bool) -> Option<Range<usize>> {
    if let Some(rest) = key.strip_prefix('[') {
        let (place_of, rest) = rest.split_once(']')?;
        let item = value.as_array()?.get(place_of.parse::<usize>().ok()?)?;
        return place(item.get_ref(), rest, of_key).or(Some(item.span()));
    }
    let key = key.strip_prefix('.').unwrap_or(key);
    value.as_table()?.iter().find_map(|(name, entry)| {
        let shown = shorten(name.get_ref());
        let rest = key.strip_prefix(shown.as_str())?;
        match rest.as_bytes().first() {
            None if of_key => Some(name.span()),
            None => Some(entry.span()),
            Some(b'.' | b'[') => place(entry.get_ref(), rest, of_key).or(Some(entry.span())),
            Some(_) => None,
        }
    })
}
