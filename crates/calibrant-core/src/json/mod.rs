//! How results become JSON: each type says once which fields its object has, and both the file and its JSON Schema follow.
//!
//! A type whose object has its own fields derives `Serialize` and `JsonSchema` (and `Deserialize`, if it is read back). A field whose type has no
//! form of its own, such as a vector, names one of [`form`](crate::form).
//! A type whose object has numbers that follow from its fields lists them with [`json_object!`](crate::json_object).
//! An enum that has a name is written as that name by [`json_name!`](crate::json_name).
//!
//! Rules of all files: keys carry units; what is not known is `null` or left out; a number that is not finite is `null`; vectors are arrays
//! over the axes that were calibrated; matrices are rows.

mod name;
mod object;
#[cfg(test)]
mod tests;

pub use object::{Entry, Fields, Flat, IfAny, IfSome, Named, ObjectSchema, WithEnding, described, type_name};

/// A field that is left out where there is nothing.
pub fn if_some<T>(value: Option<T>) -> IfSome<T> {
    IfSome(value)
}

/// A list that is left out where it is empty.
pub fn if_any<T>(values: T) -> IfAny<T> {
    IfAny(values)
}

/// A field whose key ends in a unit, such as that of the readings: `mean_counts`, `mean_mps2`.
pub fn with_ending<T>(ending: &'static str, value: T) -> WithEnding<T> {
    WithEnding { ending, value }
}

/// The fields of a value, in place of the field itself.
pub fn flat<T>(value: T) -> Flat<T> {
    Flat(value)
}

/// Fields whose keys are known only with the value.
pub fn named<K, T>(entries: impl IntoIterator<Item = (K, T)>) -> Named<K, T> {
    Named(entries.into_iter().collect())
}
