//! Parameters of one kind, which share a panel, and the looks of their markers.

use super::colour;
use super::panel::Shape;
use calibrant_core::sensor::Parameter;

pub(super) struct Kind {
    pub(super) name: &'static str,
    prefix: &'static str,
    pub(super) unit: &'static str,
    /// Places in the list.
    pub(super) members: Vec<usize>,
}

impl Kind {
    /// The name of a parameter within its kind: `x`.
    pub(super) fn suffix<'a>(&self, parameter: &'a Parameter) -> &'a str {
        parameter.name.trim_start_matches(self.prefix)
    }
}

/// Biases, scale factors and cross-axis sensitivities, as far as there are any.
pub(super) fn kinds(parameters: &[Parameter]) -> Vec<Kind> {
    let kind = |(prefix, name)| {
        let is_member = |p: &usize| parameters[*p].name.starts_with(prefix);
        let members: Vec<usize> = (0..parameters.len()).filter(is_member).collect();
        Some(Kind { name, prefix, unit: parameters[*members.first()?].unit, members })
    };
    let all = [("bias.", "bias"), ("scale.", "scale factor"), ("matrix.", "cross-axis sensitivity")];
    all.into_iter().filter_map(kind).collect()
}

/// Colour and shape of each of several series of markers.
pub(super) fn look(place: usize) -> (&'static str, Shape) {
    let looks = [
        (colour::BLUE, Shape::Circle),
        (colour::VERMILLION, Shape::Square),
        (colour::GREEN, Shape::Triangle),
        (colour::ORANGE, Shape::Cross),
        (colour::SKY, Shape::Circle),
        (colour::GREY, Shape::Square),
    ];
    looks[place % looks.len()]
}
