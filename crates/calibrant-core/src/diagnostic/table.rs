//! The table of all codes.

use super::code::Code;
use super::{
    acceptance, campaign, change, comparison, convention, correction, datasheet, design, faces, files, fit,
    gyroscope, holds, log, machine, motion, noise, reader, samples, settings, simulation, turns, validation,
};

/// The codes of all areas.
const AREAS: [&[Code]; 23] = [
    settings::CODES,
    samples::CODES,
    holds::CODES,
    faces::CODES,
    turns::CODES,
    gyroscope::CODES,
    motion::CODES,
    log::CODES,
    machine::CODES,
    fit::CODES,
    datasheet::CODES,
    change::CODES,
    validation::CODES,
    campaign::CODES,
    acceptance::CODES,
    noise::CODES,
    reader::CODES,
    correction::CODES,
    convention::CODES,
    comparison::CODES,
    simulation::CODES,
    design::CODES,
    files::CODES,
];

impl Code {
    /// All codes, by area.
    pub fn all() -> impl Iterator<Item = Self> + Clone {
        AREAS.iter().flat_map(|codes| codes.iter().copied())
    }

    /// The code of this name.
    #[must_use]
    pub fn parse(name: &str) -> Option<Self> {
        Self::all().find(|code| code.name() == name)
    }
}

crate::json_name!(Code, Code::all().collect::<Vec<_>>());
