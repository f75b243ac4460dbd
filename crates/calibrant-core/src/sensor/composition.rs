//! Two calibrations one after the other: the second was made of readings that the first had corrected.
//!
//! The first corrects a reading, `y = S₁ y' + b₁`, and the second was made of what came out, `y' = S₂ s + b₂`. Together `y = S₁ S₂ s + S₁ b₂ + b₁`.
//! The first's correction of the gyroscope takes away `Γ₁ f'` with `f' = S₂ f + b₂` of the accelerometer, so that `Γ = S₁ Γ₂ + Γ₁ S₂` and its bias gains `Γ₁ b₂`.
//!
//! The numbers of the first are those that the readings were corrected with, whatever their uncertainty. The covariance is that of the second.

use super::{CalibratedImu, ImuParameters, ImuQuantity, PerSensor, ReadingUnit, SensorKind, entry_vector};
use crate::error::{Error, InputError, Refusal, Result};

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
    /// [`Error::Experiment`] where `first` has not the same sensors, where this one is of counts, or where either follows temperature or bends the response.
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
        for imu in [first, self] {
            if imu.follows_temperature() || !imu.parameters[a].nonlinearity.is_none() {
                return refuse(
                    "terms of temperature, or that bend the response, are not carried through a second calibration".into(),
                    "take both at one temperature first, with option `temperature`; or calibrate raw readings of both sessions again",
                );
            }
        }
        let felt = first.parameters.g_sensitivity != nalgebra::Matrix3::zeros();
        if self.unit(g).is_some() && self.unit(a).is_none() && felt {
            return refuse(
                "the earlier correction of the gyroscope takes the accelerometer's readings, and this calibration has no accelerometer".into(),
                "calibrate both sensors",
            );
        }
        let mut parameters = first.parameters.through(&self.parameters);
        let mut quantities = ImuQuantity::full_list(self.unit(a).is_some(), self.unit(g).is_some(), true);
        for (kind, _) in self.units.present() {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::ImuCorrection;
    use nalgebra::{DMatrix, Matrix3, Vector3};
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
        let (first, second) = (random(&mut rng), random(&mut rng));
        let both = second.after(&first).expect("composed");
        let raw: [Vector3<f64>; 2] =
            [9.0, 1.0].map(|size| Vector3::from_fn(|_, _| rng.random_range(-size..size)));
        let corrected = |imu: &CalibratedImu, [a, g]: [Vector3<f64>; 2]| {
            let of = ImuCorrection::of(imu).and_then(|of| of.at(25.0)).expect("regular");
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
