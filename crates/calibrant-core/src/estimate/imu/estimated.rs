//! The estimated quantities of an IMU, and their priors.

use crate::estimate::imu::known_term::KnownTerm;
use crate::estimate::imu::model::Prior;
use crate::estimate::imu::problem::{ImuProblem, ImuSetup};
use crate::sensor::{ImuParameters, ImuQuantity, SensorKind, Thermal};

/// The quantities that are estimated: all but the fixed ones.
pub(crate) fn estimated_quantities(problem: &ImuProblem<'_>) -> Vec<ImuQuantity> {
    let setup = problem.setup;
    let mut quantities = setup.quantities(problem.accelerometer.model, problem.gyroscope);
    let fixed = |quantity: &ImuQuantity| {
        setup.known_terms().any(|known| known.quantity == *quantity && known.sd.is_none())
    };
    quantities.retain(|quantity| !fixed(quantity));
    quantities
}

/// The priors of the estimated quantities: mean and inverse variance.
pub(crate) fn prior_of(problem: &ImuProblem<'_>, quantities: &[ImuQuantity]) -> Option<Prior> {
    let of = |quantity: &ImuQuantity| problem.setup.known_terms().find(|known| known.quantity == *quantity);
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

/// The temperature terms as others say them; `fixed`: the fixed ones alone.
pub(crate) fn expected_terms(setup: &ImuSetup, fixed: Thermal) -> Thermal {
    let mut imu = ImuParameters { thermal: fixed, ..ImuParameters::identity() };
    set(&mut imu, setup.usual.iter().filter(|usual| matches!(usual.quantity, ImuQuantity::Thermal(..))));
    imu.thermal
}

/// Sets the parameters of the gyroscope that other recordings tell: the rotations of this one need not.
pub(crate) fn set_usual(imu: &mut ImuParameters, setup: &ImuSetup) {
    let of_gyroscope =
        |usual: &&KnownTerm| matches!(usual.quantity, ImuQuantity::Of(SensorKind::Gyroscope, _));
    set(imu, setup.usual.iter().filter(of_gyroscope));
}

/// Sets the fixed quantities.
pub(crate) fn set_fixed(imu: &mut ImuParameters, setup: &ImuSetup) {
    set(imu, setup.known_terms().filter(|known| known.sd.is_none()));
}

fn set<'k>(imu: &mut ImuParameters, terms: impl Iterator<Item = &'k KnownTerm>) {
    for term in terms {
        let now = term.quantity.value(imu);
        term.quantity.add_to(imu, term.value - now);
    }
}
