//! How often a campaign passes over its range.

use super::number::Count;
use serde::de::{Error, IntoDeserializer, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// Closed cycles over the range: 1 to 3, or `"best"`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cycles {
    /// So many.
    Count(Count<1, 3>),
    /// The best of 1 to 3.
    Best,
}

impl Serialize for Cycles {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Count(count) => count.serialize(serializer),
            Self::Best => serializer.serialize_str("best"),
        }
    }
}

impl<'de> Deserialize<'de> for Cycles {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct CyclesVisitor;

        impl Visitor<'_> for CyclesVisitor {
            type Value = Cycles;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number from 1 to 3, or \"best\"")
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Cycles, E> {
                Count::deserialize(value.into_deserializer()).map(Cycles::Count)
            }

            fn visit_u64<E: Error>(self, value: u64) -> Result<Cycles, E> {
                Count::deserialize(value.into_deserializer()).map(Cycles::Count)
            }

            fn visit_str<E: Error>(self, value: &str) -> Result<Cycles, E> {
                match value {
                    "best" => Ok(Cycles::Best),
                    other => Err(E::invalid_value(Unexpected::Str(other), &self)),
                }
            }
        }

        deserializer.deserialize_any(CyclesVisitor)
    }
}
