//! Remarks on a comparison of two calibrations, A and B.

use super::check::checks;
use super::parts::{Phrase, neither};
use crate::sensor::{ReadingUnit, SensorKind};

checks! {
    /// Two calibrations are of readings in different units. Biases and gains are not compared.
    UnitsApart "units-apart" Note {
        sensor_kind: SensorKind,
        /// Unit of the readings in A.
        unit_a: ReadingUnit,
        /// Unit of the readings in B.
        unit_b: ReadingUnit,
    }
    decided "The units of the readings are compared."
    remedy "Compare calibrations of readings in one unit."
    says format!(
        "the readings of the {sensor_kind} are in {} in A and in {} in B: its biases and gains cannot be compared",
        unit_a.symbol(),
        unit_b.symbol()
    );

    /// One of two calibrations lacks a sensor, or its biases. They are not compared.
    NotInBoth "not-in-both" Note {
        /// The calibration that lacks it: `A` or `B`.
        lacking: &'static str,
        sensor_kind: SensorKind,
        /// Does it lack only the biases?
        has_gains: bool,
    }
    decided "The quantities of both are compared."
    says match has_gains {
        true => format!("{lacking} does not say the biases of the {sensor_kind}: they are not compared"),
        false => format!("{lacking} has no {sensor_kind}: it is not compared"),
    };

    /// Calibrations that follow temperature are compared at one.
    ComparedAtTemperature "compared-at-temperature" Note {
        /// The only one that follows temperature: `A` or `B`.
        only: Option<&'static str>,
        /// The temperature, °C.
        temperature_c: f64,
    }
    decided "A calibration has temperature terms."
    says match only {
        None => format!("both are compared as they are at {temperature_c} °C"),
        Some(only) => {
            format!("only {only} follows temperature: it is compared as it is at its reference of {temperature_c} °C")
        }
    };

    /// Two calibrations cannot be brought to one temperature, or into one frame.
    NotBroughtTogether "not-brought-together" Note {
        /// To what: `to one temperature`.
        to: &'static str,
        /// Why not.
        why: Phrase,
    }
    decided "The conversion ends with an error."
    remedy "Read the error."
    says format!("the two cannot be brought {to}: {}", why.0);

    /// The significance of a comparison rests on a covariance that is not there, or whose own uncertainty is not known.
    SignificanceUncertain "significance-uncertain" Note {
        /// The calibration: `A` or `B`; `None` of both.
        of: Option<&'static str>,
        /// What is not known of it.
        unknown: UnknownUncertainty,
    }
    decided "The covariances and their degrees of freedom are looked at."
    remedy "Compare calibrations with a covariance, of more holds than unknowns."
    says match (of, unknown) {
        (None, _) => "neither has a covariance: how significant the differences are is not known".to_owned(),
        (Some(of), UnknownUncertainty::Covariance) => format!("{of} has no covariance: its values count as exact"),
        (Some(of), UnknownUncertainty::Degrees) => {
            format!("{of} does not say the degrees of freedom behind its sd: they count as known")
        }
        (Some(of), UnknownUncertainty::Scatter) => format!(
            "{of} has no more holds than unknowns: nothing shows whether the sd of its accelerometer are right, and they \
             count as known"
        ),
    };

    /// The significance of a comparison supposes different recordings.
    RecordingsSupposed "recordings-supposed" Note {}
    decided "Both have a covariance."
    remedy "Nothing, where the recordings are different."
    says "significance supposes different recordings; two calibrations of the same one differ by less";
}

/// What is not known of the uncertainty of a calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnknownUncertainty {
    /// Its covariance.
    Covariance,
    /// The degrees of freedom behind it.
    Degrees,
    /// The scatter of its holds, which are as many as the unknowns.
    Scatter,
}

neither!(UnknownUncertainty);
