//! A calibration referred to another temperature: the same polynomials about another `T₀`, the covariance with them.
//!
//! With `d = T₀' − T₀`: `b' = b + b_1 d + b_2 d²`, `b_1' = b_1 + 2 b_2 d`, `b_2' = b_2`; and with `c = 1 + k_1 d + k_2 d²`: `S' = diag(c) S`,
//! `k_1' = (k_1 + 2 k_2 d)/c`, `k_2' = k_2/c`. Readings stay the same at every temperature.

use super::entries::{self, EntryMatrix};
use super::{Axis, CalibratedImu, Gauge, ImuParameters, ImuQuantity, Quantity, Thermal, ThermalPart, Triad};
use crate::error::{Complaint, Error, Result};
use nalgebra::{DMatrix, Matrix3, Vector3};

/// A matrix is symmetric where no entry differs from its counterpart by more than this share of the largest.
const SYMMETRIC: f64 = 1e-12;

/// The parameters about another reference, and how they depend on those before.
struct Referred {
    before: ImuParameters,
    after: ImuParameters,
    change_k: f64,
}

impl Referred {
    fn new(imu: &ImuParameters, reference_c: f64) -> Result<Self> {
        let change_k = imu.thermal.tau_k(reference_c);
        let mut after = *imu;
        after.thermal.reference_c = reference_c;
        for triad in Triad::ALL {
            let factor = imu.thermal.triad(triad).gain_factor(change_k);
            if !(factor.min() > 0.0 && factor.iter().all(|c| c.is_finite())) {
                return Err(Error::experiment(Complaint::new(
                    format!("at {reference_c} °C the polynomial of the {triad}'s gain is not positive"),
                    "choose a temperature within the range of the calibration",
                )));
            }
            let sensor = after.triad_mut(triad);
            sensor.bias += imu.thermal.triad(triad).bias_change(change_k);
            sensor.matrix = Matrix3::from_diagonal(&factor) * sensor.matrix;
            let terms = after.thermal.triad_mut(triad);
            let second = terms.bias[1];
            terms.bias[0] += second * (2.0 * change_k);
            let second = terms.scale[1];
            terms.scale[0] = (terms.scale[0] + second * (2.0 * change_k)).component_div(&factor);
            terms.scale[1] = second.component_div(&factor);
        }
        Ok(Self { before: *imu, after, change_k })
    }

    /// What a small step of the entries becomes.
    fn step(&self, step: &ImuParameters) -> ImuParameters {
        let d = self.change_k;
        let mut out = *step;
        for triad in Triad::ALL {
            let (terms, by) = (self.before.thermal.triad(triad), step.thermal.triad(triad));
            let factor = terms.gain_factor(d);
            let by_factor = by.scale[0] * d + by.scale[1] * (d * d);
            let sensor = out.triad_mut(triad);
            sensor.bias += by.bias_change(d);
            sensor.matrix = Matrix3::from_diagonal(&factor) * step.triad(triad).matrix
                + Matrix3::from_diagonal(&by_factor) * self.before.triad(triad).matrix;
            let after = *self.after.thermal.triad(triad);
            let quotient = |by_term: Vector3<f64>, term: Vector3<f64>| {
                (by_term - term.component_mul(&by_factor)).component_div(&factor)
            };
            let changed = out.thermal.triad_mut(triad);
            changed.bias[0] = by.bias[0] + by.bias[1] * (2.0 * d);
            changed.scale[0] = quotient(by.scale[0] + by.scale[1] * (2.0 * d), after.scale[0]);
            changed.scale[1] = quotient(by.scale[1], after.scale[1]);
        }
        out
    }

    /// Derivative of the entries after with respect to those before.
    fn jacobian(&self) -> EntryMatrix {
        entries::jacobian(|step| self.step(step))
    }
}

impl CalibratedImu {
    /// Does temperature do anything to it, in its values or in what its covariance speaks of?
    #[must_use]
    pub fn follows_temperature(&self) -> bool {
        let thermal = |quantity: &ImuQuantity| matches!(quantity, ImuQuantity::Thermal(..));
        !self.parameters.thermal.is_none() || self.quantities.iter().any(thermal)
    }

    /// The same IMU with its temperature terms about another reference, its covariance carried along to first order.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the polynomial of a gain is not positive there.
    ///
    /// # Examples
    /// ```
    /// use calibrant::sensor::{CalibratedImu, ImuParameters, ImuQuantity, ReadingUnit};
    /// let mut parameters = ImuParameters::identity();
    /// parameters.thermal.reference_c = 20.0;
    /// parameters.thermal.accelerometer.bias = [[0.01, 0.0, 0.0].into(), [0.001, 0.0, 0.0].into()];
    /// let imu = CalibratedImu {
    ///     parameters,
    ///     accelerometer_unit: Some(ReadingUnit::MetrePerSecondSquared),
    ///     gyroscope_unit: None,
    ///     quantities: vec![],
    ///     covariance: None,
    ///     frame: String::new(),
    /// };
    /// let warm = imu.referred_to(30.0)?.parameters;
    /// assert!((warm.accelerometer.bias.x - 0.2).abs() < 1e-15);
    /// assert!((warm.thermal.accelerometer.bias[0].x - 0.03).abs() < 1e-15);
    /// # Ok::<(), calibrant::Error>(())
    /// ```
    pub fn referred_to(&self, reference_c: f64) -> Result<Self> {
        if self.parameters.thermal.reference_c == reference_c {
            return Ok(self.clone());
        }
        let referred = Referred::new(&self.parameters, reference_c)?;
        let jacobian = referred.jacobian();
        let quantities = self.referred_quantities(&jacobian);
        let covariance = entries::covariance(self).map(|sigma| {
            let sigma = jacobian * sigma * jacobian.transpose();
            let place: Vec<usize> =
                quantities.iter().map(|&quantity| entries::of_quantity(quantity).imax()).collect();
            DMatrix::from_fn(place.len(), place.len(), |i, j| {
                0.5 * (sigma[(place[i], place[j])] + sigma[(place[j], place[i])])
            })
        });
        let frame = self.referred_frame(&referred.after);
        Ok(Self { parameters: referred.after, quantities, covariance, frame, ..*self })
    }

    /// The true frame in words. One that a symmetric matrix fixes stays where it is, but gains that follow temperature leave the matrix symmetric only at the
    /// reference at which it was: that is then said.
    fn referred_frame(&self, after: &ImuParameters) -> String {
        let symmetric = |imu: &ImuParameters| {
            let matrix = imu.triad(self.reference()).matrix;
            (matrix - matrix.transpose()).amax() <= SYMMETRIC * matrix.amax()
        };
        let at = format!(" at {} °C", self.parameters.thermal.reference_c);
        let no_longer = symmetric(&self.parameters) && !symmetric(after);
        if no_longer && self.frame.contains(Gauge::Symmetric.name()) && !self.frame.ends_with(&at) {
            return self.frame.clone() + &at;
        }
        self.frame.clone()
    }

    /// The IMU as it is at one temperature, °C, nothing following temperature any more.
    ///
    /// # Errors
    /// As [`referred_to`](Self::referred_to).
    pub fn at(&self, temperature_c: f64) -> Result<Self> {
        let mut imu = self.referred_to(temperature_c)?;
        let kept: Vec<usize> = (0..imu.quantities.len())
            .filter(|&k| !matches!(imu.quantities[k], ImuQuantity::Thermal(..)))
            .collect();
        imu.parameters.thermal = Thermal::none();
        imu.restrict(&kept);
        Ok(imu)
    }

    /// What the covariance speaks of after the change: all that an uncertain term adds to.
    fn referred_quantities(&self, jacobian: &EntryMatrix) -> Vec<ImuQuantity> {
        let rescaled = |triad: Triad| {
            let scale = |quantity: &ImuQuantity| matches!(quantity, ImuQuantity::Thermal(of, term) if *of == triad && term.part == ThermalPart::Scale);
            !self.parameters.thermal.triad(triad).scale.iter().all(|k| *k == Vector3::zeros())
                || self.quantities.iter().any(scale)
        };
        let mut list = Vec::new();
        let mut add = |quantity: ImuQuantity| {
            if !list.contains(&quantity) {
                list.push(quantity);
            }
        };
        for &quantity in &self.quantities {
            match quantity {
                // gains that differ leave no symmetric matrix
                ImuQuantity::Of(triad, Quantity::Symmetric(row, column)) if rescaled(triad) => {
                    let entry =
                        |row: Axis, column: Axis| ImuQuantity::Of(triad, Quantity::CrossAxis(row, column));
                    [entry(row, column), entry(column, row)].into_iter().for_each(&mut add);
                }
                _ => add(quantity),
            }
        }
        let all = entries::all_quantities();
        for &quantity in
            self.quantities.iter().filter(|quantity| matches!(quantity, ImuQuantity::Thermal(..)))
        {
            let moved = jacobian * entries::of_quantity(quantity);
            all.iter()
                .filter(|&&other| moved[entries::of_quantity(other).imax()] != 0.0)
                .for_each(|&other| add(other));
        }
        list
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::sensor::entries::ENTRIES;
    use crate::sensor::gauge_change::tests::imu;

    /// The IMU of the gauge tests with terms of every kind.
    pub(in crate::sensor) fn warm() -> CalibratedImu {
        let mut imu = imu();
        for (k, quantity) in ImuQuantity::all_thermal(true, true).into_iter().enumerate() {
            let size = match quantity {
                ImuQuantity::Thermal(_, term) if term.part == ThermalPart::Scale => 1e-4,
                _ => 2.0,
            };
            quantity.add_to(&mut imu.parameters, size * (k as f64 % 5.0 - 2.3) / (1.0 + k as f64 % 3.0));
        }
        imu.quantities.extend(ImuQuantity::all_thermal(true, true));
        let n = imu.quantities.len();
        let root = DMatrix::from_fn(n, n, |i, j| {
            let size = if i < entries::AT_REFERENCE { 1.0 } else { 1e-4 };
            size * (0.01 * ((7 * i + 3 * j) % 11) as f64 + f64::from(u8::from(i == j)))
        });
        imu.covariance = Some(&root * root.transpose());
        imu
    }

    #[test]
    fn readings_do_not_know_the_reference() {
        let before = warm();
        let after = before.referred_to(43.0).expect("positive gains");
        for temperature in [-10.0, 25.0, 61.5] {
            let (a, b) = (before.parameters.at(temperature), after.parameters.at(temperature));
            for triad in Triad::ALL {
                let (a, b) = (a.triad(triad), b.triad(triad));
                assert!((a.bias - b.bias).amax() < 1e-10 * a.bias.amax(), "{temperature}");
                assert!((a.matrix - b.matrix).amax() < 1e-12 * a.matrix.amax(), "{temperature}");
            }
        }
    }

    #[test]
    fn the_jacobian_is_that_of_differences() {
        let parameters = warm().parameters;
        let jacobian = Referred::new(&parameters, 43.0).expect("positive gains").jacobian();
        for entry in 0..ENTRIES {
            let h = if entry < 24 { 1e-2 } else { 1e-6 };
            let at = |step: f64| {
                let mut moved = entries::of(&parameters);
                moved[entry] += step;
                entries::of(&Referred::new(&entries::to_imu(&moved), 43.0).expect("positive gains").after)
            };
            let difference = (at(h) - at(-h)) / (2.0 * h);
            let error = (difference - jacobian.column(entry)).amax();
            assert!(error < 1e-5 * difference.amax().max(1e-2), "{entry}: {error:e}");
        }
    }

    #[test]
    fn there_and_back_is_the_same_and_uncertain_terms_make_uncertain_values() {
        let before = warm();
        let back = before.referred_to(43.0).and_then(|imu| imu.referred_to(25.0)).expect("positive gains");
        let (one, two) = (before.covariance.clone().expect("there"), back.covariance.expect("kept"));
        assert_eq!(before.quantities, back.quantities);
        assert!((&one - &two).amax() < 1e-10 * one.amax());

        let term = ImuQuantity::thermal_list(Triad::Gyroscope, 1, 0)[0];
        let alone = CalibratedImu {
            quantities: vec![term],
            covariance: Some(DMatrix::identity(1, 1) * 1e-6),
            ..before
        };
        let hot = alone.at(35.0).expect("positive gains");
        let names: Vec<String> = hot.quantities.iter().map(|quantity| quantity.name()).collect();
        assert_eq!(names, ["gyroscope.bias.x"]);
        assert!((hot.covariance.expect("kept")[(0, 0)] - 1e-4).abs() < 1e-15, "1e-3 per K over 10 K");
    }

    #[test]
    fn a_symmetric_matrix_is_so_at_its_reference_only() {
        let symmetric = warm().in_gauge(Gauge::Symmetric).expect("right-handed");
        let at = |imu: &CalibratedImu, t: f64| imu.referred_to(t).expect("positive gains");
        let matrix = at(&symmetric, 43.0).parameters.accelerometer.matrix;
        assert!((matrix - matrix.transpose()).amax() > 1e-6 * matrix.amax(), "{matrix}");
        let said = format!("{} at 25 °C", symmetric.frame);
        let (warmer, back) = (at(&symmetric, 43.0), at(&at(&symmetric, 43.0), 25.0));
        for imu in [&warmer, &at(&warmer, 50.0), &back, &at(&back, 43.0)] {
            assert_eq!(imu.frame, said);
        }
        // a triangle stays one, and so does a symmetric matrix whose gains stay
        let upper = warm().in_gauge(Gauge::Upper).expect("right-handed");
        assert_eq!(at(&upper, 43.0).frame, upper.frame);
        let mut steady = symmetric;
        steady.parameters.thermal.accelerometer.scale = [Vector3::zeros(); 2];
        assert_eq!(at(&steady, 43.0).frame, steady.frame);
    }
}
