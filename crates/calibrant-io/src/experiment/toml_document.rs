//! An experiment file as a tree of values that know their place, and errors that point at it.

use super::known_keys;
use super::number_range::Bounds;
use crate::text_excerpt::error_at;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use nalgebra::Vector3;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The text of an experiment file and its origin.
pub(super) struct Document<'a> {
    pub(super) text: &'a str,
    pub(super) file: Option<&'a Path>,
}

impl Document<'_> {
    /// An error about these bytes of the text.
    pub(super) fn reject(
        &self,
        code: Refusal,
        span: Range<usize>,
        message: String,
        help: String,
    ) -> InputError {
        let input_error = error_at(self.text, span, InputError::new(code, message, help));
        InputError { file: self.file.map(Path::to_path_buf), ..input_error }
    }

    /// An error of the TOML parser.
    pub(super) fn syntax(&self, error: &toml::de::Error) -> Error {
        let span = error.span().unwrap_or(0..0);
        let message = error.message().replace('\n', " ");
        let (code, message, help) = match self.text.get(span.clone()) {
            Some(key) if message == "duplicate key" => (
                Refusal::KeyRepeated,
                format!("the key `{}` is there twice", known_keys::shorten(key)),
                "keep one of them",
            ),
            _ => (Refusal::SyntaxInvalid, format!("not valid TOML: {message}"), "see https://toml.io"),
        };
        Error::experiment(self.reject(code, span, message, help.into()))
    }
}

/// A table of the file whose keys are all known.
pub(super) struct Section<'a> {
    document: &'a Document<'a>,
    name: &'static str,
    span: Range<usize>,
    table: &'a DeTable<'a>,
}

impl<'a> Section<'a> {
    /// The whole file.
    pub(super) fn root(document: &'a Document<'a>, table: &'a DeTable<'a>) -> Result<Self> {
        Self::checked(document, "", 0..0, table)
    }

    fn checked(
        document: &'a Document<'a>,
        name: &'static str,
        span: Range<usize>,
        table: &'a DeTable<'a>,
    ) -> Result<Self> {
        let section = Self { document, name, span, table };
        for key in table.keys() {
            if !known_keys::allowed(name).contains(&key.get_ref().as_ref()) {
                let input_error = document.reject(
                    Refusal::KeyUnknown,
                    key.span(),
                    "unknown key".into(),
                    known_keys::suggest(name, key.get_ref()),
                );
                return Err(Error::experiment(input_error.about_key(section.full(key.get_ref()))));
            }
        }
        Ok(section)
    }

    fn full(&self, key: &str) -> String {
        let key = known_keys::shorten(key);
        if self.name.is_empty() { key } else { format!("{}.{key}", self.name) }
    }

    /// The subtable of this name, where there is one. `name` is its full name, as in the list of keys.
    pub(super) fn section(&self, name: &'static str) -> Result<Option<Section<'a>>> {
        let key = name.rsplit('.').next().unwrap_or(name);
        let Some(entry) = self.get(key) else { return Ok(None) };
        let Some(table) = entry.value.get_ref().as_table() else {
            return Err(
                entry.wrong_type("a table", &format!("write [{name}] on a line of its own, its keys below"))
            );
        };
        Section::checked(self.document, name, entry.value.span(), table).map(Some)
    }

    /// The value of a key, where there is one.
    pub(super) fn get(&self, key: &str) -> Option<Entry<'a>> {
        let (_, value) = self.table.iter().find(|(name, _)| name.get_ref() == key)?;
        Some(Entry { document: self.document, key: self.full(key), value })
    }

    /// The value of a key that must be there.
    pub(super) fn need(&self, key: &str, help: &str) -> Result<Entry<'a>> {
        self.get(key).ok_or_else(|| self.missing(key, help))
    }

    /// The error for a key that is missing from this section.
    pub(super) fn missing(&self, key: &str, help: &str) -> Error {
        self.refuse(Refusal::KeyMissing, "this required key is missing", help, key)
    }

    /// An error about this section and one of its keys.
    pub(super) fn reject(&self, message: &str, help: &str, key: &str) -> Error {
        self.refuse(Refusal::ValueInvalid, message, help, key)
    }

    /// The error for a key of this section that is not known.
    pub(super) fn unknown(&self, key: &str, help: &str) -> Error {
        let place = self.table.keys().find(|name| name.get_ref() == key);
        let span = place.map_or(self.span.clone(), |name| name.span());
        let input_error = self.document.reject(Refusal::KeyUnknown, span, "unknown key".into(), help.into());
        Error::experiment(input_error.about_key(self.full(key)))
    }

    fn refuse(&self, code: Refusal, message: &str, help: &str, key: &str) -> Error {
        let key = if key.is_empty() { self.name.to_owned() } else { self.full(key) };
        let input_error = self.document.reject(code, self.span.clone(), message.into(), help.into());
        Error::experiment(if key.is_empty() { input_error } else { input_error.about_key(key) })
    }

    /// The keys that are present, in the order of the alphabet, with their values.
    pub(super) fn entries(&self) -> impl Iterator<Item = (&'a str, Entry<'a>)> + use<'a, '_> {
        self.table.iter().map(|(key, value)| {
            let name: &'a str = key.get_ref();
            (name, Entry { document: self.document, key: self.full(name), value })
        })
    }

    /// A table that is the value of an entry or an item of a list. `name` is its place in the list of keys.
    pub(super) fn item(entry: &Entry<'a>, name: &'static str) -> Result<Self> {
        let Some(table) = entry.value.get_ref().as_table() else {
            return Err(entry.wrong_type("a table", "write { key = value, … }"));
        };
        Self::checked(entry.document, name, entry.value.span(), table)
    }

    /// A table of parameter names: the caller checks only the values of its keys, not their names.
    pub(super) fn open(entry: &Entry<'a>, name: &'static str) -> Result<Self> {
        let Some(table) = entry.value.get_ref().as_table() else {
            return Err(entry.wrong_type("a table", "for example { \"scale.x\" = 1.0 }"));
        };
        Ok(Self { document: entry.document, name, span: entry.value.span(), table })
    }
}

/// A value of the file and its place.
pub(super) struct Entry<'a> {
    document: &'a Document<'a>,
    key: String,
    value: &'a Spanned<DeValue<'a>>,
}

impl<'a> Entry<'a> {
    /// An error about this value.
    pub(super) fn reject(&self, message: impl Into<String>, help: impl Into<String>) -> Error {
        let input_error =
            self.document.reject(Refusal::ValueInvalid, self.value.span(), message.into(), help.into());
        Error::experiment(input_error.about_key(self.key.clone()))
    }

    /// The error for a value of another type than is needed.
    pub(super) fn wrong_type(&self, needed: &str, help: &str) -> Error {
        let found = match self.value.get_ref() {
            DeValue::String(_) => "a string",
            DeValue::Integer(_) => "a whole number",
            DeValue::Float(_) => "a number with a decimal point",
            DeValue::Boolean(_) => "true or false",
            DeValue::Datetime(_) => "a date",
            DeValue::Array(_) => "an array",
            DeValue::Table(_) => "a table",
        };
        let unquote =
            matches!(self.value.get_ref(), DeValue::String(text) if text.trim().parse::<f64>().is_ok());
        let help = if unquote { "write it without the quotes" } else { help };
        self.reject(format!("{needed} is needed here, not {found}"), help)
    }

    /// A finite number within bounds.
    pub(super) fn number(&self, bounds: &Bounds) -> Result<f64> {
        let number = match self.value.get_ref() {
            DeValue::Float(float) => float.as_str().parse::<f64>().ok(),
            DeValue::Integer(whole) => {
                i64::from_str_radix(whole.as_str(), whole.radix()).ok().map(|n| n as f64)
            }
            _ => return Err(self.wrong_type("a number", &bounds.to_string())),
        };
        match number {
            Some(number) if bounds.contain(number) => Ok(number),
            Some(number) if number.is_finite() => {
                Err(self.reject(format!("{number:?} is out of range"), bounds.to_string()))
            }
            _ => Err(self.reject("a finite number is needed here", bounds.to_string())),
        }
    }

    /// A number, or an array with one number for each axis. A single number counts for every axis.
    pub(super) fn per_axis(&self, axes: usize, bounds: &Bounds) -> Result<Vector3<f64>> {
        if !self.is_array() {
            return self.number(bounds).map(Vector3::repeat);
        }
        let items = self.items("")?;
        if items.len() != axes {
            return Err(self.reject(
                format!("{} numbers for {axes} ax{}", items.len(), if axes == 1 { "is" } else { "es" }),
                "give one number for all axes, or one per axis",
            ));
        }
        let mut numbers = Vector3::zeros();
        for (axis, item) in items.iter().enumerate() {
            numbers[axis] = item.number(bounds)?;
        }
        if axes == 1 {
            numbers = Vector3::repeat(numbers[0]);
        }
        Ok(numbers)
    }

    /// A whole number from `least` to `most`.
    pub(super) fn whole(&self, least: u64, most: u64) -> Result<u64> {
        let help = if most > 1 << 62 {
            format!("a whole number from {least}")
        } else {
            format!("a whole number from {least} to {most}")
        };
        let DeValue::Integer(whole) = self.value.get_ref() else {
            return Err(self.wrong_type("a whole number", &help));
        };
        i64::from_str_radix(whole.as_str(), whole.radix())
            .ok()
            .and_then(|number| u64::try_from(number).ok())
            .filter(|number| (least..=most).contains(number))
            .ok_or_else(|| {
                self.reject(format!("{} is out of range", known_keys::shorten(&whole.to_string())), help)
            })
    }

    /// [`whole`](Self::whole), as a size.
    pub(super) fn size(&self, least: u64, most: u64) -> Result<usize> {
        let number = self.whole(least, most)?;
        usize::try_from(number)
            .map_err(|_| self.reject(format!("{number} is out of range"), "give a smaller one"))
    }

    /// One of these words, and its meaning.
    pub(super) fn word<T: Copy>(&self, words: &[(&str, T)]) -> Result<T> {
        let all: Vec<_> = words.iter().map(|(word, _)| format!("\"{word}\"")).collect();
        let help =
            if all.len() == 1 { format!("write {}", all[0]) } else { format!("one of {}", all.join(", ")) };
        let Some(text) = self.value.get_ref().as_str() else {
            return Err(self.wrong_type("a string", &help));
        };
        words.iter().find(|(word, _)| *word == text).map(|&(_, meaning)| meaning).ok_or_else(|| {
            let near = known_keys::nearest(text, words.iter().map(|(word, _)| *word));
            let hint = near.map_or(String::new(), |word| format!("did you mean \"{word}\"? "));
            self.reject(
                format!("\"{}\" is not known here", known_keys::shorten(text)),
                format!("{hint}{help}"),
            )
        })
    }

    /// True or false.
    pub(super) fn flag(&self) -> Result<bool> {
        self.value.get_ref().as_bool().ok_or_else(|| self.wrong_type("true or false", "without quotes"))
    }

    /// The items of an array.
    pub(super) fn items(&self, help: &str) -> Result<Vec<Entry<'a>>> {
        let Some(array) = self.value.get_ref().as_array() else {
            return Err(self.wrong_type("an array", help));
        };
        let item = |(i, value)| Entry { document: self.document, key: format!("{}[{i}]", self.key), value };
        Ok(array.iter().enumerate().map(item).collect())
    }

    /// A path, relative to the directory of the file.
    pub(super) fn path(&self, help: &str) -> Result<PathBuf> {
        let text = self.text().filter(|text| !text.is_empty());
        let text = text.ok_or_else(|| self.wrong_type("a path in quotes", help))?;
        let directory = self.document.file.and_then(Path::parent);
        Ok(directory.map_or_else(|| PathBuf::from(text), |directory| directory.join(text)))
    }

    /// Is the value an array?
    pub(super) fn is_array(&self) -> bool {
        self.value.get_ref().is_array()
    }

    /// Is the value a table?
    pub(super) fn is_table(&self) -> bool {
        self.value.get_ref().is_table()
    }

    /// The text of the value, where it is a string.
    pub(super) fn text(&self) -> Option<&'a str> {
        self.value.get_ref().as_str()
    }
}
