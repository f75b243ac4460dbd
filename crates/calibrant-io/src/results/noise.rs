//! `noise.json`: the noise of a sensor at rest, its Allan deviation and its coefficients.

use super::heading::{Heading, JsonFile};
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
}

json_object! {
    /// The noise of one sensor or of both.
    NoiseFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        /// Of the intervals of coefficients.
        confidence: CONFIDENCE,
        sensors: file.noise,
        input: file.inputs.first(),
        /// The gyroscope's file, where it has one of its own.
        gyroscope_input: if_some(file.inputs.get(1)),
    }
}

impl JsonFile for NoiseFile<'_> {
    const KIND: &'static str = "noise";
}
