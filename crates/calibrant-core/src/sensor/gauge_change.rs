//! The change of the true frame of a whole IMU: it turns both sensors and their covariance together.
//!
//! `S` and `S R` describe the same sensor in two true frames. A gauge (see [`Gauge`]) picks the frame by the
//! form of one sensor's matrix, the accelerometer's where there is one. The other sensor and the
//! g-sensitivity take the same rotation: `S_a' = S_a R`, `S_g' = S_g R`, `Γ' = Γ R`. Biases and temperature
//! coefficients do not change: `D S` becomes `D S R`.
//!
//! `R` depends on `S_a`, so an error of `S_a` turns everything: `dS' = dS R + S' [δ]×`. The small rotation
//! `δ` keeps the form of the reference sensor's matrix. The three entries (or differences of entries) that
//! the gauge sets to zero stay zero, which gives three linear equations for `δ`. This is the exact Jacobian,
//! and the covariance follows to first order.

use super::entry_vector::{self, EntryMatrix};
use super::{Axis, CalibratedImu, Gauge, ImuParameters, ImuQuantity, Quantity, SensorKind, SensorModel};
use crate::error::{Error, InputError, Refusal, Result};
use nalgebra::{Matrix3, Vector3};

/// `S R` in a gauge, and `R`.
struct RotatedImu {
    imu: ImuParameters,
    rotation: Matrix3<f64>,
    gauge: Gauge,
    reference: SensorKind,
    /// `δ` for the residuals of the form: `−(∂ residuals of S' [δ]× / ∂δ)⁻¹`.
    restoring: Matrix3<f64>,
}

impl Gauge {
    /// What this gauge sets to zero: three entries of the matrix, or differences of entries.
    fn residuals(self, s: &Matrix3<f64>) -> Vector3<f64> {
        match self {
            Self::Lower => Vector3::new(s[(0, 1)], s[(0, 2)], s[(1, 2)]),
            Self::Upper => Vector3::new(s[(1, 0)], s[(2, 0)], s[(2, 1)]),
            Self::Symmetric => {
                Vector3::new(s[(0, 1)] - s[(1, 0)], s[(0, 2)] - s[(2, 0)], s[(1, 2)] - s[(2, 1)])
            }
        }
    }

    /// Has a matrix this form, with a positive diagonal (positive definite where it is symmetric)?
    fn has(self, s: &Matrix3<f64>) -> bool {
        let positive = match self {
            Self::Symmetric => s.cholesky().is_some(),
            _ => s.diagonal().min() > 0.0,
        };
        positive && self.is_form_of(s)
    }

    /// The same matrix, with exact zeros where this gauge sets zeros.
    fn cleaned(self, s: &Matrix3<f64>) -> Matrix3<f64> {
        Matrix3::from_fn(|i, j| match self {
            Self::Lower if j > i => 0.0,
            Self::Upper if j < i => 0.0,
            Self::Symmetric => 0.5 * (s[(i, j)] + s[(j, i)]),
            _ => s[(i, j)],
        })
    }

    /// The gauge whose form a matrix has exactly. `None` where it has no gauge's form, or every gauge's
    /// because it is diagonal.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::sensor::Gauge;
    /// use nalgebra::Matrix3;
    /// let lower = Matrix3::new(1.0, 0.0, 0.0, 0.1, 1.0, 0.0, 0.0, 0.2, 1.0);
    /// assert_eq!(Gauge::of(&lower), Some(Gauge::Lower));
    /// assert_eq!(Gauge::of(&Matrix3::identity()), None);
    /// ```
    #[must_use]
    pub fn of(matrix: &Matrix3<f64>) -> Option<Self> {
        if *matrix == Matrix3::from_diagonal(&matrix.diagonal()) {
            return None;
        }
        Self::ALL.into_iter().find(|gauge| gauge.is_form_of(matrix))
    }

    /// Has a matrix this form exactly? A diagonal one has every form.
    #[must_use]
    pub fn is_form_of(self, matrix: &Matrix3<f64>) -> bool {
        self.residuals(matrix) == Vector3::zeros()
    }
}

impl RotatedImu {
    fn new(imu: &ImuParameters, reference: SensorKind, gauge: Gauge) -> Result<Self> {
        let sensor = imu.sensor(reference);
        let reject = |message: String, help: &str| {
            Err(Error::experiment(InputError::new(Refusal::ConversionImpossible, message, help)))
        };
        let determinant = sensor.matrix.determinant();
        if determinant < 0.0 {
            return reject(
                format!("the axes of the {reference} are left-handed, so no rotation brings it into a gauge"),
                "one axis has the wrong sign: change the sign of its column in the recording and calibrate again",
            );
        }
        // a matrix that has the form already stays as it is, to the last bit
        let target = if gauge.has(&sensor.matrix) {
            sensor.matrix
        } else {
            gauge.cleaned(&gauge.apply(sensor).matrix)
        };
        let svd = sensor.matrix.try_inverse().map(|inverse| (inverse * target).svd(true, true));
        let Some((Some(u), Some(v_t))) = svd.map(|svd| (svd.u, svd.v_t)) else {
            return reject(
                format!("the matrix S of the {reference} is singular"),
                "the calibration is of no use: calibrate again",
            );
        };
        let rotation = if target == sensor.matrix { Matrix3::identity() } else { u * v_t };
        let mut rotated = *imu;
        rotated[SensorKind::Accelerometer].matrix *= rotation;
        rotated[SensorKind::Gyroscope].matrix *= rotation;
        rotated.g_sensitivity *= rotation;
        rotated[reference].matrix = target;
        let column = |k: usize| gauge.residuals(&(target * unit(k).cross_matrix()));
        let derivative = Matrix3::from_columns(&[column(0), column(1), column(2)]);
        let Some(inverse) = derivative.try_inverse() else {
            return reject(
                format!("the {} gauge is not unique for the matrix of the {reference}", gauge.name()),
                "choose another gauge",
            );
        };
        Ok(Self { imu: rotated, rotation, gauge, reference, restoring: -inverse })
    }

    /// The effect of a small step of the entries.
    fn step(&self, step: &ImuParameters) -> ImuParameters {
        let dragged = step.sensor(self.reference).matrix * self.rotation;
        let delta = (self.restoring * self.gauge.residuals(&dragged)).cross_matrix();
        let mut out = *step;
        out[SensorKind::Accelerometer].matrix = step[SensorKind::Accelerometer].matrix * self.rotation
            + self.imu[SensorKind::Accelerometer].matrix * delta;
        out[SensorKind::Gyroscope].matrix = step[SensorKind::Gyroscope].matrix * self.rotation
            + self.imu[SensorKind::Gyroscope].matrix * delta;
        out.g_sensitivity = step.g_sensitivity * self.rotation + self.imu.g_sensitivity * delta;
        out
    }

    /// Derivative of the rotated entries with respect to the entries.
    fn jacobian(&self) -> EntryMatrix {
        entry_vector::jacobian(|step| self.step(step))
    }
}

fn unit(k: usize) -> Vector3<f64> {
    Vector3::from_fn(|i, _| if i == k { 1.0 } else { 0.0 })
}

impl CalibratedImu {
    /// The sensor whose matrix fixes the true frame: the accelerometer where there is one.
    #[must_use]
    pub fn reference(&self) -> SensorKind {
        if self.unit(SensorKind::Accelerometer).is_some() {
            SensorKind::Accelerometer
        } else {
            SensorKind::Gyroscope
        }
    }

    /// The same IMU in the true frame of a gauge of the [reference](Self::reference) sensor. Its covariance
    /// follows to first order.
    ///
    /// This gives up a frame that was known better than the gauge, such as that of a robot's motion. The
    /// covariance loses what it contained about the rotation.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the sensor is left-handed or its matrix singular.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::sensor::{CalibratedImu, Gauge, ImuParameters, ImuQuantity, ReadingUnit, SensorKind};
    /// let mut parameters = ImuParameters::identity();
    /// parameters[SensorKind::Accelerometer].matrix[(0, 1)] = 0.01;
    /// let units = [Some(ReadingUnit::MetrePerSecondSquared), Some(ReadingUnit::RadianPerSecond)];
    /// let imu = CalibratedImu::new(parameters, units, ImuQuantity::full_list(true, true, false), "upper gauge");
    /// let lower = imu.in_gauge(Gauge::Lower)?.parameters;
    /// assert_eq!(lower[SensorKind::Accelerometer].matrix[(0, 1)], 0.0);
    /// assert!((lower[SensorKind::Gyroscope].matrix[(1, 0)] - 0.01).abs() < 1e-4, "the gyroscope rotated with it");
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    pub fn in_gauge(&self, gauge: Gauge) -> Result<Self> {
        self.in_gauge_of(self.reference(), gauge)
    }

    /// The same, with the frame fixed by the matrix of this sensor.
    ///
    /// # Errors
    /// As [`in_gauge`](Self::in_gauge).
    pub fn in_gauge_of(&self, reference: SensorKind, gauge: Gauge) -> Result<Self> {
        let rotated = RotatedImu::new(&self.parameters, reference, gauge)?;
        let quantities = self.rotated_quantities(&rotated);
        let (covariance, shared) = entry_vector::transformed(self, || rotated.jacobian(), &quantities);
        Ok(Self {
            parameters: rotated.imu,
            quantities,
            covariance,
            shared,
            frame: format!(
                "fixed by the {} gauge of the {reference}: its S and the inverse have this form, with a positive diagonal",
                gauge.name()
            ),
            ..*self
        })
    }

    /// The quantities of the covariance after the rotation: all that a listed quantity of the sensor can
    /// contribute to.
    fn rotated_quantities(&self, rotated: &RotatedImu) -> Vec<ImuQuantity> {
        let has_matrix =
            |sensor_kind| self.quantities.iter().any(|quantity| quantity.in_matrix_of(sensor_kind));
        // a diagonal matrix stays diagonal where the quantities contain only its diagonal
        let still = rotated.rotation == Matrix3::identity()
            && self.quantities.iter().all(|quantity| {
                !quantity.in_matrix_of(rotated.reference)
                    || matches!(quantity, ImuQuantity::Of(_, Quantity::Scale(_)))
            });
        let mut list = Vec::new();
        for sensor_kind in SensorKind::ALL {
            let of = |quantity| ImuQuantity::Of(sensor_kind, quantity);
            let listed = |matrix: bool| {
                let belongs = move |quantity: &&ImuQuantity| matches!(quantity, ImuQuantity::Of(of, _) if *of == sensor_kind);
                self.quantities
                    .iter()
                    .filter(belongs)
                    .filter(move |quantity| quantity.in_matrix_of(sensor_kind) == matrix)
                    .copied()
                    .collect::<Vec<_>>()
            };
            list.extend(listed(false));
            if !has_matrix(sensor_kind) {
                continue;
            }
            if still {
                list.extend(listed(true));
            } else if sensor_kind == rotated.reference {
                let form = rotated.gauge.parameter_list(SensorModel::Full);
                let matrix =
                    form.quantities().iter().filter(|quantity| !matches!(quantity, Quantity::Bias(_)));
                list.extend(matrix.map(|&quantity| of(quantity)));
            } else {
                let full = ImuQuantity::full_list(true, true, false);
                list.extend(full.into_iter().filter(|quantity| quantity.in_matrix_of(sensor_kind)));
            }
        }
        if self.quantities.iter().any(|quantity| matches!(quantity, ImuQuantity::GSensitivity(..))) {
            for row in Axis::ALL {
                list.extend(Axis::ALL.map(|column| ImuQuantity::GSensitivity(row, column)));
            }
        }
        let thermal = |quantity: &&ImuQuantity| matches!(quantity, ImuQuantity::Thermal(..));
        list.extend(self.quantities.iter().filter(thermal));
        list
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::sensor::entry_vector::ENTRIES;
    use crate::sensor::{ReadingUnit, SensorParameters, Thermal};
    use nalgebra::DMatrix;

    /// An IMU in counts with everything in it.
    pub(in crate::sensor) fn imu() -> CalibratedImu {
        let parameters = ImuParameters {
            sensors: [
                SensorParameters {
                    bias: Vector3::new(33124.0, 33275.0, 32364.0),
                    matrix: Matrix3::new(414.5, 1.4, 3.7, -2.0, 412.0, 8.8, 0.5, 3.0, 414.6),
                    ..SensorParameters::identity()
                },
                SensorParameters {
                    bias: Vector3::new(32777.0, 32459.0, 32511.0),
                    matrix: Matrix3::new(4778.0, 30.0, -25.0, 14.0, 4764.0, 60.0, -43.0, 22.0, 4774.0),
                    ..SensorParameters::identity()
                },
            ]
            .into(),
            g_sensitivity: Matrix3::new(0.1, 0.02, -0.3, 0.04, 0.2, 0.01, -0.06, 0.05, 0.15),
            thermal: Thermal::none(),
        };
        let quantities = ImuQuantity::full_list(true, true, true);
        let n = quantities.len();
        let root = DMatrix::from_fn(n, n, |i, j| {
            0.01 * f64::from(((7 * i + 3 * j) % 11) as u8) + f64::from(u8::from(i == j))
        });
        CalibratedImu {
            covariance: Some(&root * root.transpose()),
            ..CalibratedImu::new(parameters, [Some(ReadingUnit::Counts); 2], quantities, "")
        }
    }

    #[test]
    fn both_sensors_turn_together() {
        let before = imu();
        for gauge in [Gauge::Lower, Gauge::Upper, Gauge::Symmetric] {
            let after = before.in_gauge(gauge).expect("right-handed");
            let (a, b) = (&before.parameters, &after.parameters);
            let product = |p: &ImuParameters| {
                [
                    p[SensorKind::Accelerometer].matrix * p[SensorKind::Accelerometer].matrix.transpose(),
                    p[SensorKind::Accelerometer].matrix * p[SensorKind::Gyroscope].matrix.transpose(),
                    p.g_sensitivity * p[SensorKind::Gyroscope].matrix.transpose(),
                ]
            };
            for (a, b) in product(a).iter().zip(&product(b)) {
                assert!((a - b).amax() < 1e-13 * a.amax(), "{gauge:?}");
            }
            assert_eq!(Gauge::of(&b[SensorKind::Accelerometer].matrix), Some(gauge));
            assert_eq!(a[SensorKind::Gyroscope].bias, b[SensorKind::Gyroscope].bias);
        }
    }

    #[test]
    fn the_jacobian_is_that_of_differences() {
        let parameters = imu().parameters;
        for reference in SensorKind::ALL {
            for gauge in [Gauge::Lower, Gauge::Upper, Gauge::Symmetric] {
                let jacobian = RotatedImu::new(&parameters, reference, gauge).expect("regular").jacobian();
                for entry in 0..ENTRIES {
                    let h = if entry < 24 { 1e-3 } else { 1e-5 };
                    let at = |step: f64| {
                        let mut moved = entry_vector::from_parameters(&parameters);
                        moved[entry] += step;
                        entry_vector::from_parameters(
                            &RotatedImu::new(&entry_vector::to_imu(&moved), reference, gauge)
                                .expect("regular")
                                .imu,
                        )
                    };
                    let difference = (at(h) - at(-h)) / (2.0 * h);
                    let error = (difference - jacobian.column(entry)).amax();
                    assert!(error < 1e-7, "{reference} {gauge:?} {entry}: {error}");
                }
            }
        }
    }

    #[test]
    fn the_covariance_goes_there_and_back() {
        let lower = imu().in_gauge(Gauge::Lower).expect("regular");
        assert_eq!(lower.quantities.len(), 9 + 12 + 9);
        let back = lower.in_gauge(Gauge::Symmetric).and_then(|imu| imu.in_gauge(Gauge::Upper));
        let back = back.and_then(|imu| imu.in_gauge(Gauge::Lower)).expect("regular");
        let (one, two) = (lower.covariance.expect("kept"), back.covariance.expect("kept"));
        assert!((&one - &two).amax() < 1e-10 * one.amax());
        assert_eq!(lower.quantities, back.quantities);
    }

    #[test]
    fn a_diagonal_sensor_keeps_its_quantities_and_a_left_handed_one_is_refused() {
        let mut one = imu();
        one.parameters[SensorKind::Accelerometer].matrix =
            Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 3.0));
        one.quantities = Gauge::Lower
            .parameter_list(SensorModel::ScaleBias)
            .quantities()
            .iter()
            .map(|&quantity| ImuQuantity::Of(SensorKind::Accelerometer, quantity))
            .collect();
        one.covariance = Some(DMatrix::identity(6, 6));
        let rotated = one.in_gauge(Gauge::Upper).expect("regular");
        assert_eq!(
            (rotated.quantities, rotated.covariance),
            (one.quantities.clone(), one.covariance.clone())
        );
        one.parameters[SensorKind::Accelerometer].matrix[(0, 0)] = -1.0;
        assert!(one.in_gauge(Gauge::Upper).expect_err("left-handed").to_string().contains("left-handed"));
    }
}
