//! What the motion does not determine, with the motion that would.

use crate::estimate::MachineQuantity;
use crate::estimate::least_squares::{Model, Pass, State};
use calibrant_core::error::{Error, NotIdentifiable, UndeterminedGroup};
use calibrant_core::sensor::{Axis, ImuQuantity, SensorKind};
use nalgebra::{DMatrix, Matrix3, SymmetricEigen, Vector3};

/// Information below this part of that of a well determined combination is rounding.
const RELATIVE: f64 = 1e-10;
/// Number of samples of each sensor that are looked at.
const SAMPLES: usize = 5000;
/// Parameters with at least this part of an undetermined combination are named.
const SHARE: f64 = 0.1;
/// A rate below this is no rotation, rad/s; a change of specific force below ten times this is no change, m/s².
const STILL: f64 = 0.02;

/// Is every combination determined by the data or by what is known beforehand?
pub(crate) fn check(model: &Model<'_>, state: &State) -> Result<(), Error> {
    let equations = model.equations(state, Pass::trusting(SAMPLES));
    let Some(information) = equations.front.information() else { return Ok(()) };
    let free = free_combinations(&information);
    if free.number == 0 {
        return Ok(());
    }
    let named: Vec<MachineQuantity> =
        free.places.iter().map(|place| model.layout.quantities[*place]).collect();
    let (reason, remedy) = reason(model, state, &named);
    let joints = model.joint_names();
    Err(Error::NotIdentifiable(Box::new(NotIdentifiable {
        groups: vec![UndeterminedGroup {
            parameters: named.iter().map(|quantity| quantity.name(&joints)).collect(),
            free_combinations: free.number,
            reason,
            remedy,
        }],
    })))
}

/// Combinations without information: their number, and the parameters in them.
struct Free {
    number: usize,
    places: Vec<usize>,
}

fn free_combinations(information: &DMatrix<f64>) -> Free {
    let n = information.nrows();
    let largest = information.diagonal().max();
    // a parameter without any information is alone; the others are scaled to one
    let (felt, unfelt): (Vec<usize>, Vec<usize>) =
        (0..n).partition(|k| information[(*k, *k)] > f64::MIN_POSITIVE.max(1e-30 * largest));
    let scale: Vec<f64> = felt.iter().map(|k| information[(*k, *k)].sqrt().recip()).collect();
    let scaled = DMatrix::from_fn(felt.len(), felt.len(), |i, j| {
        information[(felt[i], felt[j])] * scale[i] * scale[j]
    });
    if felt.is_empty() {
        return Free { number: n, places: unfelt };
    }
    let SymmetricEigen { eigenvalues, eigenvectors } = scaled.symmetric_eigen();
    let without: Vec<usize> = (0..felt.len()).filter(|k| eigenvalues[*k] < RELATIVE).collect();
    let weight = |row: usize| without.iter().map(|k| eigenvectors[(row, *k)].powi(2)).sum::<f64>();
    let mut places: Vec<usize> =
        (0..felt.len()).filter(|row| weight(*row) > SHARE * SHARE).map(|row| felt[row]).collect();
    places.extend(&unfelt);
    places.sort_unstable();
    Free { number: without.len() + unfelt.len(), places }
}

/// How much force and rate change along each axis of the sensor.
fn excitation(model: &Model<'_>, state: &State) -> (Matrix3<f64>, Vector3<f64>) {
    let (knots, carrier) = (state.motion.knots(), model.carrier(state));
    let mut joints = Default::default();
    let count = knots.intervals.min(5000);
    let (mut sum, mut squares, mut rates) = (Vector3::zeros(), Matrix3::zeros(), Vector3::zeros());
    for k in 0..count {
        let time = knots.start_s + (knots.end_s() - knots.start_s) * (k as f64 + 0.5) / count as f64;
        let at = state.motion.sensor(&knots.weights(time), &carrier, &mut joints);
        sum += at.specific_force;
        squares += at.specific_force * at.specific_force.transpose();
        rates += at.rate.component_mul(&at.rate);
    }
    let n = count as f64;
    (squares / n - sum * sum.transpose() / (n * n), (rates / n).map(f64::sqrt))
}

fn reason(model: &Model<'_>, state: &State, named: &[MachineQuantity]) -> (String, String) {
    let (forces, rates) = excitation(model, state);
    let still =
        |of: &dyn Fn(Axis) -> bool| -> Vec<Axis> { Axis::ALL.into_iter().filter(|axis| of(*axis)).collect() };
    let words = |axes: &[Axis]| axes.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let no_rotation = still(&|axis| rates[axis.index()] < STILL);
    let no_change = still(&|axis| forces[(axis.index(), axis.index())].sqrt() < 10.0 * STILL);
    let of = |sensor: SensorKind| {
        named.iter().any(
            |quantity| matches!(quantity, MachineQuantity::Imu(ImuQuantity::Of(kind, _)) if *kind == sensor),
        )
    };
    let turns = of(SensorKind::Gyroscope)
        || named.iter().any(|quantity| matches!(quantity, MachineQuantity::Lever(_)));
    if turns && !no_rotation.is_empty() {
        let axes = words(&no_rotation);
        return (format!("no rotation about {axes} of the sensor"), format!("turn the sensor about {axes}"));
    }
    if of(SensorKind::Accelerometer) && !no_change.is_empty() {
        let axes = words(&no_change);
        return (
            format!("the specific force along {axes} of the sensor does not change"),
            format!(
                "turn {axes} up and down, accelerate along {axes}, or take the datasheet for what is not felt: prior = \"datasheet\" in [calibrate]"
            ),
        );
    }
    (
        "the motion changes these together".into(),
        "move about all axes and along all axes, or state what is known of the mount in [machine]".into(),
    )
}
