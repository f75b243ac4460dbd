//! Validation on another recording: two calibrations of one sensor on one machine.
//!
//! What is wrong with mount and joints is wrong in both. With `I` the information of that prior, their errors `Σ₁ I (η̄ − η)` and `Σ₂ I (η̄ − η)` belong
//! together, and the covariance of the difference is `Σ₁ + Σ₂ − Σ₁ I Σ₂ − Σ₂ I Σ₁`.

use crate::estimate::validation::machine_validation::{MachineValidation, MachineValidationSource};
use crate::estimate::validation::shift::{Movement, judged, widened};
use crate::estimate::{MachineCalibration, MachineQuantity, MachineSetup};
use nalgebra::{DMatrix, DVector};

/// Compares how far the parameters of `second` are from those of `first` with what both covariances predict. Both are of the same setup. Delays, clock
/// and tilt belong to each recording; mount and joints to both.
///
/// The validation is empty where the two calibrations do not have the same quantities.
#[must_use]
pub fn compare_on_machine(
    first: &MachineCalibration,
    second: &MachineCalibration,
    setup: &MachineSetup,
) -> MachineValidation {
    let source = MachineValidationSource::Recording { name: String::new() };
    if first.quantities != second.quantities {
        return MachineValidation { source, shifts: Vec::new() };
    }
    let sensors = first.sensors();
    let information = |quantity: &MachineQuantity| {
        let sd = setup.prior_sd(*quantity, sensors.len());
        let shared = matches!(
            quantity,
            MachineQuantity::Lever(_)
                | MachineQuantity::Mounting(_)
                | MachineQuantity::Zero(_)
                | MachineQuantity::Geometry(..)
        );
        if shared && sd.is_finite() { 1.0 / (sd * sd) } else { 0.0 }
    };
    let n = first.quantities.len();
    let shared = DMatrix::from_diagonal(&DVector::from_iterator(n, first.quantities.iter().map(information)));
    let common = &first.linear_covariance * shared * &second.linear_covariance;
    let [one, two] = [first, second].map(|of| widened(of, &of.linear_covariance));
    let covariance = one + two - &common - common.transpose();
    let shift = second.values.iter().zip(&first.values).map(|(two, one)| two - one);
    let movement = [Movement { shift: DVector::from_iterator(n, shift), covariance, without_s: None }];
    let shifts = sensors.iter().filter_map(|sensor| judged(first, *sensor, &movement)).collect();
    MachineValidation { source, shifts }
}
