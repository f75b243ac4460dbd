//! The axes of a design, from its parameters.

use calibrant_core::sensor::{Axis, Parameter};

/// The axes of the parameters.
pub(crate) fn axes(parameters: &[Parameter]) -> &'static [Axis] {
    let biases = parameters.iter().filter(|parameter| parameter.name.starts_with("bias.")).count();
    &Axis::ALL[..biases.min(3)]
}
