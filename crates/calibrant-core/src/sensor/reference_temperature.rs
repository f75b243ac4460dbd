//! The IMU at a given temperature, its temperature terms, and the change of a calibration's reference temperature: the same polynomials about another `T₀`, and their
//! covariance.
//!
//! Let `d = T₀' − T₀` and `c = 1 + Σ_n k_n dⁿ`. Then `b' = b + Σ_n b_n dⁿ` and `b_m' = Σ_{n ≥ m} (n over m) b_n d^{n−m}`. Further `S' = diag(c) S` and
//! `k_m' = Σ_{n ≥ m} (n over m) k_n d^{n−m} / c`. Readings stay the same at every temperature.

use super::entry_vector::EntryMatrix;
use super::{
    Axis, CalibratedImu, Gauge, HIGHEST_ORDER, ImuParameters, ImuQuantity, PerSensor, Quantity, SensorKind,
    SensorParameters, Thermal, ThermalPart, ThermalTerm, entry_vector,
};
use crate::error::{Error, InputError, Refusal, Result};
use nalgebra::{Matrix3, Vector3};

/// A matrix is symmetric where no entry differs from its counterpart by more than this share of the largest.
const SYMMETRIC: f64 = 1e-12;

/// The parameters about another reference, and their derivatives with respect to those before.
struct AtReference {
    before: ImuParameters,
    after: ImuParameters,
    change_k: f64,
}

impl AtReference {
    fn new(imu: &ImuParameters, reference_c: f64) -> Result<Self> {
        let change_k = imu.thermal.tau_k(reference_c);
        let mut after = *imu;
        after.thermal.reference_c = reference_c;
        for sensor_kind in SensorKind::ALL {
            let factor = imu.thermal.sensor(sensor_kind).gain_factor(change_k);
            if !(factor.min() > 0.0 && factor.iter().all(|c| c.is_finite())) {
                return Err(Error::experiment(InputError::new(
                    Refusal::CalibrationUnsuited,
                    format!("at {reference_c} °C the polynomial of the {sensor_kind}'s gain is not positive"),
                    "choose a temperature within the range of the calibration",
                )));
            }
            let sensor = &mut after[sensor_kind];
            sensor.bias += imu.thermal.sensor(sensor_kind).bias_change(change_k);
            sensor.matrix = Matrix3::from_diagonal(&factor) * sensor.matrix;
            let terms = &mut after.thermal[sensor_kind];
            terms.bias = moved(&terms.bias, change_k);
            terms.scale = moved(&terms.scale, change_k).map(|of| of.component_div(&factor));
        }
        Ok(Self { before: *imu, after, change_k })
    }

    /// The effect of a small step of the entries.
    fn step(&self, step: &ImuParameters) -> ImuParameters {
        let d = self.change_k;
        let mut out = *step;
        for sensor_kind in SensorKind::ALL {
            let (terms, by) = (self.before.thermal.sensor(sensor_kind), step.thermal.sensor(sensor_kind));
            let factor = terms.gain_factor(d);
            let by_factor = by.gain_factor(d) - Vector3::repeat(1.0);
            let sensor = &mut out[sensor_kind];
            sensor.bias += by.bias_change(d);
            sensor.matrix = Matrix3::from_diagonal(&factor) * step.sensor(sensor_kind).matrix
                + Matrix3::from_diagonal(&by_factor) * self.before.sensor(sensor_kind).matrix;
            let after = *self.after.thermal.sensor(sensor_kind);
            let quotient = |by_term: Vector3<f64>, term: Vector3<f64>| {
                (by_term - term.component_mul(&by_factor)).component_div(&factor)
            };
            let changed = &mut out.thermal[sensor_kind];
            changed.bias = moved(&by.bias, d);
            let by_scale = moved(&by.scale, d);
            changed.scale = std::array::from_fn(|m| quotient(by_scale[m], after.scale[m]));
        }
        out
    }

    /// Derivative of the entries after with respect to those before.
    fn jacobian(&self) -> EntryMatrix {
        entry_vector::jacobian(|step| self.step(step))
    }
}

/// The coefficients of the powers from 1 about a reference that is `d` higher: `Σ_{n ≥ m} (n over m) c_n d^{n−m}`.
#[must_use]
pub fn moved(of: &[Vector3<f64>; HIGHEST_ORDER], d: f64) -> [Vector3<f64>; HIGHEST_ORDER] {
    let mut moved = [Vector3::zeros(); HIGHEST_ORDER];
    for (n, coefficient) in (1_i32..).zip(of) {
        let mut ways = 1.0;
        for (m, moved) in (1_i32..=n).zip(&mut moved) {
            ways *= f64::from(n - m + 1) / f64::from(m);
            *moved += ways * d.powi(n - m) * coefficient;
        }
    }
    moved
}

impl CalibratedImu {
    /// Does anything in it follow temperature, in its values or in the quantities of its covariance?
    #[must_use]
    pub fn follows_temperature(&self) -> bool {
        let thermal = |quantity: &ImuQuantity| matches!(quantity, ImuQuantity::Thermal(..));
        !self.parameters.thermal.is_none() || self.quantities.iter().any(thermal)
    }

    /// The same IMU with its temperature terms about another reference. Its covariance follows to first
    /// order.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the polynomial of a gain is not positive there.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::sensor::{CalibratedImu, ImuParameters, ImuQuantity, ReadingUnit, SensorKind};
    /// let mut parameters = ImuParameters::identity();
    /// parameters.thermal.reference_c = 20.0;
    /// parameters.thermal[SensorKind::Accelerometer].bias[0].x = 0.01;
    /// parameters.thermal[SensorKind::Accelerometer].bias[1].x = 0.001;
    /// let units = [Some(ReadingUnit::MetrePerSecondSquared), None];
    /// let imu = CalibratedImu::new(parameters, units, vec![], "");
    /// let warm = imu.at_reference_temperature(30.0)?.parameters;
    /// assert!((warm[SensorKind::Accelerometer].bias.x - 0.2).abs() < 1e-15);
    /// assert!((warm.thermal[SensorKind::Accelerometer].bias[0].x - 0.03).abs() < 1e-15);
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    pub fn at_reference_temperature(&self, reference_c: f64) -> Result<Self> {
        if self.parameters.thermal.reference_c == reference_c {
            return Ok(self.clone());
        }
        let converted = AtReference::new(&self.parameters, reference_c)?;
        let jacobian = converted.jacobian();
        let quantities = self.referred_quantities(&jacobian);
        let (covariance, shared) = entry_vector::transformed(self, || jacobian, &quantities);
        let frame = self.referred_frame(&converted.after);
        Ok(Self { parameters: converted.after, quantities, covariance, shared, frame, ..*self })
    }

    /// The true frame in words. A frame that a symmetric matrix fixes stays where it is. Gains that follow
    /// temperature leave the matrix symmetric only at the old reference, and the words then say so.
    fn referred_frame(&self, after: &ImuParameters) -> String {
        let symmetric = |imu: &ImuParameters| {
            let matrix = imu.sensor(self.reference()).matrix;
            (matrix - matrix.transpose()).amax() <= SYMMETRIC * matrix.amax()
        };
        let at = format!(" at {} °C", self.parameters.thermal.reference_c);
        let no_longer = symmetric(&self.parameters) && !symmetric(after);
        if no_longer && self.frame.contains(Gauge::Symmetric.name()) && !self.frame.ends_with(&at) {
            return self.frame.clone() + &at;
        }
        self.frame.clone()
    }

    /// The IMU at one temperature, °C. The result does not follow temperature any more.
    ///
    /// # Errors
    /// As [`at_reference_temperature`](Self::at_reference_temperature).
    pub fn at(&self, temperature_c: f64) -> Result<Self> {
        let mut imu = self.at_reference_temperature(temperature_c)?;
        let kept: Vec<usize> = (0..imu.quantities.len())
            .filter(|&k| !matches!(imu.quantities[k], ImuQuantity::Thermal(..)))
            .collect();
        imu.parameters.thermal = Thermal::none();
        imu.restrict(&kept);
        Ok(imu)
    }

    /// The quantities of the covariance after the change: all that an uncertain term adds to.
    fn referred_quantities(&self, jacobian: &EntryMatrix) -> Vec<ImuQuantity> {
        let rescaled = |sensor_kind: SensorKind| {
            let scale = |quantity: &ImuQuantity| matches!(quantity, ImuQuantity::Thermal(of, term) if *of == sensor_kind && term.part == ThermalPart::Scale);
            !self.parameters.thermal.sensor(sensor_kind).scale.iter().all(|k| *k == Vector3::zeros())
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
                // gains that differ make the matrix asymmetric
                ImuQuantity::Of(sensor_kind, Quantity::Symmetric(row, column)) if rescaled(sensor_kind) => {
                    let entry = |row: Axis, column: Axis| {
                        ImuQuantity::Of(sensor_kind, Quantity::CrossAxis(row, column))
                    };
                    [entry(row, column), entry(column, row)].into_iter().for_each(&mut add);
                }
                _ => add(quantity),
            }
        }
        let all = ImuQuantity::all(true, true);
        for &quantity in
            self.quantities.iter().filter(|quantity| matches!(quantity, ImuQuantity::Thermal(..)))
        {
            let moved = jacobian * entry_vector::of_quantity(quantity);
            all.iter()
                .filter(|&&other| moved[entry_vector::of_quantity(other).imax()] != 0.0)
                .for_each(|&other| add(other));
        }
        list
    }
}

impl ImuParameters {
    /// The IMU at a temperature: `b(T)`, `S(T)` and `Γ`. The result does not follow temperature any more.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::sensor::{ImuParameters, SensorKind};
    /// let mut imu = ImuParameters::identity();
    /// imu.thermal.reference_c = 20.0;
    /// imu.thermal[SensorKind::Gyroscope].bias[0].x = 1e-4; // rad/s/K
    /// imu.thermal[SensorKind::Accelerometer].scale[1].z = 2e-6; // 1/K²
    /// let hot = imu.at(50.0);
    /// assert!((hot[SensorKind::Gyroscope].bias.x - 3e-3).abs() < 1e-15);
    /// assert!((hot[SensorKind::Accelerometer].matrix[(2, 2)] - 1.0018).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn at(&self, temperature_c: f64) -> Self {
        if self.thermal.is_none() {
            return *self;
        }
        let sensors = PerSensor::from_fn(|sensor_kind| self.sensor_at(sensor_kind, temperature_c));
        Self { sensors, thermal: Thermal::none(), ..*self }
    }

    /// One of its sensors at a temperature.
    pub(crate) fn sensor_at(&self, sensor_kind: SensorKind, temperature_c: f64) -> SensorParameters {
        let mut sensor = *self.sensor(sensor_kind);
        if !self.thermal.is_none() {
            let (thermal, tau_k) = (self.thermal.sensor(sensor_kind), self.thermal.tau_k(temperature_c));
            sensor.bias += thermal.bias_change(tau_k);
            sensor.matrix = Matrix3::from_diagonal(&thermal.gain_factor(tau_k)) * sensor.matrix;
        }
        sensor
    }
}

impl ImuQuantity {
    /// The temperature terms of one sensor up to these orders. The terms of the bias come first, then those
    /// of the scale, order by order.
    #[must_use]
    pub fn thermal_list(sensor_kind: SensorKind, bias_order: usize, scale_order: usize) -> Vec<Self> {
        let mut list = Vec::new();
        for (part, order) in [(ThermalPart::Bias, bias_order), (ThermalPart::Scale, scale_order)] {
            for order in 1..=order.min(HIGHEST_ORDER) {
                list.extend(
                    Axis::ALL.map(|axis| Self::Thermal(sensor_kind, ThermalTerm { part, axis, order })),
                );
            }
        }
        list
    }

    /// Every temperature term of the sensors that are there.
    #[must_use]
    pub fn all_thermal(accelerometer: bool, gyroscope: bool) -> Vec<Self> {
        [(SensorKind::Accelerometer, accelerometer), (SensorKind::Gyroscope, gyroscope)]
            .into_iter()
            .filter(|(_, there)| *there)
            .flat_map(|(sensor_kind, _)| Self::thermal_list(sensor_kind, HIGHEST_ORDER, HIGHEST_ORDER))
            .collect()
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::sensor::entry_vector::ENTRIES;
    use crate::sensor::gauge_change::tests::imu;
    use crate::sensor::{Condition, ReadingUnit};
    use nalgebra::{DMatrix, Vector3};

    /// `τ^(m − 1)` and more for the place of a term of order `m`.
    fn of_order(place: usize) -> f64 {
        40f64.powi(((place - entry_vector::AT_REFERENCE) / 3 % HIGHEST_ORDER) as i32)
    }

    /// The IMU of the gauge tests with terms of every kind.
    pub(in crate::sensor) fn warm() -> CalibratedImu {
        let mut imu = imu();
        for (k, quantity) in ImuQuantity::all_thermal(true, true).into_iter().enumerate() {
            let ImuQuantity::Thermal(_, term) = quantity else { continue };
            let first = if term.part == ThermalPart::Scale { 1e-4 } else { 2.0 };
            let size = first / 40f64.powi(term.order as i32 - 1);
            quantity.add_to(&mut imu.parameters, size * (k as f64 % 5.0 - 2.3) / (1.0 + k as f64 % 3.0));
        }
        imu.quantities.extend(ImuQuantity::all_thermal(true, true));
        let n = imu.quantities.len();
        let root = DMatrix::from_fn(n, n, |i, j| {
            let size = if i < entry_vector::AT_REFERENCE { 1.0 } else { 1e-4 / of_order(i) };
            size * (0.01 * ((7 * i + 3 * j) % 11) as f64 + f64::from(u8::from(i == j)))
        });
        imu.covariance = Some(&root * root.transpose());
        imu
    }

    #[test]
    fn readings_do_not_know_the_reference() {
        let before = warm();
        let after = before.at_reference_temperature(43.0).expect("positive gains");
        for temperature in [-10.0, 25.0, 61.5] {
            let (a, b) = (before.parameters.at(temperature), after.parameters.at(temperature));
            for sensor_kind in SensorKind::ALL {
                let (a, b) = (a.sensor(sensor_kind), b.sensor(sensor_kind));
                assert!((a.bias - b.bias).amax() < 1e-10 * a.bias.amax(), "{temperature}");
                assert!((a.matrix - b.matrix).amax() < 1e-12 * a.matrix.amax(), "{temperature}");
            }
        }
    }

    #[test]
    fn the_jacobian_is_that_of_differences() {
        let parameters = warm().parameters;
        let jacobian = AtReference::new(&parameters, 43.0).expect("positive gains").jacobian();
        for entry in 0..ENTRIES {
            let h = match entry {
                0..24 => 1e-2,
                entry_vector::AT_REFERENCE..entry_vector::LINEAR => 1e-6 / of_order(entry).sqrt(),
                _ => 1e-6,
            };
            let at = |step: f64| {
                let mut moved = entry_vector::from_parameters(&parameters);
                moved[entry] += step;
                entry_vector::from_parameters(
                    &AtReference::new(&entry_vector::to_imu(&moved), 43.0).expect("positive gains").after,
                )
            };
            let difference = (at(h) - at(-h)) / (2.0 * h);
            let error = (difference - jacobian.column(entry)).amax();
            assert!(error < 1e-5 * difference.amax().max(1e-2), "{entry}: {error:e}");
        }
    }

    #[test]
    fn there_and_back_is_the_same_and_uncertain_terms_make_uncertain_values() {
        let before = warm();
        let back = before
            .at_reference_temperature(43.0)
            .and_then(|imu| imu.at_reference_temperature(25.0))
            .expect("positive gains");
        let (one, two) = (before.covariance.clone().expect("there"), back.covariance.expect("kept"));
        assert_eq!(before.quantities, back.quantities);
        assert!((&one - &two).amax() < 1e-10 * one.amax());

        let term = ImuQuantity::thermal_list(SensorKind::Gyroscope, 1, 0)[0];
        let alone = CalibratedImu {
            quantities: vec![term],
            covariance: Some(DMatrix::identity(1, 1) * 1e-6),
            degrees_of_freedom: None,
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
        let at = |imu: &CalibratedImu, t: f64| imu.at_reference_temperature(t).expect("positive gains");
        let matrix = at(&symmetric, 43.0).parameters[SensorKind::Accelerometer].matrix;
        assert!((matrix - matrix.transpose()).amax() > 1e-6 * matrix.amax(), "{matrix}");
        let stated = format!("{} at 25 °C", symmetric.frame);
        let (warmer, back) = (at(&symmetric, 43.0), at(&at(&symmetric, 43.0), 25.0));
        for imu in [&warmer, &at(&warmer, 50.0), &back, &at(&back, 43.0)] {
            assert_eq!(imu.frame, stated);
        }
        // a triangular matrix stays triangular; a symmetric one whose gains stay does, too
        let upper = warm().in_gauge(Gauge::Upper).expect("right-handed");
        assert_eq!(at(&upper, 43.0).frame, upper.frame);
        let mut steady = symmetric;
        steady.parameters.thermal[SensorKind::Accelerometer].scale = [Vector3::zeros(); HIGHEST_ORDER];
        assert_eq!(at(&steady, 43.0).frame, steady.frame);
    }

    #[test]
    fn names_and_units_say_the_power() {
        let list = ImuQuantity::thermal_list(SensorKind::Gyroscope, 2, 1);
        let names: Vec<String> = list.iter().map(|quantity| quantity.name()).collect();
        assert_eq!(names[0], "gyroscope.bias_per_k.x");
        assert_eq!(names[4], "gyroscope.bias_per_k2.y");
        assert_eq!(names[8], "gyroscope.scale_per_k.z");
        assert_eq!(list[4].unit(ReadingUnit::Counts), "counts/K²");
        assert_eq!(ImuQuantity::all_thermal(true, true).len(), 2 * 2 * 3 * HIGHEST_ORDER);
    }

    #[test]
    fn derivatives_equal_differences() {
        let mut imu = ImuParameters::identity();
        let mut all = ImuQuantity::full_list(true, true, true);
        all.extend(ImuQuantity::all_thermal(true, true));
        for (k, quantity) in all.iter().enumerate() {
            quantity.add_to(&mut imu, 1e-3 * ((5 * k % 13) as f64 - 6.0));
        }
        let (stimulus, force, temperature_c) =
            (Vector3::new(0.4, -1.2, 0.3), Vector3::new(1.0, -5.0, 8.0), 29.5);
        let reading = |imu: &ImuParameters, sensor_kind: SensorKind| {
            let felt = if sensor_kind == SensorKind::Gyroscope {
                imu.g_sensitivity * force
            } else {
                Vector3::zeros()
            };
            imu.at(temperature_c).sensor(sensor_kind).reading(&stimulus) + felt
        };
        for quantity in all {
            let moved = |by: f64| {
                let mut moved = imu;
                quantity.add_to(&mut moved, by);
                reading(&moved, quantity.sensor_kind())
            };
            let difference = (moved(1e-4) - moved(-1e-4)) / 2e-4;
            let at = Condition { imu: &imu, stimulus, force, temperature_c };
            assert!((difference - quantity.derivative(&at)).amax() < 1e-8, "{}", quantity.name());
        }
    }

    #[test]
    fn each_term_is_found_where_it_was_added() {
        for (k, quantity) in ImuQuantity::all_thermal(true, true).into_iter().enumerate() {
            let mut imu = ImuParameters::identity();
            quantity.add_to(&mut imu, 1.0 + k as f64);
            let found: Vec<f64> =
                ImuQuantity::all_thermal(true, true).iter().map(|other| other.value(&imu)).collect();
            assert_eq!(found.iter().sum::<f64>(), 1.0 + k as f64);
            assert_eq!(found[k], 1.0 + k as f64, "{}", quantity.name());
        }
    }
}
