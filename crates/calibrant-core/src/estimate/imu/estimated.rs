//! The estimated quantities of an IMU, and their priors.

use crate::estimate::imu::known_term::KnownTerm;
use crate::estimate::imu::model::Prior;
use crate::estimate::imu::problem::ImuProblem;
use crate::sensor::{ImuParameters, ImuQuantity};

/// The quantities that are estimated: all but the fixed ones.
pub(crate) fn estimated_quantities(problem: &ImuProblem<'_>) -> Vec<ImuQuantity> {
    let setup = problem.setup;
    let mut quantities = setup.quantities(problem.accelerometer.model, problem.gyroscope);
    let fixed = |quantity: &ImuQuantity| {
        setup.known.iter().any(|known| known.quantity == *quantity && known.sd.is_none())
    };
    quantities.retain(|quantity| !fixed(quantity));
    quantities
}

/// The priors of the estimated quantities: mean and inverse variance.
pub(crate) fn prior_of(problem: &ImuProblem<'_>, quantities: &[ImuQuantity]) -> Option<Prior> {
    let of = |quantity: &ImuQuantity| problem.setup.known.iter().find(|known| known.quantity == *quantity);
    if quantities.iter().all(|quantity| of(quantity).is_none()) {
        return None;
    }
    Some(
        quantities
            .iter()
            .map(|quantity| {
                of(quantity).map_or((0.0, 0.0), |known| (known.value, known.sd.map_or(0.0, |sd| sd.powi(-2))))
            })
            .unzip(),
    )
}

/// Sets the fixed quantities.
pub(crate) fn set_fixed(imu: &mut ImuParameters, known: &[KnownTerm]) {
    for known in known.iter().filter(|known| known.sd.is_none()) {
        let now = known.quantity.value(imu);
        known.quantity.add_to(imu, known.value - now);
    }
}
