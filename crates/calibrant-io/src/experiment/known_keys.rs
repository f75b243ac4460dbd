//! The keys that an experiment file may have, as serde lists the fields of its types, and those that somebody meant.

use super::file::ExperimentFile;
use super::similar_word::nearest;
use serde::de::value::StrDeserializer;
use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, Error, IntoDeserializer, MapAccess, SeqAccess, Visitor,
};
use std::fmt;

/// The keys of a section.
type Keys = &'static [&'static str];

/// All sections and their keys; the first is the top of the file.
#[must_use]
pub fn sections() -> Vec<(String, Keys)> {
    fn add(path: &mut Vec<&'static str>, all: &mut Vec<(String, Keys)>) {
        let Err(Found(Some(keys))) = ExperimentFile::deserialize(Probe(path)) else { return };
        all.push((path.join("."), keys));
        for key in keys {
            path.push(key);
            add(path, all);
            path.pop();
        }
    }
    let mut all = Vec::new();
    add(&mut Vec::new(), &mut all);
    all
}

/// The help for an unknown key: the section where it belongs, the nearest key, or all keys.
pub(super) fn suggest(section: &str, unknown: &str, known: Keys) -> String {
    let near = nearest(unknown, known.iter().copied());
    if let Some(key) = near.filter(|key| strsim::damerau_levenshtein(key, unknown) <= 2) {
        return format!("did you mean `{key}`?");
    }
    if section.starts_with("known.") {
        return "the name of a quantity has dots and needs quotes: \"gyroscope.bias.x\" = 0.0".into();
    }
    if let Some((home, _)) =
        sections().iter().find(|(name, keys)| *name != section && keys.contains(&unknown))
    {
        return if home.is_empty() {
            format!("`{unknown}` belongs at the top of the file, before the first [section]")
        } else {
            format!("`{unknown}` belongs in [{home}]")
        };
    }
    match near {
        Some(key) => format!("did you mean `{key}`?"),
        None => format!("the keys here are {}", known.join(", ")),
    }
}

/// The keys that were looked for; `None` where there are none.
#[derive(Debug)]
struct Found(Option<Keys>);

impl Error for Found {
    fn custom<T: fmt::Display>(_: T) -> Self {
        Self(None)
    }
}

impl std::error::Error for Found {}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.0)
    }
}

/// Follows a path through the types and returns the keys of the table at its end, as an error.
struct Probe<'p>(&'p [&'static str]);

impl<'de> Deserializer<'de> for Probe<'_> {
    type Error = Found;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Found> {
        Err(Found(None))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        keys: Keys,
        visitor: V,
    ) -> Result<V::Value, Found> {
        match self.0 {
            [] => Err(Found(Some(keys))),
            _ => visitor.visit_map(self),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Found> {
        visitor.visit_some(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Found> {
        visitor.visit_seq(self)
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct
        newtype_struct tuple tuple_struct map enum identifier ignored_any
    }
}

impl<'de> SeqAccess<'de> for Probe<'_> {
    type Error = Found;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Found> {
        seed.deserialize(Probe(self.0)).map(Some)
    }
}

impl<'de> MapAccess<'de> for Probe<'_> {
    type Error = Found;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Found> {
        let Some(key) = self.0.first() else { return Ok(None) };
        let key: StrDeserializer<'_, Found> = key.into_deserializer();
        seed.deserialize(key).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Found> {
        seed.deserialize(Probe(&self.0[1..]))
    }
}
