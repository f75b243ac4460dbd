//! The axes that a design is about.

use calibrant_core::sensor::{Axis, Parameter};

/// The axes that the parameters are about.
pub(crate) fn axes(parameters: &[Parameter]) -> &'static [Axis] {
    let biases = parameters.iter().filter(|parameter| parameter.name.starts_with("bias.")).count();
    &Axis::ALL[..biases.min(3)]
}
