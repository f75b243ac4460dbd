//! The form that a value has in a result's JSON, where its type has none of its own: a vector is a list, a matrix
//! a list of its rows, a number that may be infinite is `null` then.
//!
//! `#[serde(with = "As::<[f64; 3]>")]` before a field names its form, for the JSON and for its JSON Schema.

use nalgebra::{DMatrix, DVector, Matrix3, UnitQuaternion, Vector3};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Serialize, Serializer};
use std::borrow::Cow;
use std::marker::PhantomData;

/// A value that can be written as a `T`.
pub trait Form<T> {
    /// The value as it is written.
    fn form(&self) -> T;
}

/// The first entries of a vector, one for each axis.
#[must_use]
pub fn per_axis(vector: &Vector3<f64>, axes: usize) -> Vec<f64> {
    vector.iter().take(axes).copied().collect()
}

/// A row for each vector.
#[must_use]
pub fn vector_rows(vectors: &[Vector3<f64>], axes: usize) -> Vec<Vec<f64>> {
    vectors.iter().map(|vector| per_axis(vector, axes)).collect()
}

/// The upper left block of a 3×3 matrix, row by row.
#[must_use]
pub fn block(matrix: &Matrix3<f64>, axes: usize) -> Vec<Vec<f64>> {
    (0..axes).map(|row| (0..axes).map(|column| matrix[(row, column)]).collect()).collect()
}

/// A matrix, row by row.
#[must_use]
pub fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    matrix.row_iter().map(|row| row.iter().copied().collect()).collect()
}

/// A number; `None` where it is not finite.
#[must_use]
pub fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}

/// Writes a field in the form `T`.
///
/// # Examples
/// ```
/// use calibrant_core::form::As;
/// use nalgebra::Vector3;
///
/// #[derive(serde::Serialize)]
/// struct Mount {
///     #[serde(with = "As::<[f64; 3]>")]
///     lever_m: Vector3<f64>,
/// }
/// let json = serde_json::to_string(&Mount { lever_m: Vector3::new(0.1, 0.0, 0.2) }).expect("text");
/// assert_eq!(json, r#"{"lever_m":[0.1,0.0,0.2]}"#);
/// ```
#[derive(Debug)]
pub struct As<T>(PhantomData<T>);

impl<T: Serialize> As<T> {
    /// Writes the value.
    ///
    /// # Errors
    /// Those of the serializer.
    pub fn serialize<S: Serializer>(value: &impl Form<T>, serializer: S) -> Result<S::Ok, S::Error> {
        value.form().serialize(serializer)
    }
}

impl<T: JsonSchema> JsonSchema for As<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        generator.subschema_for::<T>()
    }
}

impl Form<[f64; 3]> for Vector3<f64> {
    fn form(&self) -> [f64; 3] {
        (*self).into()
    }
}

impl Form<Vec<f64>> for DVector<f64> {
    fn form(&self) -> Vec<f64> {
        self.as_slice().to_vec()
    }
}

impl Form<[[f64; 3]; 3]> for Matrix3<f64> {
    fn form(&self) -> [[f64; 3]; 3] {
        self.transpose().into()
    }
}

impl Form<Vec<Vec<f64>>> for DMatrix<f64> {
    fn form(&self) -> Vec<Vec<f64>> {
        rows(self)
    }
}

/// The quaternion's `w, x, y, z`.
impl Form<[f64; 4]> for UnitQuaternion<f64> {
    fn form(&self) -> [f64; 4] {
        [self.w, self.i, self.j, self.k]
    }
}

/// `None` where it is no finite number.
impl Form<Option<f64>> for f64 {
    fn form(&self) -> Option<f64> {
        finite(*self)
    }
}

/// The ends of an interval.
impl Form<[Option<f64>; 2]> for (f64, f64) {
    fn form(&self) -> [Option<f64>; 2] {
        [self.0.form(), self.1.form()]
    }
}

/// How many there are.
impl<V> Form<usize> for Vec<V> {
    fn form(&self) -> usize {
        self.len()
    }
}

impl<T, V: Form<T>> Form<Option<T>> for Option<V> {
    fn form(&self) -> Option<T> {
        self.as_ref().map(Form::form)
    }
}

impl<T, V: Form<T>> Form<Vec<T>> for Vec<V> {
    fn form(&self) -> Vec<T> {
        self.iter().map(Form::form).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize, JsonSchema)]
    struct Example {
        #[serde(with = "As::<[[f64; 3]; 3]>")]
        matrix: Matrix3<f64>,
        #[serde(with = "As::<Option<Vec<Vec<f64>>>>")]
        covariance: Option<DMatrix<f64>>,
        #[serde(with = "As::<[Option<f64>; 2]>")]
        interval: (f64, f64),
        #[serde(with = "As::<usize>")]
        count: Vec<u8>,
    }

    #[test]
    fn matrices_are_rows_and_what_is_infinite_is_null() {
        let example = Example {
            matrix: Matrix3::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0),
            covariance: Some(DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 3.0, 4.0])),
            interval: (0.5, f64::INFINITY),
            count: vec![1, 2, 3],
        };
        let expected = serde_json::json!({
            "matrix": [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]],
            "covariance": [[1.0, 2.0], [3.0, 4.0]],
            "interval": [0.5, null],
            "count": 3,
        });
        assert_eq!(serde_json::to_value(&example).expect("written"), expected);
        let schema = serde_json::to_value(schemars::schema_for!(Example)).expect("a schema");
        let types = |name: &str| schema["properties"][name]["type"].clone();
        assert_eq!(
            (types("count"), types("covariance")),
            ("integer".into(), serde_json::json!(["array", "null"]))
        );
    }
}
