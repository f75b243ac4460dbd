//! All errors of a validation, judged kind by kind.

use super::caveats_of_calibration::Caveats;
use super::predicted_error::Group;
use super::prediction::Prediction;
use super::prediction_errors::Errors;
use super::result::{Validation, ValidationSource};
use super::statistics::{Degrees, ErrorContext, Fitted, judge};
use super::unused_error::ErrorKind;

/// The errors of one or more claims, those of the last of which tells how much is behind the scatter that was estimated. `drift_degrees`: of a drift that was taken out of all holds.
pub(super) fn judged(
    source: ValidationSource,
    errors: Vec<Errors>,
    prediction: &Prediction,
    drift_degrees: f64,
    caveats: &Caveats,
) -> Validation {
    let (bias_shift, noise) = match errors.as_slice() {
        [one] => (one.shift, one.noise.clone()),
        _ => (None, Vec::new()),
    };
    let (mut magnitudes, mut rates, mut rotations): (Vec<Group>, Vec<Group>, Vec<Group>) = Default::default();
    for errors in errors {
        magnitudes.push(errors.magnitudes);
        rates.push(errors.rates);
        rotations.push(errors.rotations);
    }
    let has_errors = |groups: &&[Group]| groups.iter().any(|group| !group.items.is_empty());
    let together = [&magnitudes[..], &rates, &rotations].iter().filter(|of| has_errors(of)).count();
    let folds = matches!(source, ValidationSource::Folds { .. });
    let behind = |of: &[Degrees], taken: f64| {
        let fitted = Fitted { unknowns: of.iter().map(|degrees| degrees.unknowns).sum(), taken };
        ErrorContext {
            scatter_degrees: of.to_vec(),
            folds: folds.then_some(fitted),
            together,
            free_shift: false,
            caveats,
        }
    };
    let of_rates = ErrorContext {
        free_shift: bias_shift.is_some_and(|shift| shift.moved),
        ..behind(&prediction.still_degrees, 0.0)
    };
    let kinds = [
        judge(ErrorKind::Magnitude, &magnitudes, &behind(&[prediction.holds_degrees], drift_degrees)),
        judge(ErrorKind::Rate, &rates, &of_rates),
        judge(ErrorKind::Rotation, &rotations, &behind(&[prediction.rotation_degrees], 0.0)),
    ];
    Validation {
        source,
        kinds: kinds.into_iter().flatten().collect(),
        bias_shift,
        noise,
        likely_explanations: Vec::new(),
    }
}
