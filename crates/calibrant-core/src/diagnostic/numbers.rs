//! The numbers of a diagnostic.

use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;

/// Numbers by name, in their order.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Numbers(Vec<(Cow<'static, str>, f64)>);

impl Numbers {
    pub(super) fn push(&mut self, (name, value): (impl Into<Cow<'static, str>>, f64)) {
        self.0.push((name.into(), value));
    }

    pub(super) fn extend<N: Into<Cow<'static, str>>>(&mut self, numbers: impl IntoIterator<Item = (N, f64)>) {
        numbers.into_iter().for_each(|number| self.push(number));
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (&str, f64)> {
        self.0.iter().map(|(name, value)| (name.as_ref(), *value))
    }
}

impl Serialize for Numbers {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        self.iter().try_for_each(|(name, value)| map.serialize_entry(name, &value))?;
        map.end()
    }
}

impl<'de> Deserialize<'de> for Numbers {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct InOrder;
        impl<'de> serde::de::Visitor<'de> for InOrder {
            type Value = Numbers;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("numbers by name")
            }

            fn visit_map<A: serde::de::MapAccess<'de>>(self, mut map: A) -> Result<Numbers, A::Error> {
                let mut numbers = Vec::new();
                // JSON has no infinity
                while let Some((name, value)) = map.next_entry::<String, Option<f64>>()? {
                    numbers.push((Cow::Owned(name), value.unwrap_or(f64::INFINITY)));
                }
                Ok(Numbers(numbers))
            }
        }
        deserializer.deserialize_map(InOrder)
    }
}
