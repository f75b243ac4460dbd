//! What the mounting does to the sensor's matrices beyond first order.
//!
//! With the mounting turned by `δ` the matrix is `S exp(δ)`, whose second order is `½ S [δ]×² = ½ S (δ δᵀ − |δ|² I)`. A diagonal entry hardly changes to
//! first order, so this is what is left of it: 1e-4 where the mounting is known to 0.5°. With `δ` of covariance `M`, and `δᵀ Q δ` such a change of an entry:
//!
//! ```text
//! E[δᵀ Q₁ δ · δᵀ Q₂ δ] = tr(Q₁ M) tr(Q₂ M) + 2 tr(Q₁ M Q₂ M)
//! ```

use crate::estimate::problem::layout::Layout;
use crate::estimate::problem::parameters::AXES;
use crate::estimate::{MachineParameters, MachineQuantity};
use calibrant_core::sensor::{ImuQuantity, Quantity};
use nalgebra::{DMatrix, Matrix3, Vector3};

/// The mean products of these changes, for all quantities; 0 where the mounting is not estimated. `covariance` is that of the quantities.
pub(crate) fn of_mounting(
    layout: &Layout,
    parameters: &MachineParameters,
    covariance: &DMatrix<f64>,
) -> DMatrix<f64> {
    let n = layout.len();
    let mut products = DMatrix::zeros(n, n);
    let place = |quantity| layout.quantities.iter().position(|of| *of == quantity);
    let [Some(x), Some(y), Some(z)] = AXES.map(|axis| place(MachineQuantity::Mounting(axis))) else {
        return products;
    };
    let places = [x, y, z];
    let of_turn = Matrix3::from_fn(|i, j| covariance[(places[i], places[j])]);
    let forms: Vec<(usize, Matrix3<f64>)> = (layout.quantities.iter().enumerate())
        .filter_map(|(place, quantity)| Some((place, form(*quantity, parameters)? * of_turn)))
        .collect();
    for (i, one) in &forms {
        for (j, other) in &forms {
            products[(*i, *j)] = one.trace() * other.trace() + 2.0 * (one * other).trace();
        }
    }
    products
}

/// `Q` of an entry of a matrix; `None` for other quantities.
fn form(quantity: MachineQuantity, parameters: &MachineParameters) -> Option<Matrix3<f64>> {
    let MachineQuantity::Imu(ImuQuantity::Of(sensor, of)) = quantity else { return None };
    let (row, column) = match of {
        Quantity::Scale(axis) => (axis, axis),
        Quantity::CrossAxis(row, column) | Quantity::Symmetric(row, column) => (row, column),
        Quantity::Bias(_) => return None,
    };
    let matrix = &parameters.imu.sensor(sensor).matrix;
    let mut along = Vector3::zeros();
    along[column.index()] = 1.0;
    let product = matrix.row(row.index()).transpose() * along.transpose();
    let symmetric = (product + product.transpose()) * 0.5;
    Some((symmetric - Matrix3::identity() * matrix[(row.index(), column.index())]) * 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::chains_for_tests::Numbers;
    use crate::estimate::{MachineSetup, MountingPrior};
    use calibrant_core::sensor::{ImuParameters, ParameterList, SensorKind, SensorModel};
    use nalgebra::UnitQuaternion;

    #[test]
    fn the_products_are_those_of_many_turns() {
        let sd = 0.02;
        let setup = MachineSetup { mounting: MountingPrior::Within(sd), ..MachineSetup::default() };
        let mut imu = ImuParameters::identity();
        imu.accelerometer.matrix = Matrix3::new(1.0, 0.02, -0.03, 0.01, 1.1, 0.0, 0.04, 0.0, 0.9);
        let parameters = MachineParameters::nominal(&setup, imu, 0);
        let list = ParameterList::new(3, SensorModel::Full);
        let quantities: Vec<ImuQuantity> =
            list.quantities().iter().map(|of| ImuQuantity::Of(SensorKind::Accelerometer, *of)).collect();
        let layout = Layout::new(&setup, &[SensorKind::Accelerometer], &quantities, parameters.clone());
        let covariance = DMatrix::identity(layout.len(), layout.len()) * (sd * sd);
        let products = of_mounting(&layout, &parameters, &covariance);
        let at = |row: usize, column: usize| {
            let of = |quantity: &MachineQuantity| {
                form(*quantity, &parameters).is_some()
                    && matches!(quantity, MachineQuantity::Imu(ImuQuantity::Of(_, of)) if match of {
                        Quantity::Scale(axis) => row == column && axis.index() == row,
                        Quantity::CrossAxis(r, c) => r.index() == row && c.index() == column,
                        _ => false,
                    })
            };
            layout.quantities.iter().position(of).expect("estimated")
        };
        let (turns, mut numbers) = (40_000, Numbers(3));
        let mut sums = Matrix3::zeros();
        // the variance of a number that is uniform in ±√3 is 1; its fourth moment is 1.8 instead of 3, so sums of twelve stand for normal ones
        for _ in 0..turns {
            let turn = Vector3::from_fn(|_, _| {
                sd * (0..12).map(|_| numbers.next(3.0_f64.sqrt())).sum::<f64>() / 12.0_f64.sqrt()
            });
            let exact = UnitQuaternion::from_scaled_axis(turn).to_rotation_matrix().into_inner();
            let second = imu.accelerometer.matrix * (exact - Matrix3::identity() - turn.cross_matrix());
            sums += second.component_mul(&second) / f64::from(turns);
        }
        for (row, column) in [(0, 0), (1, 1), (2, 2), (0, 1), (2, 0)] {
            let place = at(row, column);
            let ratio = sums[(row, column)] / products[(place, place)];
            assert!((ratio - 1.0).abs() < 0.06, "{row} {column}: {ratio}");
        }
    }
}
