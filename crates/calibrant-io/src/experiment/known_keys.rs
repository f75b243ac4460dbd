//! The keys that an experiment file may have, as serde lists the fields of its types, and those that somebody meant.

use super::file::ExperimentFile;
use calibrant_recording::text::similar_word::nearest;
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

/// The help for an unknown key: the key here that it is without its unit, or with a slip; the section where it belongs; or all keys. `has` says whether
/// the file has a section.
pub(super) fn suggest(section: &str, unknown: &str, known: Keys, has: impl Fn(&str) -> bool) -> String {
    let plain = unknown.to_lowercase().replace(['-', ' '], "_");
    if known.contains(&plain.as_str()) {
        return format!("did you mean `{plain}`?");
    }
    let after = |key: &str| key.strip_prefix(plain.as_str())?.strip_prefix('_').map(str::to_owned);
    let longer: Vec<&str> = known.iter().copied().filter(|key| after(key).is_some()).collect();
    // `gravity_mps2` before `gravity_sd_mps2`
    let is_unit = |key: &&&str| after(key).is_some_and(|rest| !rest.contains('_'));
    let with_unit: Vec<&str> = longer.iter().filter(is_unit).copied().collect();
    let meant = if with_unit.is_empty() { longer } else { with_unit };
    if !meant.is_empty() {
        return format!("did you mean `{}`?", meant.join("` or `"));
    }
    // in a short word, one slip makes another word
    let slips = |key: &&&str| strsim::damerau_levenshtein(key, &plain);
    let near = known.iter().min_by_key(slips).filter(|key| slips(key) <= (plain.len() / 2).min(2));
    if let Some(key) = near {
        return format!("did you mean `{key}`?");
    }
    if section.starts_with("known.") {
        return "the name of a quantity has dots and needs quotes: \"gyroscope.bias.x\" = 0.0".into();
    }
    match homes(section, &plain, has).as_slice() {
        [] => match nearest(unknown, known.iter().copied()) {
            Some(key) => format!("did you mean `{key}`?"),
            None => format!("the keys here are {}", known.join(", ")),
        },
        [top] if top.is_empty() => {
            format!("`{plain}` belongs at the top of the file, before the first [section]")
        }
        homes => format!("`{plain}` belongs in [{}]", homes.join("] or [")),
    }
}

/// The other sections that have this key: those of the file, or else those that it may have.
fn homes(section: &str, key: &str, has: impl Fn(&str) -> bool) -> Vec<String> {
    /// A file has one of these.
    const PLANS: [&str; 3] = ["motion", "holds", "machine"];
    let plan = PLANS.into_iter().find(|plan| has(plan));
    let may_have = |name: &str| {
        let top = name.split('.').next().unwrap_or(name);
        !PLANS.contains(&top) || plan.is_none_or(|plan| plan == top)
    };
    let all = sections();
    let others = all.iter().filter(|(name, keys)| name != section && keys.contains(&key) && may_have(name));
    let others: Vec<String> = others.map(|(name, _)| name.clone()).collect();
    let there: Vec<String> = others.iter().filter(|name| name.is_empty() || has(name)).cloned().collect();
    if there.is_empty() { others } else { there }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// What a user would write after this help: the section, and the keys that it names.
    fn obeyed(section: &str, help: &str) -> Vec<(String, String)> {
        let keys: Vec<String> = help.split('`').skip(1).step_by(2).map(ToOwned::to_owned).collect();
        let homes = || help.split('[').skip(1).filter_map(|rest| Some(rest.split_once(']')?.0.to_owned()));
        match help {
            _ if help.starts_with("did you mean") => {
                keys.into_iter().map(|key| (section.to_owned(), key)).collect()
            }
            _ if help.starts_with("the keys here are ") => Vec::new(),
            _ if help.contains("belongs at the top") => vec![(String::new(), keys[0].clone())],
            _ => homes().map(|home| (home, keys[0].clone())).collect(),
        }
    }

    #[test]
    fn every_remedy_of_an_unknown_key_is_a_key_of_its_section() {
        let all = sections();
        for plan in ["motion", "holds", "machine"] {
            let has = |section: &str| section == plan || !["motion", "holds", "machine"].contains(&section);
            let of_plan = all.iter().filter(|(name, _)| has(name.split('.').next().unwrap_or(name)));
            for (section, keys) in of_plan {
                for key in keys.iter().filter(|key| key.len() > 1) {
                    let (first, last) = key.split_at(key.len() - 1);
                    let without_unit = key.rsplit_once('_').map(|(stem, _)| stem);
                    let swapped = format!("{}{}", &key[1..2], &key[..1]) + &key[2..];
                    let slips = [
                        swapped,
                        first.to_owned(),
                        format!("{key}{last}"),
                        key.to_uppercase(),
                        key.replace('_', "-"),
                    ];
                    for typed in slips.iter().map(String::as_str).chain(without_unit) {
                        if keys.contains(&typed) {
                            continue;
                        }
                        let help = suggest(section, typed, keys, has);
                        let written = obeyed(section, &help);
                        let is_key = |(home, key): &(String, String)| {
                            all.iter().any(|(name, keys)| name == home && keys.contains(&key.as_str()))
                                && has(home.split('.').next().unwrap_or(home))
                        };
                        assert!(written.iter().all(is_key), "[{section}] {typed}: {help}");
                        // a slip, or a unit that was left away, is no reason to go elsewhere
                        let is_here = written.is_empty() || written.iter().any(|(home, _)| home == section);
                        assert!(
                            is_here || Some(typed) != without_unit && key.len() < 4,
                            "[{section}] {typed}: {help}"
                        );
                        if Some(typed) == without_unit {
                            assert!(written.iter().any(|(_, of)| of == key), "[{section}] {typed}: {help}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_key_of_another_section_is_sent_where_the_file_can_have_it() {
        let keys = |section: &str| sections().into_iter().find(|(name, _)| name == section).expect("there").1;
        let help =
            |section: &str, typed: &str, plan: &str| suggest(section, typed, keys(section), |of| of == plan);
        assert_eq!(help("holds", "gravity", "holds"), "did you mean `gravity_mps2`?");
        assert_eq!(help("sensor", "gravity_mps2", "holds"), "`gravity_mps2` belongs in [holds]");
        assert_eq!(help("sensor", "intervals", "motion"), "`intervals` belongs in [motion]");
    }
}
