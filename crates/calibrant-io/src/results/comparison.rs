//! Two calibrations side by side, as JSON.

use super::heading::{Heading, JsonFile};
use calibrant_core::estimate::Comparison;
use calibrant_core::json::flat;
use calibrant_core::json_object;

/// A comparison of two calibrations, and the files that they come from. Angles are in rad.
#[derive(Debug, Clone, Copy)]
pub struct ComparisonFile<'a> {
    /// The comparison.
    pub comparison: &'a Comparison,
    /// The first file.
    pub a: &'a str,
    /// The second file.
    pub b: &'a str,
}

json_object! {
    /// Two calibrations side by side. Angles are in rad.
    ComparisonFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        /// The first calibration, by its name.
        a: file.a,
        /// The second calibration, by its name.
        b: file.b,
        comparison: flat(file.comparison),
    }
}

impl JsonFile for ComparisonFile<'_> {
    const KIND: &'static str = "comparison";
}
