//! Sentences about what makes a result bad or doubtful: noise, model, validation and limits.

use crate::number_format::significant;
use calibrant_core::diagnostic::Diagnostic;

pub(super) fn message(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::NoiseImplausible { sensor_kind, axis, ratio } => format!(
            "the noise of the {sensor_kind} is {} times the given noise (axis {axis}). Check the sensor and the unit of the recording, or correct the noise in the experiment file.",
            significant(*ratio, 3)
        ),
        Diagnostic::ModelContradicted { sensor_kind, ratio } => format!(
            "the residuals of the {sensor_kind} are {} times as large as they may be, and systematic. The sensor did not do what the model says. \
             Check the motion, the clocks, and the order and direction of the axes.",
            significant(*ratio, 3)
        ),
        Diagnostic::ValidationDoubts { what, factor } => format!(
            "the validation doubts the covariance: {what} are {} times as large as predicted. Read the validation.",
            significant(*factor, 3)
        ),
        Diagnostic::LimitBroken { limit } => format!("{limit}: it is broken."),
        Diagnostic::LimitTooClose { limit } => {
            format!(
                "{limit}: they are too close to decide. Record more, so that the standard deviation becomes smaller."
            )
        }
        Diagnostic::LimitNotChecked { name } => {
            format!("the limit of {name} is not checked: the result does not have this value.")
        }
        _ => return None,
    })
}
