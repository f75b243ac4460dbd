//! Checks of parameters beside what was known of them.

use super::check::checks;
use super::parts::{Part, Parts};
use crate::sensor::{Axis, ReadingUnit, SensorKind};
use std::fmt;

/// The gain of an accelerometer whose readings in g are taken for m/s².
const GAIN_IN_G: f64 = 0.102;

checks! {
    /// A parameter is far from its nominal value. A mistake is more likely than a rare sensor.
    ParameterImplausible "parameter-implausible" Error {
        /// Its name.
        parameter: String,
        /// The difference, in standard deviations of datasheet and estimate together.
        deviations: f64,
    }
    decided "The difference exceeds 6 standard deviations of datasheet and estimate together."
    remedy "Check the unit of the recording, gravity, and the order and direction of the axes."
    says format!(
        "{parameter} is {deviations:.0} standard deviations of the datasheet from its nominal value. Check the unit \
         of the recording, gravity, and the order and direction of the axes."
    );

    /// A gain of readings in SI is far from 1.
    GainImplausible "gain-implausible" Error {
        /// The sensor.
        sensor_kind: SensorKind,
        /// The axis.
        axis: Axis,
        /// The gain along the axis.
        gain: f64,
        /// Unit of the readings.
        unit: ReadingUnit,
    }
    decided "It is below 0.8 or above 1.25, and the datasheet does not allow for it."
    remedy "Check unit, sample rate, order and direction of the axes, turns and faces."
    says format!(
        "the gain of the {sensor_kind}'s axis {axis} is {gain:.3}. For readings in {} it should be near 1.{} Check \
         unit, sample rate, order and direction of the axes, and the given turns and faces.",
        unit.symbol(),
        if *unit == ReadingUnit::MetrePerSecondSquared && (gain.abs() / GAIN_IN_G - 1.0).abs() < 0.1 {
            " Readings in g have a gain of 0.102."
        } else {
            ""
        }
    );

    /// A scale factor is negative.
    ScaleNegative "scale-negative" Error {
        /// The axis.
        axis: Axis,
    }
    decided "The estimate is below zero."
    remedy "Check the direction of the axis."
    says format!("the scale factor of axis {axis} is negative. Is the axis reversed?");

    /// The recording determines a parameter less well than the datasheet.
    WeakerThanDatasheet "weaker-than-datasheet" Warning {
        /// The parameters.
        parameters: Vec<String>,
    }
    decided "Its standard deviation exceeds the datasheet's spread."
    remedy "Record for longer, or use a motion that excites the parameter."
    says format!(
        "the recording determines {} less well than the datasheet: the standard deviation exceeds the datasheet's spread",
        parameters.join(", ")
    );

    /// The data contradict the value of a parameter in `[known]`.
    KnownContradicted "known-contradicted" Warning {
        /// The parameter.
        known: KnownMismatch,
    }
    decided "The difference exceeds 6 standard deviations of the fit without the given values."
    remedy "Correct the value or its unit, or remove it."
    says format!("{known}. Correct the value or its unit, or remove it.");
}

/// A parameter whose value in `[known]` the data contradict.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownMismatch {
    /// Its name.
    pub parameter: String,
    /// Its value in `[known]`.
    pub given: f64,
    /// What the recording alone gives.
    pub found: f64,
    /// Its standard deviation.
    pub found_sd: f64,
}

impl fmt::Display for KnownMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { parameter, given, found, found_sd } = self;
        write!(
            f,
            "the recording contradicts {parameter} in [known]: the given value is {given:?}, but the recording alone gives {found:.5} ± {found_sd:.1e}"
        )
    }
}

impl Part for KnownMismatch {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        parts.subject.push(self.parameter.clone());
        let numbers = [("given", self.given), ("found", self.found), ("found_sd", self.found_sd)];
        parts.numbers.extend(numbers);
    }
}
