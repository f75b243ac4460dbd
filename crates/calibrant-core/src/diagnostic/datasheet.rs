//! Checks of parameters beside what was known of them.

use super::check::checks;
use crate::sensor::{Axis, ReadingUnit, SensorKind};

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

    /// The bias of an accelerometer of readings in SI is more than half of gravity. It is gravity, not a bias.
    BiasImplausible "bias-implausible" Error {
        /// Its magnitude, m/s².
        bias_mps2: f64,
    }
    decided "It is above 4.9 m/s², and the datasheet does not allow for it."
    remedy "Check the direction of gravity (`up`), its magnitude, and the unit of the recording."
    says format!(
        "the bias of the accelerometer is {bias_mps2:.1} m/s². More than half of gravity is gravity that was taken for a \
         bias. Check the direction of gravity (`up`), its magnitude, and the unit of the recording."
    );

    /// A gain of readings in SI is far from 1.
    GainImplausible "gain-implausible" Error {
        sensor_kind: SensorKind,
        axis: Axis,
        /// The gain along the axis.
        gain: f64,
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

    /// A gain of readings in SI is off by more than sensors are, and nothing states it. A mount that gives way, a log that is
    /// filled in, or a wrong length makes such gains.
    GainUnusual "gain-unusual" Warning {
        sensor_kind: SensorKind,
        axis: Axis,
        /// The gain along the axis.
        gain: f64,
    }
    decided "The value itself is below 0.96 or above 1.04, whatever its standard deviation, and neither the datasheet nor [known] \
        allows for it."
    remedy "Check the mount, the log and the unit. If the sensor's type has such gains, state the gain in [known]; for a commanded motion, \
        scale_sd in [sensor]."
    says format!(
        "the gain of the {sensor_kind}'s axis {axis} is {gain:.3}: sensors are off by 1 to 3 %, and nothing states more of this one. \
         Check that the sensor is fastened to what moves it, that the log is measured throughout, and the unit. If its type has such \
         gains, state the gain in [known]; for a commanded motion, scale_sd in [sensor]."
    );

    /// A scale factor is negative.
    ScaleNegative "scale-negative" Error {
        axis: Axis,
    }
    decided "The estimate is below zero."
    remedy "Check the direction of the axis."
    says format!("the scale factor of axis {axis} is negative. Is the axis reversed?");

    /// The recording determines a parameter less well than the datasheet.
    WeakerThanDatasheet "weaker-than-datasheet" Warning {
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
        parameter: String,
        /// Its value in `[known]`.
        given: f64,
        /// What the recording alone gives.
        found: f64,
        /// Its standard deviation.
        found_sd: f64,
    }
    decided "The difference exceeds 6 standard deviations of the fit without the given values."
    remedy "Correct the value or its unit, or remove it."
    says format!(
        "{}. Correct the value or its unit, or remove it.",
        contradiction(parameter, *given, *found, *found_sd)
    );
}

impl KnownContradicted {
    /// The finding alone, without what to do.
    #[must_use]
    pub fn finding(&self) -> String {
        contradiction(&self.parameter, self.given, self.found, self.found_sd)
    }
}

fn contradiction(parameter: &str, given: f64, found: f64, found_sd: f64) -> String {
    format!(
        "the recording contradicts {parameter} in [known]: the given value is {given:?}, but the recording alone gives {found:.5} ± {found_sd:.1e}"
    )
}
