//! An accelerometer on known faces that no sensor is.

use crate::error::{Error, InputError, Refusal, Result};
use crate::sensor::{Axis, ReadingUnit};
use nalgebra::Matrix3;

/// Readings in SI may have these gains. A range that is not the one that was set makes half or twice of it.
const POSSIBLE_GAINS: std::ops::RangeInclusive<f64> = 0.4..=2.5;

/// Axes of a sensor are at right angles to a few degrees. Mistakes are far larger, rad.
const CROOKED_RAD: f64 = 0.5;

/// The standard acceleration of gravity, by which readings in g are multiplied, m/s².
const STANDARD_GRAVITY_MPS2: f64 = 9.806_65;

/// Refuses an accelerometer that no sensor is: of quite another gain in SI, or with axes far from right angles.
pub(crate) fn check(unit: ReadingUnit, matrix: &Matrix3<f64>) -> Result<()> {
    let gain = |axis: &Axis| matrix.row(axis.index()).norm();
    let is_absurd = |axis: &&Axis| unit != ReadingUnit::Counts && !POSSIBLE_GAINS.contains(&gain(axis));
    if let Some(axis) = Axis::ALL.iter().find(is_absurd) {
        let gain = gain(axis);
        let near = |factor: f64| (gain / factor - 1.0).abs() < 0.2;
        let help = if near(STANDARD_GRAVITY_MPS2) {
            "are the readings in m/s², and stated to be in g?"
        } else if near(1.0 / STANDARD_GRAVITY_MPS2) {
            "are the readings in g, and stated to be in m/s²?"
        } else {
            "are the unit of the accelerometer, holds.gravity_mps2 and the times of the holds right?"
        };
        let message = format!(
            "on the faces the accelerometer shows {gain:.3} times gravity along its axis {axis}; for readings in SI that should be near 1"
        );
        return Err(Error::recording(InputError::new(Refusal::UnitImplausible, message, help)));
    }
    for (one, other) in [(Axis::X, Axis::Y), (Axis::X, Axis::Z), (Axis::Y, Axis::Z)] {
        let between = matrix.row(one.index()).transpose().angle(&matrix.row(other.index()).transpose());
        if (between - std::f64::consts::FRAC_PI_2).abs() > CROOKED_RAD {
            let message = format!(
                "by these directions the accelerometer's axes {one} and {other} are at {:.0}° to each other",
                between.to_degrees()
            );
            let help = "correct the directions (the axis that is up in each hold) or the times of the holds";
            return Err(Error::experiment(InputError::new(Refusal::FacesContradicted, message, help)));
        }
    }
    Ok(())
}
