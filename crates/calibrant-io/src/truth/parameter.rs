//! A true value.

use schemars::JsonSchema;
use serde::Serialize;

/// A true value.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(crate) struct TrueParameter {
    /// Which parameter it is.
    pub(crate) name: String,
    /// Its unit.
    pub(crate) unit: &'static str,
    /// The true value.
    pub(crate) value: f64,
}
