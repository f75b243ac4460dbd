//! A true value.

use schemars::JsonSchema;
use serde::Serialize;

/// A true value.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub(super) struct TrueParameter {
    pub(super) name: String,
    pub(super) unit: &'static str,
    pub(super) value: f64,
}
