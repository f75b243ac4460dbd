//! A true value.

use schemars::JsonSchema;
use serde::Serialize;

/// A true value.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(crate) struct TrueParameter {
    pub(crate) name: String,
    pub(crate) unit: &'static str,
    pub(crate) value: f64,
}
