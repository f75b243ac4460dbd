//! Two calibrations one after the other: the second was made of readings that the first had corrected.
//!
//! The first corrects a reading, `y = S₁ y' + b₁`, and the second was made of what came out, `y' = S₂ s + b₂`. Together `y = S₁ S₂ s + S₁ b₂ + b₁`.
//! The first's correction of the gyroscope takes away `Γ₁ f'` with `f' = S₂ f + b₂` of the accelerometer, so that `Γ = S₁ Γ₂ + Γ₁ S₂` and its bias gains `Γ₁ b₂`.
//!
//! Where the first follows temperature, `S₁(T) = diag(1 + k(T)) S₁`: the second's bias goes with the gains, `b(T) = b₁(T) + diag(1 + k(T)) S₁ b₂`. The second then
//! has to be of one temperature.
//!
//! The numbers of the first are those that the readings were corrected with, whatever their uncertainty. The covariance is that of the second,
//! beside that of the first's terms of temperature. Nobody knows at which temperature the second was made: its biases get the largest variance that the first's
//! polynomials have in their range.

use super::{
    CalibratedImu, ImuParameters, ImuQuantity, PerSensor, Quantity, ReadingUnit, SensorKind, SharedErrors,
    ThermalPart, entry_vector,
};
use crate::error::{Error, InputError, Refusal, Result};
use nalgebra::{DMatrix, Matrix3};

impl ImuParameters {
    /// The linear effect of the second calibration's entries on those of both together.
    fn through(&self, second: &Self) -> Self {
        let (a, g) = (SensorKind::Accelerometer, SensorKind::Gyroscope);
        let mut both = *second;
        for kind in [a, g] {
            both[kind].matrix = self[kind].matrix * second[kind].matrix;
            both[kind].bias = self[kind].matrix * second[kind].bias;
        }
        both[g].bias += self.g_sensitivity * second[a].bias;
        both.g_sensitivity = self[g].matrix * second.g_sensitivity + self.g_sensitivity * second[a].matrix;
        both
    }
}

impl CalibratedImu {
    /// This calibration, made of readings that `first` had corrected, as one of raw readings: the sensors are those of this one.
    ///
    /// # Errors
    /// [`Error::Experiment`] where `first` has not the same sensors, where this one is of counts, where this one follows temperature, or where either bends the response.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::sensor::{CalibratedImu, ImuParameters, ReadingUnit, SensorKind};
    /// use nalgebra::Vector3;
    /// let with_bias = |x: f64| {
    ///     let mut imu = ImuParameters::identity();
    ///     imu[SensorKind::Accelerometer].bias = Vector3::new(x, 0.0, 0.0);
    ///     CalibratedImu::new(imu, [Some(ReadingUnit::MetrePerSecondSquared), None], vec![], "")
    /// };
    /// let both = with_bias(0.01).after(&with_bias(0.2))?;
    /// assert!((both.parameters[SensorKind::Accelerometer].bias.x - 0.21).abs() < 1e-15);
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    pub fn after(&self, first: &Self) -> Result<Self> {
        let (a, g) = (SensorKind::Accelerometer, SensorKind::Gyroscope);
        let refuse = |message: String, help: &str| {
            Err(Error::experiment(InputError::new(Refusal::ConversionImpossible, message, help)))
        };
        for (kind, unit) in self.units.present() {
            if first.unit(kind).is_none() {
                let message =
                    format!("the earlier calibration has no {kind}, so it did not correct its readings");
                return refuse(message, "take one sensor alone with option `sensor`");
            }
            if *unit == ReadingUnit::Counts || self.counts_per_unit[kind].is_some() {
                let message =
                    format!("the readings of the {kind} were counts, which no calibration had corrected");
                return refuse(message, "calibrate what `calibrant apply` wrote");
            }
        }
        let bends = [first, self].iter().any(|imu| !imu.parameters[a].nonlinearity.is_none());
        let gains_follow = first.parameters.thermal[g].order(ThermalPart::Scale) > 0;
        let felt_follows = gains_follow && self.parameters.g_sensitivity != Matrix3::zeros();
        if self.follows_temperature() || bends || felt_follows {
            return refuse(
                "terms of temperature of the second calibration, or that bend the response, are not carried through".into(),
                "take it at one temperature first, with option `temperature`; or calibrate raw readings of both sessions again",
            );
        }
        let felt = first.parameters.g_sensitivity != Matrix3::zeros();
        if self.unit(g).is_some() && self.unit(a).is_none() && felt {
            return refuse(
                "the earlier correction of the gyroscope takes the accelerometer's readings, and this calibration has no accelerometer".into(),
                "calibrate both sensors",
            );
        }
        let mut parameters = first.parameters.through(&self.parameters);
        let mut quantities = ImuQuantity::full_list(self.unit(a).is_some(), self.unit(g).is_some(), true);
        for (kind, _) in self.units.present() {
            parameters.thermal.reference_c = first.parameters.thermal.reference_c;
            parameters.thermal.range_c = first.parameters.thermal.range_c;
            let terms = first.parameters.thermal[kind];
            parameters.thermal[kind] = terms;
            let bias = first.parameters[kind].matrix * self.parameters[kind].bias;
            for (of_bias, of_gain) in parameters.thermal[kind].bias.iter_mut().zip(&terms.scale) {
                *of_bias += of_gain.component_mul(&bias);
            }
            parameters[kind].bias += first.parameters[kind].bias;
        }
        let jacobian = || entry_vector::jacobian(|step| first.parameters.through(step));
        // what is zero in both, as above the diagonal of two lower triangular matrices, stays no quantity
        let (covariance, _) = entry_vector::transformed(self, jacobian, &quantities);
        let is_free = |k: usize| covariance.as_ref().is_some_and(|covariance| covariance[(k, k)] > 0.0);
        let mut places = 0..quantities.len();
        quantities.retain(|_| places.next().is_some_and(is_free));
        if covariance.is_none() {
            quantities.clone_from(&self.quantities);
        }
        let (covariance, shared) = entry_vector::transformed(self, jacobian, &quantities);
        let terms = first.quantities.iter().enumerate().filter(
            |(_, quantity)| matches!(quantity, ImuQuantity::Thermal(kind, _) if self.unit(*kind).is_some()),
        );
        let terms: Vec<(usize, ImuQuantity)> = terms.map(|(k, quantity)| (k, *quantity)).collect();
        let (covariance, shared) = beside(covariance, shared, &terms, (first, &quantities));
        quantities.extend(terms.iter().map(|(_, quantity)| *quantity));
        Ok(Self {
            parameters,
            units: PerSensor::from_fn(|kind| self.unit(kind).and_then(|_| first.unit(kind))),
            counts_per_unit: PerSensor::from_fn(|kind| {
                self.unit(kind).and_then(|_| first.counts_per_unit[kind])
            }),
            quantities,
            covariance,
            shared,
            ..self.clone()
        })
    }
}

/// The largest variance over the range of what temperature does to a bias; 0 of other quantities.
fn largest_variance(imu: &CalibratedImu, quantity: ImuQuantity) -> f64 {
    const STEPS: i32 = 40;
    let ImuQuantity::Of(kind, Quantity::Bias(axis)) = quantity else { return 0.0 };
    let thermal = &imu.parameters.thermal;
    let (Some(sigma), Some([low, high])) = (&imu.covariance, thermal.range_c) else { return 0.0 };
    let term = |of: &ImuQuantity| match of {
        ImuQuantity::Thermal(of, term)
            if *of == kind && term.part == ThermalPart::Bias && term.axis == axis =>
        {
            Some(term.order as i32)
        }
        _ => None,
    };
    let orders: Vec<(usize, i32)> =
        imu.quantities.iter().enumerate().filter_map(|(k, of)| Some((k, term(of)?))).collect();
    let variance = |tau_k: f64| -> f64 {
        let pairs = orders.iter().flat_map(|one| orders.iter().map(move |other| (one, other)));
        pairs.map(|((i, m), (j, n))| sigma[(*i, *j)] * tau_k.powi(m + n)).sum()
    };
    let taus = (0..=STEPS).map(|k| thermal.tau_k(low + (high - low) * f64::from(k) / f64::from(STEPS)));
    taus.map(variance).fold(0.0, f64::max)
}

/// The covariance with that of the first's terms of temperature beside it.
fn beside(
    covariance: Option<DMatrix<f64>>,
    shared: Option<SharedErrors>,
    terms: &[(usize, ImuQuantity)],
    (first, quantities): (&CalibratedImu, &[ImuQuantity]),
) -> (Option<DMatrix<f64>>, Option<SharedErrors>) {
    let (Some(covariance), false) = (&covariance, terms.is_empty()) else { return (covariance, shared) };
    let (own, size) = (covariance.nrows(), covariance.nrows() + terms.len());
    let of_terms =
        |i: usize, j: usize| first.covariance.as_ref().map_or(0.0, |sigma| sigma[(terms[i].0, terms[j].0)]);
    let both = DMatrix::from_fn(size, size, |i, j| match (i.checked_sub(own), j.checked_sub(own)) {
        (None, None) if i == j => covariance[(i, i)] + largest_variance(first, quantities[i]),
        (None, None) => covariance[(i, j)],
        (Some(i), Some(j)) => of_terms(i, j),
        _ => 0.0,
    });
    let shared =
        shared.map(|shared| SharedErrors { root: shared.root.resize_vertically(size, 0.0), ..shared });
    (Some(both), shared)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::ImuCorrection;
    use nalgebra::Vector3;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn random(rng: &mut ChaCha8Rng) -> CalibratedImu {
        let mut part = |size: f64| rng.random_range(-size..size);
        let mut imu = ImuParameters::identity();
        for kind in SensorKind::ALL {
            imu[kind].bias = Vector3::from_fn(|_, _| part(0.3));
            imu[kind].matrix += Matrix3::from_fn(|_, _| part(0.03));
        }
        imu.g_sensitivity = Matrix3::from_fn(|_, _| part(1e-3));
        let units = [ReadingUnit::MetrePerSecondSquared, ReadingUnit::RadianPerSecond].map(Some);
        CalibratedImu::new(imu, units, ImuQuantity::full_list(true, true, true), "")
    }

    #[test]
    fn one_correction_does_what_two_in_turn_do() {
        let mut rng = ChaCha8Rng::seed_from_u64(8);
        let (mut first, mut second) = (random(&mut rng), random(&mut rng));
        // the gains of a gyroscope that follow temperature would take its g-sensitivity along
        second.parameters.g_sensitivity = Matrix3::zeros();
        for kind in SensorKind::ALL {
            for order in 0..3 {
                let size = 1e-3 / 20f64.powi(order as i32);
                first.parameters.thermal[kind].bias[order] = Vector3::new(size, -2.0 * size, 0.5 * size);
                first.parameters.thermal[kind].scale[order] = Vector3::new(-size, 0.3 * size, size);
            }
        }
        let both = second.after(&first).expect("composed");
        let felt = random(&mut rng).after(&first).expect_err("the second's g-sensitivity").to_string();
        assert!(felt.contains("option `temperature`"), "{felt}");
        let raw: [Vector3<f64>; 2] =
            [9.0, 1.0].map(|size| Vector3::from_fn(|_, _| rng.random_range(-size..size)));
        let corrected = |imu: &CalibratedImu, [a, g]: [Vector3<f64>; 2]| {
            let of = ImuCorrection::of(imu).and_then(|of| of.at(41.0)).expect("regular");
            let force = of.force(&a).expect("there");
            [force, of.rate(&g, &force).expect("there")]
        };
        let in_turn = corrected(&second, corrected(&first, raw));
        for (one, other) in corrected(&both, raw).iter().zip(in_turn) {
            assert!((one - other).norm() < 1e-12, "{one} {other}");
        }
    }

    #[test]
    fn the_uncertainty_is_that_of_the_second_in_the_raw_unit() {
        let mut rng = ChaCha8Rng::seed_from_u64(9);
        let (mut first, mut second) = (random(&mut rng), random(&mut rng));
        first.parameters[SensorKind::Accelerometer].matrix = Matrix3::identity() * 2.0;
        let count = second.quantities.len();
        second.covariance = Some(DMatrix::identity(count, count) * 1e-6);
        let both = second.after(&first).expect("composed");
        let of = |name: &str| {
            let k = both.quantities.iter().position(|quantity| quantity.name() == name).expect(name);
            both.covariance.as_ref().expect("known")[(k, k)].sqrt()
        };
        assert!((of("accelerometer.bias.x") - 2e-3).abs() < 1e-12);
        assert!((of("accelerometer.matrix.xy") - 2e-3).abs() < 1e-12);
        second.quantities.truncate(3);
        second.covariance = Some(DMatrix::identity(3, 3));
        // the accelerometer's bias, and what the first's g-sensitivity makes of it
        assert_eq!(second.after(&first).expect("composed").quantities.len(), 6);
    }
}
