//! What a turn of the mount does with the scale and cross terms of a drawn sensor.
//!
//! # Formula
//! A turn `δ` of the mount changes a matrix `S = I + C` by `S [δ]×`. The part `[δ]×` is of first order at the nominal sensor, whose `C` is zero. A calibration stands at the
//! matrix that it finds, so that it states `C [δ]×` as well. What it finds differs from the nominal sensor by the sensor's own terms, of variance `c²`, and by the turn that
//! is not known, `[δ]×`. With the covariance `T` of `δ`, row `i` of a mean sensor has the products
//!
//! ```text
//! Σ_k (c²_ik + ([e_i]× T [e_i]×ᵀ)_kk) [e_k]× T [e_k]×ᵀ
//! ```
//!
//! Where this is less for a sensor than what is of second order in `δ`, the calibration states the latter. For a scale factor it is a sum of two squares, whose distribution is
//! exponential: with the mean `F`, and `s` of second order, the mean of what is missing is `s − F (1 − exp(−s/F))`.

use calibrant_core::sensor::{Axis, ImuQuantity, SensorKind};
use calibrant_machine::estimate::{Layout, MachineQuantity, MountVariance};
use nalgebra::{DMatrix, Matrix3, Vector3};

/// An entry of a matrix: sensor, row, column.
fn entry(quantity: MachineQuantity) -> Option<(SensorKind, usize, usize)> {
    let MachineQuantity::Imu(ImuQuantity::Of(kind, of)) = quantity else { return None };
    let (row, column) = of.entry()?;
    Some((kind, row.index(), column.index()))
}

/// The mean products of these changes over sensors, for all quantities; 0 where the mounting is not estimated. `covariance` is that of the quantities, `spread` the
/// standard deviation of the terms of accelerometer and gyroscope of which nothing is known beforehand.
pub(crate) fn of_turned_cross_terms(
    layout: &Layout,
    covariance: &DMatrix<f64>,
    spread: [f64; 2],
) -> DMatrix<f64> {
    let n = layout.quantities.len();
    let mut products = DMatrix::zeros(n, n);
    let place = |quantity| layout.quantities.iter().position(|of| *of == quantity);
    let [Some(x), Some(y), Some(z)] = Axis::ALL.map(|axis| place(MachineQuantity::Mounting(axis))) else {
        return products;
    };
    let places = [x, y, z];
    let turn = Matrix3::from_fn(|i, j| covariance[(places[i], places[j])]);
    let moved = |k: usize| {
        let cross = Vector3::ith(k, 1.0).cross_matrix();
        cross * turn * cross.transpose()
    };
    let entries: Vec<(usize, (SensorKind, usize, usize))> = (layout.quantities.iter().enumerate())
        .filter_map(|(place, quantity)| Some((place, entry(*quantity)?)))
        .collect();
    for (known, (kind, row, k)) in &entries {
        let information = layout.prior[(*known, *known)];
        let own = match information > 0.0 {
            true => 1.0 / information,
            false => spread[*kind as usize].powi(2),
        };
        let of_row = moved(*k) * (own + moved(*row)[(*k, *k)]);
        let same = entries.iter().filter(|(_, (other, of, _))| other == kind && of == row);
        for (i, (_, _, one)) in same.clone() {
            for (j, (_, _, other)) in same.clone() {
                products[(*i, *j)] += of_row[(*one, *other)];
            }
        }
    }
    products
}

/// What calibrations state of second order beyond the first, in the mean over sensors. `turned` is the mean square of the turned cross terms.
pub(crate) fn beyond_first_order(of: MountVariance, turned: f64) -> f64 {
    let missing = of.beyond();
    if turned > 0.0 { missing + turned * (-missing / turned).exp_m1() } else { missing }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chains_for_tests::{Numbers, arm_of_all_kinds, problem_of};
    use crate::information::Sensing;

    #[test]
    fn the_products_are_those_of_many_turns_and_sensors() {
        let chain = arm_of_all_kinds(3, &mut Numbers(8));
        let mut layout = Sensing::new(&problem_of(&chain)).expect("valid").layout;
        let (turn_sd, entry_sd) = (0.01, 0.02);
        let n = layout.quantities.len();
        let covariance = DMatrix::identity(n, n) * (turn_sd * turn_sd);
        layout.prior = DMatrix::zeros(n, n);
        let found = of_turned_cross_terms(&layout, &covariance, [1.0, entry_sd]);
        // the same, known beforehand
        layout.prior = DMatrix::identity(n, n) / (entry_sd * entry_sd);
        assert!(
            (of_turned_cross_terms(&layout, &covariance, [1.0, 1.0]) - &found)
                .view((12, 12), (12, 12))
                .amax()
                < 1e-18
        );

        let place = |row: usize, column: usize| {
            let wanted = Some((SensorKind::Gyroscope, row, column));
            layout.quantities.iter().position(|of| entry(*of) == wanted).expect("there")
        };
        let (mut numbers, draws) = (Numbers(3), 100_000);
        // uniform on ±√3: of unit variance
        let mut unit = |sd: f64| numbers.next(3.0_f64.sqrt() * sd);
        let mut sums = [[0.0; 3]; 3];
        for _ in 0..draws {
            let own = Matrix3::from_fn(|_, _| unit(entry_sd));
            let mut turn = || Vector3::from_fn(|_, _| unit(turn_sd)).cross_matrix();
            // at what a calibration finds, another turn is possible
            let change = (own + turn()) * turn();
            for (i, sums) in sums.iter_mut().enumerate() {
                for (j, sum) in sums.iter_mut().enumerate() {
                    *sum += change[(i, j)].powi(2) / f64::from(draws);
                }
            }
        }
        for (i, sums) in sums.iter().enumerate() {
            for (j, sum) in sums.iter().enumerate() {
                let k = place(i, j);
                assert!((found[(k, k)] / sum - 1.0).abs() < 0.03, "{i} {j}: {} {sum}", found[(k, k)]);
            }
        }
    }

    #[test]
    fn what_is_missing_of_second_order_is_that_of_many_sensors() {
        let mut numbers = Numbers(2);
        let mut exponential = || -(0.5 * (1.0 + numbers.next(1.0))).max(1e-12).ln();
        for (second, turned) in [(1.0, 2.0), (1.0, 0.3)] {
            let draws = 100_000;
            let one = |of: f64| MountVariance { first: of, second }.beyond() / f64::from(draws);
            let mean: f64 = (0..draws).map(|_| one(turned * exponential())).sum();
            let found = beyond_first_order(MountVariance { first: 0.0, second }, turned);
            assert!((found / mean - 1.0).abs() < 0.02, "{second} {turned}: {found} {mean}");
        }
        let only = MountVariance { first: 0.2, second: 1.0 };
        assert!((beyond_first_order(only, 0.0) - 0.8).abs() < 1e-12);
        assert_eq!(beyond_first_order(MountVariance { first: 2.0, second: 1.0 }, 0.5), 0.0);
    }
}
