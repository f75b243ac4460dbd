//! The first fields of every JSON file.

use super::json::SCHEMA;
use calibrant_core::json::{Entry, Fields, ObjectSchema};
use calibrant_recording::files::program::program;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};
use std::borrow::Cow;
use std::marker::PhantomData;

/// A type that is written as a JSON file.
pub trait JsonFile {
    /// The kind of file: what it says as `kind`, and the name of its schema.
    const KIND: &'static str;
}

/// The kind of the file that `calibrant records show` prints. It has all that is read of a calibration.
pub const RECORD_KIND: &str = "record";

/// The first fields of a JSON file: to be flattened into it.
#[derive(Debug, Clone, Copy)]
pub struct Heading<T>(Kind<T>);

/// The kind of a file as a value: its name.
#[derive(Debug, Clone, Copy)]
pub struct Kind<T>(PhantomData<T>);

impl<T> Heading<T> {
    /// Of a file of this type.
    #[must_use]
    pub fn of() -> Self {
        Self(Kind::of())
    }
}

impl<T> Kind<T> {
    /// Of a file of this type.
    #[must_use]
    pub fn of() -> Self {
        Self(PhantomData)
    }
}

impl<T: JsonFile> Fields for Heading<T> {
    fn write_fields<M: SerializeMap>(&self, map: &mut M) -> Result<(), M::Error> {
        map.serialize_entry("schema", &SCHEMA)?;
        map.serialize_entry("kind", &self.0)?;
        map.serialize_entry("program", &program())
    }

    fn describe_fields(object: &mut ObjectSchema<'_>) {
        let version = "The version of all JSON files. Added keys do not change it.";
        <u32 as Entry>::describe("schema", version, object);
        <Kind<T> as Entry>::describe("kind", "What the file is.", object);
        <String as Entry>::describe("program", "Who wrote it.", object);
    }
}

impl<T: JsonFile> Serialize for Kind<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(T::KIND)
    }
}

impl<T: JsonFile> JsonSchema for Kind<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        T::KIND.into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string", "const": T::KIND })
    }
}
