//! Remarks on a comparison of two calibrations, A and B.

use super::check::checks;
use super::parts::{Phrase, neither};
use crate::number_format::probability;
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

    /// A calibration that did not converge is kept in the records, but no change and no aging is made of it.
    RecordUnused "record-unused" Warning {
        /// How its estimation ended.
        status: String,
    }
    decided "Its status is not `converged`."
    remedy "Read its report, calibrate the recording again, and remove this one from the records."
    says format!("it did not converge ({status}): it is kept, but no change and no aging is made of it");

    /// Two calibrations state the same uncertainty of their place, such as that of its gravity, and nobody says whether it is one place. At one place
    /// both have the same error, and it hides no change. Their difference counts as that of two places.
    PlaceUnknown "place-unknown" Note {
        /// What is not exactly known of the place: `gravity 9.80665 ± 0.019 m/s²`.
        sources: Vec<String>,
        /// Probability of a larger difference at two places if nothing changed.
        p_value: f64,
        /// The same at one place.
        p_value_at_one: f64,
    }
    decided "The sources of error that both share are looked at, and the names of the stations."
    remedy "State gravity (`gravity_mps2` with its uncertainty, or `latitude_deg`). Or say that the place is one: \
        name the station of both, or compare them as of one place."
    says format!(
        "nobody says whether both were made at one place, where {} is one error of both. p is {} at two places, which is what counts here, and {} \
         at one: name the station, or state gravity",
        named(sources),
        probability(*p_value),
        probability(*p_value_at_one)
    );
}

/// The first of these sources, and how many more there are.
fn named(sources: &[String]) -> String {
    match sources {
        [] => String::new(),
        [one] => one.clone(),
        [first, others @ ..] => format!("{first} (and {} more)", others.len()),
    }
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
