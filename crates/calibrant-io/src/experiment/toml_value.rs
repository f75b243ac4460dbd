//! The values of a TOML text as a source for serde, whose errors name the key at fault.

use super::fault::{Fault, choice, joined};
use super::remedies::remedy;
use serde::de::value::BorrowedStrDeserializer;
use serde::de::{
    DeserializeSeed, Deserializer, Error, Expected, IntoDeserializer, MapAccess, SeqAccess, Unexpected,
    Visitor, value::StrDeserializer,
};
use std::vec::IntoIter;
use toml::Spanned;
use toml::de::{DeInteger, DeString, DeTable, DeValue};

/// A value and its key.
pub(super) struct TomlValue<'a, 't> {
    pub(super) key: String,
    pub(super) value: &'a DeValue<'t>,
}

impl<'de> TomlValue<'de, '_> {
    /// Reads it; what its type refuses is about its key.
    fn read<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Fault> {
        let key = self.key.clone();
        seed.deserialize(self).map_err(|fault| fault.at(&key))
    }

    fn of_kind(&self, needed: &str, help: &str) -> Fault {
        let found = match self.value {
            DeValue::String(text) => Unexpected::Str(text),
            DeValue::Integer(_) => Unexpected::Signed(0),
            DeValue::Float(_) => Unexpected::Float(0.0),
            DeValue::Boolean(truth) => Unexpected::Bool(*truth),
            DeValue::Datetime(_) => Unexpected::Other("date"),
            DeValue::Array(_) => Unexpected::Seq,
            DeValue::Table(_) => Unexpected::Map,
        };
        Fault::of_kind(needed, found, help).at(&self.key)
    }

    /// Refuses what is no table, and a table that has other keys.
    fn needs_keys(&self, known: &'static [&'static str]) -> Result<(), Fault> {
        let Some(table) = self.value.as_table() else {
            let line = format!("write [{}] on a line of its own, its keys below", self.key);
            let example = remedy(&self.key);
            return Err(self.of_kind("a table", if example.is_empty() { &line } else { example }));
        };
        // a misspelt key first: what it leaves out follows from it
        let unknown = table.keys().filter(|key| !known.contains(&key.get_ref().as_ref()));
        match unknown.min_by_key(|key| key.span().start) {
            Some(key) => Err(Fault::unknown_field(key.get_ref(), known).at(&self.key)),
            None => Ok(()),
        }
    }

    fn needs(&self, is_it: bool, needed: &str, help: &str) -> Result<(), Fault> {
        if is_it { Ok(()) } else { Err(self.of_kind(needed, help)) }
    }
}

impl<'de> Deserializer<'de> for TomlValue<'de, '_> {
    type Error = Fault;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        let key = self.key.clone();
        let read = match self.value {
            DeValue::String(text) => visitor.visit_str(text),
            DeValue::Integer(whole) => match as_i64(whole, &visitor) {
                Ok(number) => visitor.visit_i64(number),
                Err(fault) => Err(fault),
            },
            DeValue::Float(number) => visitor.visit_f64(number.as_str().parse().unwrap_or(f64::NAN)),
            DeValue::Boolean(truth) => visitor.visit_bool(*truth),
            DeValue::Datetime(_) => Err(Fault::invalid_type(Unexpected::Other("date"), &visitor)),
            DeValue::Array(items) => visitor.visit_seq(Items { key: self.key, place: 0, items }),
            DeValue::Table(table) => visitor.visit_map(Entries::of(table, self.key)),
        };
        read.map_err(|fault| fault.at(&key))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        known: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Fault> {
        self.needs_keys(known)?;
        self.deserialize_any(visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        self.needs(self.value.is_table(), "a table", "")?;
        self.deserialize_any(visitor)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        self.needs(self.value.is_array(), "an array", "")?;
        self.deserialize_any(visitor)
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        self.needs(self.value.is_bool(), "true or false", "without quotes")?;
        self.deserialize_any(visitor)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        self.needs(self.value.is_str(), "a string", "")?;
        self.deserialize_any(visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        words: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Fault> {
        match self.value.as_str() {
            Some(word) => {
                let word: StrDeserializer<'_, Fault> = word.into_deserializer();
                visitor.visit_enum(word).map_err(|fault| fault.at(&self.key))
            }
            None => Err(self.of_kind("a string", &choice(words))),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Fault> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Fault> {
        visitor.visit_newtype_struct(self)
    }

    serde::forward_to_deserialize_any! {
        i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str bytes byte_buf unit unit_struct tuple
        tuple_struct identifier ignored_any
    }
}

fn as_i64(whole: &DeInteger<'_>, needed: &dyn Expected) -> Result<i64, Fault> {
    i64::from_str_radix(whole.as_str(), whole.radix())
        .map_err(|_| Fault::invalid_value(Unexpected::Str(&whole.to_string()), needed))
}

/// The items of an array.
struct Items<'a, 't> {
    key: String,
    place: usize,
    items: &'a [Spanned<DeValue<'t>>],
}

impl<'de> SeqAccess<'de> for Items<'de, '_> {
    type Error = Fault;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Fault> {
        self.next().map(|item| item.read(seed)).transpose()
    }
}

impl<'a, 't> Iterator for Items<'a, 't> {
    type Item = TomlValue<'a, 't>;

    fn next(&mut self) -> Option<Self::Item> {
        let item = self.items.get(self.place)?;
        let key = format!("{}[{}]", self.key, self.place);
        self.place += 1;
        Some(TomlValue { key, value: item.get_ref() })
    }
}

/// The entries of a table.
struct Entries<'a, 't> {
    key: String,
    entries: IntoIter<(&'a Spanned<DeString<'t>>, &'a Spanned<DeValue<'t>>)>,
    value: Option<TomlValue<'a, 't>>,
}

impl<'a, 't> Entries<'a, 't> {
    /// In the order of the text: of several mistakes, the first is said.
    fn of(table: &'a DeTable<'t>, key: String) -> Self {
        let mut entries: Vec<_> = table.iter().collect();
        entries.sort_by_key(|(name, _)| name.span().start);
        Self { key, entries: entries.into_iter(), value: None }
    }

    /// The name of the next entry, whose value is kept.
    fn next_name(&mut self) -> Option<&'a str> {
        let (name, value) = self.entries.next()?;
        self.value = Some(TomlValue { key: joined(&self.key, name.get_ref()), value: value.get_ref() });
        Some(name.get_ref())
    }
}

impl<'de> MapAccess<'de> for Entries<'de, '_> {
    type Error = Fault;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Fault> {
        let Some(name) = self.next_name() else { return Ok(None) };
        seed.deserialize(BorrowedStrDeserializer::new(name))
            .map(Some)
            .map_err(|fault: Fault| fault.at(&self.key))
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Fault> {
        match self.value.take() {
            Some(value) => value.read(seed),
            None => Err(Fault::custom("a value without a key")),
        }
    }
}
