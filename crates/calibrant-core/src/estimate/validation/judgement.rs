//! All errors of a validation, judged kind by kind.

use super::claim::Claim;
use super::doubt::Doubts;
use super::item::Group;
use super::predict::Errors;
use super::result::{Validation, ValidationSource};
use super::statistics::{Behind, Degrees, judge};
use super::unused_error::ErrorKind;

/// The errors of one or more claims, those of the last of which tells how much is behind the scatter that was estimated.
pub(super) fn judged(
    source: ValidationSource,
    errors: Vec<Errors>,
    claim: &Claim,
    doubts: &Doubts,
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
    let folds = matches!(source, ValidationSource::Folds { .. });
    let behind = |of: &[Degrees]| Behind { scatter_degrees: of.to_vec(), folds, free_shift: false, doubts };
    let of_rates =
        Behind { free_shift: bias_shift.is_some_and(|shift| shift.moved), ..behind(&claim.still_degrees) };
    let kinds = [
        judge(ErrorKind::Magnitude, &magnitudes, &behind(&[claim.holds_degrees])),
        judge(ErrorKind::Rate, &rates, &of_rates),
        judge(ErrorKind::Rotation, &rotations, &behind(&[claim.rotation_degrees])),
    ];
    Validation {
        source,
        kinds: kinds.into_iter().flatten().collect(),
        bias_shift,
        noise,
        reasons: Vec::new(),
    }
}
