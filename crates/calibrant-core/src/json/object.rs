//! Objects with fields that follow from a value.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Serialize;
use serde::ser::SerializeMap;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::marker::PhantomData;

/// The fields of an object. [`json_object!`](crate::json_object) implements it.
pub trait Fields {
    /// Writes them.
    ///
    /// # Errors
    /// Those of the serializer.
    fn write_fields<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error>;

    /// Adds them to the schema of the object.
    fn describe_fields(object: &mut ObjectSchema<'_>);
}

impl<T: Fields + ?Sized> Fields for &T {
    fn write_fields<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
        (**self).write_fields(map)
    }

    fn describe_fields(object: &mut ObjectSchema<'_>) {
        T::describe_fields(object);
    }
}

/// What stands at a key. Every serializable value does; others leave themselves out, or change the key.
pub trait Entry {
    /// Writes it.
    ///
    /// # Errors
    /// Those of the serializer.
    fn write<M: SerializeMap>(&self, key: &str, map: &mut M) -> Result<(), M::Error>;

    /// Adds it to the schema of the object.
    fn describe(key: &str, about: &str, object: &mut ObjectSchema<'_>);
}

impl<T: Serialize + JsonSchema> Entry for T {
    fn write<M: SerializeMap>(&self, key: &str, map: &mut M) -> Result<(), M::Error> {
        map.serialize_entry(key, self)
    }

    fn describe(key: &str, about: &str, object: &mut ObjectSchema<'_>) {
        object.add::<T>(key, about);
        object.required.push(key.into());
    }
}

/// See [`if_some`](super::if_some).
pub struct IfSome<T>(pub(super) Option<T>);

impl<T: Entry> Entry for IfSome<T> {
    fn write<M: SerializeMap>(&self, key: &str, map: &mut M) -> Result<(), M::Error> {
        self.0.as_ref().map_or(Ok(()), |value| value.write(key, map))
    }

    fn describe(key: &str, about: &str, object: &mut ObjectSchema<'_>) {
        object.optionally(|object| T::describe(key, about, object));
    }
}

/// See [`if_any`](super::if_any).
pub struct IfAny<T>(pub(super) T);

impl<T: Serialize + JsonSchema> Entry for IfAny<&[T]> {
    fn write<M: SerializeMap>(&self, key: &str, map: &mut M) -> Result<(), M::Error> {
        if self.0.is_empty() { Ok(()) } else { map.serialize_entry(key, self.0) }
    }

    fn describe(key: &str, about: &str, object: &mut ObjectSchema<'_>) {
        object.optionally(|object| <&[T]>::describe(key, about, object));
    }
}

impl<T: Serialize + JsonSchema> Entry for IfAny<Vec<T>> {
    fn write<M: SerializeMap>(&self, key: &str, map: &mut M) -> Result<(), M::Error> {
        IfAny(self.0.as_slice()).write(key, map)
    }

    fn describe(key: &str, about: &str, object: &mut ObjectSchema<'_>) {
        IfAny::<&[T]>::describe(key, about, object);
    }
}

impl<K: Serialize + JsonSchema, T: Serialize + JsonSchema> Entry for IfAny<BTreeMap<K, T>> {
    fn write<M: SerializeMap>(&self, key: &str, map: &mut M) -> Result<(), M::Error> {
        if self.0.is_empty() { Ok(()) } else { map.serialize_entry(key, &self.0) }
    }

    fn describe(key: &str, about: &str, object: &mut ObjectSchema<'_>) {
        object.optionally(|object| BTreeMap::<K, T>::describe(key, about, object));
    }
}

/// See [`with_ending`](super::with_ending).
pub struct WithEnding<T> {
    pub(super) ending: &'static str,
    pub(super) value: T,
}

impl<T: Serialize + JsonSchema> Entry for WithEnding<T> {
    fn write<M: SerializeMap>(&self, key: &str, map: &mut M) -> Result<(), M::Error> {
        map.serialize_entry(&format!("{key}_{}", self.ending), &self.value)
    }

    fn describe(key: &str, about: &str, object: &mut ObjectSchema<'_>) {
        for ending in ["mps2", "radps", "counts"] {
            object.add::<T>(&format!("{key}_{ending}"), about);
        }
    }
}

/// See [`flat`](super::flat).
pub struct Flat<T>(pub(super) T);

impl<T: Fields> Entry for Flat<T> {
    fn write<M: SerializeMap>(&self, _: &str, map: &mut M) -> Result<(), M::Error> {
        self.0.write_fields(map)
    }

    fn describe(_: &str, _: &str, object: &mut ObjectSchema<'_>) {
        T::describe_fields(object);
    }
}

/// See [`named`](super::named).
pub struct Named<K, T>(pub(super) Vec<(K, T)>);

impl<K: AsRef<str>, T: Serialize + JsonSchema> Entry for Named<K, T> {
    fn write<M: SerializeMap>(&self, _: &str, map: &mut M) -> Result<(), M::Error> {
        self.0.iter().try_for_each(|(key, value)| map.serialize_entry(key.as_ref(), value))
    }

    fn describe(_: &str, _: &str, object: &mut ObjectSchema<'_>) {
        let others = object.generator.subschema_for::<T>();
        object.others = Some(others.into());
    }
}

/// The JSON Schema of an object, while its fields are added.
pub struct ObjectSchema<'a> {
    generator: &'a mut SchemaGenerator,
    properties: Map<String, Value>,
    required: Vec<Value>,
    others: Option<Value>,
}

impl ObjectSchema<'_> {
    /// The schema of an object with these fields.
    pub fn of<T: Fields>(generator: &mut SchemaGenerator) -> Schema {
        let mut object =
            ObjectSchema { generator, properties: Map::new(), required: Vec::new(), others: None };
        T::describe_fields(&mut object);
        let mut schema =
            json_schema!({ "type": "object", "properties": object.properties, "required": object.required });
        if let Some(others) = object.others {
            schema.insert("additionalProperties".into(), others);
        }
        schema
    }

    /// Adds a field. `value` is not called: it gives the type of the entry.
    pub fn entry<'s, S: 's, T: Entry>(
        &mut self,
        _: PhantomData<&'s S>,
        key: &str,
        about: &str,
        _: impl FnOnce(&'s S) -> T,
    ) {
        T::describe(key, about.trim(), self);
    }

    fn add<T: JsonSchema>(&mut self, key: &str, about: &str) {
        let schema = described(self.generator.subschema_for::<T>(), about);
        self.properties.insert(key.into(), schema.into());
    }

    fn optionally(&mut self, add: impl FnOnce(&mut Self)) {
        let required = self.required.len();
        add(self);
        self.required.truncate(required);
    }
}

/// A schema with a description.
#[must_use]
pub fn described(mut schema: Schema, about: &str) -> Schema {
    if !about.trim().is_empty() {
        schema.insert("description".into(), about.trim().into());
    }
    schema
}

/// The last word of a type's path, without its parameters.
#[must_use]
pub fn type_name(path: &str) -> String {
    let plain = path.split('<').next().unwrap_or_default();
    plain.rsplit("::").next().unwrap_or_default().trim().to_owned()
}

/// Says which fields the JSON object of a type has, each with what stands there. It implements `Serialize`, `JsonSchema` and
/// [`Fields`](crate::json::Fields).
///
/// ```
/// use calibrant_core::json::{if_some, with_ending};
///
/// struct Hold { first: usize, end: usize, mean: f64, unit: &'static str, reason: Option<String> }
///
/// calibrant_core::json_object! {
///     /// A hold.
///     Hold as hold {
///         /// Number of samples.
///         samples: hold.end - hold.first,
///         mean: with_ending(hold.unit, hold.mean),
///         reason: if_some(hold.reason.as_deref()),
///     }
/// }
///
/// let hold = Hold { first: 10, end: 30, mean: 2.5, unit: "counts", reason: None };
/// assert_eq!(serde_json::to_string(&hold).expect("it is"), r#"{"samples":20,"mean_counts":2.5}"#);
/// ```
#[macro_export]
macro_rules! json_object {
    ($(#[doc = $about:literal])* $type:ty as $this:ident { $($(#[doc = $doc:literal])* $key:ident: $value:expr),* $(,)? }) => {
        impl $crate::json::Fields for $type {
            fn write_fields<M: ::serde::ser::SerializeMap>(&self, map: &mut M) -> ::core::result::Result<(), M::Error> {
                let $this = self;
                let _ = $this;
                $($crate::json::Entry::write(&$value, stringify!($key), map)?;)*
                Ok(())
            }

            fn describe_fields(object: &mut $crate::json::ObjectSchema<'_>) {
                let this = ::core::marker::PhantomData::<&Self>;
                $(object.entry(this, stringify!($key), concat!($($doc, "\n",)*), |$this| {
                    let _ = $this;
                    $value
                });)*
            }
        }

        impl ::serde::Serialize for $type {
            fn serialize<S: ::serde::Serializer>(&self, serializer: S) -> ::core::result::Result<S::Ok, S::Error> {
                let mut map = ::serde::Serializer::serialize_map(serializer, None)?;
                $crate::json::Fields::write_fields(self, &mut map)?;
                ::serde::ser::SerializeMap::end(map)
            }
        }

        impl ::schemars::JsonSchema for $type {
            fn schema_name() -> ::std::borrow::Cow<'static, str> {
                $crate::json::type_name(stringify!($type)).into()
            }

            fn schema_id() -> ::std::borrow::Cow<'static, str> {
                concat!(module_path!(), "::", stringify!($type)).into()
            }

            fn json_schema(generator: &mut ::schemars::SchemaGenerator) -> ::schemars::Schema {
                let schema = $crate::json::ObjectSchema::of::<Self>(generator);
                $crate::json::described(schema, concat!($($about, "\n",)*))
            }
        }
    };
}
