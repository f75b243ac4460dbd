//! What the mounting does to the variances of the sensor's matrices.
//!
//! With the mounting turned by `δ` the matrix is `S exp(δ)`, whose first order is `S [δ]×` and whose second order is `½ S [δ]×² = ½ S (δ δᵀ − |δ|² I)`. A diagonal
//! entry has cross terms times `δ`, and minus half the square of `δ` across: 1e-4 where the mounting is known to 0.5°. With `δ` of covariance `M`, and `δᵀ Q δ` such a change
//! of an entry, the mean square of second order is `E (δᵀ Q δ)² = (tr Q M)² + 2 tr (Q M)²`.
//!
//! A calibration stands at the matrix that it finds. Its cross terms have the turn that is not known in them, beside the sensor's own: `C + [δ]×`. So first order at them is
//! in the mean already all of the error, and the sum of both would count the square of `δ` twice: 1.4 times the error of a sensor without cross terms. But where the turn
//! happens to cancel them, nothing is left of first order, and the error is that of second order. So the larger of both counts.

use crate::estimate::problem::Layout;
use crate::estimate::{MachineParameters, MachineQuantity};
use calibrant_core::sensor::{Axis, ImuQuantity};
use nalgebra::{DMatrix, Matrix3, Vector3};

/// The part of a quantity's variance that comes from the mounting.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MountVariance {
    /// Of first order: it is a part of the covariance.
    pub first: f64,
    /// Of second order.
    pub second: f64,
}

impl MountVariance {
    /// What second order has beyond the first.
    #[must_use]
    pub fn beyond(self) -> f64 {
        (self.second - self.first).max(0.0)
    }
}

/// Of each quantity; 0 where the mounting is not estimated. `covariance` is that of the quantities.
#[must_use]
pub fn mount_variances(
    layout: &Layout,
    parameters: &MachineParameters,
    covariance: &DMatrix<f64>,
) -> Vec<MountVariance> {
    let place = |quantity| layout.quantities.iter().position(|of| *of == quantity);
    let [Some(x), Some(y), Some(z)] = Axis::ALL.map(|axis| place(MachineQuantity::Mounting(axis))) else {
        return vec![MountVariance::default(); layout.quantities.len()];
    };
    let places = [x, y, z];
    let of_turn = Matrix3::from_fn(|i, j| covariance[(places[i], places[j])]);
    let inverse = of_turn.try_inverse().unwrap_or_default();
    let of = |(k, quantity): (usize, &MachineQuantity)| {
        let Some(form) = form(*quantity, parameters) else { return MountVariance::default() };
        let (with_turn, form) = (Vector3::from_fn(|i, _| covariance[(k, places[i])]), form * of_turn);
        MountVariance {
            first: with_turn.dot(&(inverse * with_turn)).max(0.0),
            second: form.trace().powi(2) + 2.0 * (form * form).trace(),
        }
    };
    layout.quantities.iter().enumerate().map(of).collect()
}

/// `Q` of an entry of a matrix; `None` for other quantities.
fn form(quantity: MachineQuantity, parameters: &MachineParameters) -> Option<Matrix3<f64>> {
    let MachineQuantity::Imu(ImuQuantity::Of(sensor, of)) = quantity else { return None };
    let (row, column) = of.entry()?;
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
    use calibrant_core::sensor::{ImuParameters, ParameterList, Quantity, SensorKind, SensorModel};
    use nalgebra::UnitQuaternion;

    /// A full accelerometer on a mount that is known to `sd`.
    fn mounted(imu: ImuParameters, sd: f64) -> (Layout, MachineParameters) {
        let setup = MachineSetup { mounting: MountingPrior::Within(sd), ..MachineSetup::default() };
        let parameters = MachineParameters::nominal(&setup, imu, 0);
        let list = ParameterList::new(3, SensorModel::Full);
        let quantities: Vec<ImuQuantity> =
            list.quantities().iter().map(|of| ImuQuantity::Of(SensorKind::Accelerometer, *of)).collect();
        (Layout::new(&setup, &[SensorKind::Accelerometer], &quantities, parameters.clone()), parameters)
    }

    fn place(layout: &Layout, row: usize, column: usize) -> usize {
        let of = |quantity: &MachineQuantity| match quantity {
            MachineQuantity::Imu(ImuQuantity::Of(_, Quantity::Scale(axis))) => {
                row == column && axis.index() == row
            }
            MachineQuantity::Imu(ImuQuantity::Of(_, Quantity::CrossAxis(r, c))) => {
                r.index() == row && c.index() == column
            }
            _ => false,
        };
        layout.quantities.iter().position(of).expect("estimated")
    }

    /// A normal vector, about: sums of twelve numbers that are uniform on ±√3.
    fn drawn(numbers: &mut Numbers, sd: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| {
            sd * (0..12).map(|_| numbers.next(3.0_f64.sqrt())).sum::<f64>() / 12.0_f64.sqrt()
        })
    }

    #[test]
    fn second_order_is_that_of_many_turns() {
        let sd = 0.02;
        let mut imu = ImuParameters::identity();
        imu[SensorKind::Accelerometer].matrix =
            Matrix3::new(1.0, 0.02, -0.03, 0.01, 1.1, 0.0, 0.04, 0.0, 0.9);
        let (layout, parameters) = mounted(imu, sd);
        let covariance = DMatrix::identity(layout.len(), layout.len()) * (sd * sd);
        let found = mount_variances(&layout, &parameters, &covariance);
        let (turns, mut numbers) = (40_000, Numbers(3));
        let mut sums = Matrix3::zeros();
        for _ in 0..turns {
            let turn = drawn(&mut numbers, sd);
            let exact = UnitQuaternion::from_scaled_axis(turn).to_rotation_matrix().into_inner();
            let second =
                imu[SensorKind::Accelerometer].matrix * (exact - Matrix3::identity() - turn.cross_matrix());
            sums += second.component_mul(&second) / f64::from(turns);
        }
        for (row, column) in [(0, 0), (1, 1), (2, 2), (0, 1), (2, 0)] {
            let ratio = sums[(row, column)] / found[place(&layout, row, column)].second;
            assert!((ratio - 1.0).abs() < 0.06, "{row} {column}: {ratio}");
        }
    }

    /// In the mean over sensors, what is stated is the error; beside cross terms of no sensor it is less than 1.2 times that. The sum of both orders states 1.2 and 1.41 times.
    #[test]
    fn what_is_stated_at_the_matrix_that_is_found_is_the_error() {
        let sd = 0.5_f64.to_radians();
        for (own_sd, least, most) in [(0.03, 0.98, 1.03), (0.01, 1.0, 1.07), (0.0, 1.14, 1.2)] {
            let (sensors, mut numbers) = (20_000, Numbers(5));
            let (mut stated, mut realised, mut beyond) = (0.0, 0.0, 0);
            for _ in 0..sensors {
                let own = Matrix3::from_fn(|_, _| drawn(&mut numbers, own_sd).x);
                let turn = UnitQuaternion::from_scaled_axis(drawn(&mut numbers, sd)).to_rotation_matrix();
                let mut imu = ImuParameters::identity();
                let truth = imu[SensorKind::Accelerometer].matrix + own;
                imu[SensorKind::Accelerometer].matrix = truth * turn.into_inner();
                let (layout, parameters) = mounted(imu, sd);
                let k = place(&layout, 0, 0);
                // data tell the matrix on the mounting as it is, and nothing of the mounting
                let mut with_turn = DMatrix::zeros(layout.len(), 3);
                for (j, axis) in Axis::ALL.into_iter().enumerate() {
                    let mounting = MachineQuantity::Mounting(axis);
                    let of = layout.quantities.iter().position(|of| *of == mounting).expect("estimated");
                    with_turn[(of, j)] = sd;
                    let moved = imu[SensorKind::Accelerometer].matrix * Vector3::ith(j, sd).cross_matrix();
                    with_turn[(k, j)] = -moved[(0, 0)];
                }
                let covariance = &with_turn * with_turn.transpose();
                let variance =
                    covariance[(k, k)] + mount_variances(&layout, &parameters, &covariance)[k].beyond();
                let error = imu[SensorKind::Accelerometer].matrix[(0, 0)] - truth[(0, 0)];
                stated += variance;
                realised += error * error;
                beyond += usize::from(error * error > 16.0 * variance);
            }
            let ratio = (stated / realised).sqrt();
            assert!((least..most).contains(&ratio), "{own_sd}: {ratio}");
            // of normal errors 1 in 16 000 are beyond four standard deviations; first order alone has some 150
            assert!(beyond < 60, "{own_sd}: {beyond} beyond four standard deviations");
        }
    }
}
