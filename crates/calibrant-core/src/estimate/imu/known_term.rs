//! What is known of a parameter beforehand.

use crate::json::if_some;
use crate::json_object;
use crate::sensor::ImuQuantity;

/// A known quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownTerm {
    /// The quantity.
    pub quantity: ImuQuantity,
    /// Its value.
    pub value: f64,
    /// Its standard uncertainty. `None`: it is fixed at the value.
    pub sd: Option<f64>,
}

json_object! {
    /// A known quantity.
    KnownTerm as of {
        /// Name of the parameter.
        name: of.quantity.name(),
        /// In the unit of the parameter, as the standard deviation.
        value: of.value,
        sd: if_some(of.sd),
    }
}
