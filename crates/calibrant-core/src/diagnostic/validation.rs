//! Checks of a validation.

use super::check::checks;
use super::parts::Phrase;
use crate::number_format::significant;

checks! {
    /// The errors on data that were not used are larger than predicted.
    ValidationDoubts "validation-doubts" Warning {
        /// What the errors are of.
        what: String,
        /// Errors over prediction.
        factor: f64,
    }
    decided "A validation finds the covariance too small: the 99 % interval of the factor lies above 1, and the \
        factor above 1.25."
    remedy "Read the validation in the report. Multiply the standard deviations by the factor that it names, or \
        find the cause."
    says format!(
        "the validation doubts the covariance: {what} are {} times as large as predicted. Read the validation.",
        significant(*factor, 3)
    );

    /// The calibration is not validated by folds.
    FoldsImpossible "folds-impossible" Warning {
        /// Why.
        why: Phrase,
    }
    decided "Without one of the blocks, the recording does not determine the parameters."
    remedy "Ask for fewer folds, or record more."
    says format!("not validated by folds: {}", why.0);
}
