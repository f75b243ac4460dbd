//! Numbers of an experiment file: each type carries its range and unit, and refuses what lies outside.

use serde::de::{
    Deserialize, Deserializer, Error, IntoDeserializer, MapAccess, SeqAccess, Unexpected, Visitor,
    value::{MapAccessDeserializer, SeqAccessDeserializer},
};
use serde::ser::{Serialize, Serializer};
use std::fmt;
use std::marker::PhantomData;

/// The range of a number and its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    least: f64,
    open: bool,
    most: f64,
    unit: &'static str,
}

impl Bounds {
    /// Above `least`, up to `most`.
    pub(super) const fn above(least: f64, most: f64, unit: &'static str) -> Self {
        Self { least, open: true, most, unit }
    }

    /// From `least` to `most`.
    pub(super) const fn from(least: f64, most: f64, unit: &'static str) -> Self {
        Self { least, open: false, most, unit }
    }

    /// Is this number within? NaN is not.
    #[must_use]
    pub fn contain(&self, number: f64) -> bool {
        number <= self.most && if self.open { number > self.least } else { number >= self.least }
    }

    /// What is wrong with a number, where something is.
    pub(super) fn complaint(&self, number: f64) -> Option<String> {
        match number {
            _ if self.contain(number) => None,
            _ if number.is_finite() => Some(format!("{number:?} is out of range")),
            _ => Some("a finite number is needed here".into()),
        }
    }
}

impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { least, open, most, unit } = self;
        let space = if unit.is_empty() { "" } else { " " };
        let [least, most] = [least, most].map(|&bound| {
            let plain = bound == 0.0 || (1e-3..1e6).contains(&bound.abs());
            if plain { bound.to_string() } else { format!("{bound:e}") }
        });
        let word = if *open { "above" } else { "from" };
        write!(f, "a number {word} {least}{space}{unit}, at most {most}{space}{unit}")
    }
}

/// A physical range.
pub trait Range {
    /// Its bounds and unit.
    const BOUNDS: Bounds;
}

/// A number that lies in the range `R` where it is read from a file. In code it is made with `into()`, and
/// [`ExperimentFile::experiment`](super::ExperimentFile::experiment) checks it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Within<R> {
    number: f64,
    range: PhantomData<R>,
}

impl<R> Within<R> {
    /// The number.
    #[must_use]
    pub fn get(self) -> f64 {
        self.number
    }
}

impl<R> From<f64> for Within<R> {
    fn from(number: f64) -> Self {
        Self { number, range: PhantomData }
    }
}

impl<R> From<Within<R>> for f64 {
    fn from(within: Within<R>) -> Self {
        within.number
    }
}

impl<R> Serialize for Within<R> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(self.number)
    }
}

impl<'de, R: Range> Deserialize<'de> for Within<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_f64(R::BOUNDS).map(Self::from)
    }
}

/// Reads a number within: one visitor for all ranges.
impl Visitor<'_> for Bounds {
    type Value = f64;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a number\n{self}")
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<f64, E> {
        self.visit_f64(number as f64)
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<f64, E> {
        match self.complaint(number) {
            None => Ok(number),
            Some(complaint) => Err(E::custom(format!("{complaint}\n{self}"))),
        }
    }
}

/// Sets a value where its key is there.
pub(super) fn set<R>(value: &mut f64, given: Option<Within<R>>) {
    if let Some(given) = given {
        *value = given.get();
    }
}

/// Reads a number of this range.
pub(super) fn within<'de, R: Range, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Within::<R>::deserialize(deserializer).map(Within::get)
}

/// Reads a size from `LEAST` to `MOST`.
pub(super) fn size<'de, const LEAST: u64, const MOST: u64, D>(deserializer: D) -> Result<usize, D::Error>
where
    D: Deserializer<'de>,
{
    Count::<LEAST, MOST>::deserialize(deserializer).map(Count::size)
}

/// Reads a whole number.
pub(super) fn whole<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u64, D::Error> {
    Count::<0, { u64::MAX }>::deserialize(deserializer).map(Count::get)
}

/// A whole number from `LEAST` to `MOST` where it is read from a file. In code it is made with `into()`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(transparent)]
pub struct Count<const LEAST: u64, const MOST: u64>(u64);

impl<const LEAST: u64, const MOST: u64> Count<LEAST, MOST> {
    /// The number.
    #[must_use]
    pub fn get(self) -> u64 {
        self.0
    }

    /// The number, as a size.
    #[must_use]
    pub fn size(self) -> usize {
        usize::try_from(self.0).unwrap_or(usize::MAX)
    }
}

impl<const LEAST: u64, const MOST: u64> From<u64> for Count<LEAST, MOST> {
    fn from(number: u64) -> Self {
        Self(number)
    }
}

impl<'de, const LEAST: u64, const MOST: u64> Deserialize<'de> for Count<LEAST, MOST> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_u64(Whole { least: LEAST, most: MOST }).map(Self)
    }
}

/// Reads a whole number within.
struct Whole {
    least: u64,
    most: u64,
}

impl Visitor<'_> for Whole {
    type Value = u64;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a whole number\na whole number from {}", self.least)?;
        if self.most > 1 << 62 { Ok(()) } else { write!(f, " to {}", self.most) }
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<u64, E> {
        let within = u64::try_from(number).ok().filter(|number| (self.least..=self.most).contains(number));
        within.ok_or_else(|| E::invalid_value(Unexpected::Signed(number), &self))
    }
}

/// A single value, or an array or a table in its place: `0.1`, or `[0.1, 0.1, 0.2]`.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum Either<S, C> {
    /// A number or a word.
    Single(S),
    /// An array or a table.
    Compound(C),
}

/// One number for all axes, or one for each.
pub type PerAxis<R> = Either<Within<R>, Vec<Within<R>>>;

impl<R> From<f64> for PerAxis<R> {
    fn from(number: f64) -> Self {
        Self::Single(number.into())
    }
}

impl<R> From<[f64; 3]> for PerAxis<R> {
    fn from(numbers: [f64; 3]) -> Self {
        Self::Compound(numbers.map(Within::from).into())
    }
}

impl<'de, S: Deserialize<'de>, C: Deserialize<'de>> Deserialize<'de> for Either<S, C> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Kind<S, C>(PhantomData<(S, C)>);

        impl<'de, S: Deserialize<'de>, C: Deserialize<'de>> Visitor<'de> for Kind<S, C> {
            type Value = Either<S, C>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "another value")
            }

            fn visit_bool<E: Error>(self, value: bool) -> Result<Self::Value, E> {
                S::deserialize(value.into_deserializer()).map(Either::Single)
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
                S::deserialize(value.into_deserializer()).map(Either::Single)
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
                S::deserialize(value.into_deserializer()).map(Either::Single)
            }

            fn visit_str<E: Error>(self, value: &str) -> Result<Self::Value, E> {
                S::deserialize(value.into_deserializer()).map(Either::Single)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, items: A) -> Result<Self::Value, A::Error> {
                C::deserialize(SeqAccessDeserializer::new(items)).map(Either::Compound)
            }

            fn visit_map<A: MapAccess<'de>>(self, entries: A) -> Result<Self::Value, A::Error> {
                C::deserialize(MapAccessDeserializer::new(entries)).map(Either::Compound)
            }
        }
        deserializer.deserialize_any(Kind(PhantomData))
    }
}
