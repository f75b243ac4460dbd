//! `noise.json`: the noise of a sensor at rest, its Allan deviation and its coefficients.

use super::diagnostics::{DiagnosticWords, WordedDiagnostic};
use super::heading::Heading;
use super::input::Input;
use calibrant_core::json::{flat, if_some};
use calibrant_core::json_object;
use calibrant_core::noise::{CONFIDENCE, SensorNoise};

/// The content of `noise.json`: the noise of one sensor or of both, and the recording from which it came. Two files
/// are the accelerometer's and the gyroscope's.
#[derive(Clone, Copy)]
pub struct NoiseFile<'a> {
    /// The noise of each sensor.
    pub noise: &'a [SensorNoise],
    /// The file, or those of accelerometer and gyroscope.
    pub inputs: &'a [Input],
    /// How warnings are written.
    pub words: DiagnosticWords<'a>,
}

json_object! {
    /// The noise of one sensor or of both.
    NoiseFile<'_> as file {
        heading: flat(Heading::of("noise")),
        /// Of the intervals of coefficients.
        confidence: CONFIDENCE,
        sensors: file.noise.iter().map(|noise| Warned { noise, words: &file.words }).collect::<Vec<_>>(),
        input: file.inputs.first(),
        /// The gyroscope's file, where it has one of its own.
        gyroscope_input: if_some(file.inputs.get(1)),
    }
}

struct Warned<'a> {
    noise: &'a SensorNoise,
    words: &'a DiagnosticWords<'a>,
}

json_object! {
    /// The noise of a sensor, and what the user should know of it.
    Warned<'_> as sensor {
        noise: flat(sensor.noise),
        warnings: sensor.warnings(),
    }
}

impl Warned<'_> {
    fn warnings(&self) -> Vec<WordedDiagnostic<'_>> {
        self.words.all(&self.noise.warnings)
    }
}
