//! The model of a calibration: what calibrations of one kind of sensor share, so that a database has it once. And what a calibration has beside it.
//!
//! It is calibrant JSON with zero in place of each estimate. Added to zero, the estimates come back to the last bit.

use calibrant_core::sensor::{CalibratedImu, CovarianceDegrees, ImuFields, SharedErrors, Thermal};
use calibrant_io::{ImuCore, to_json};
use nalgebra::DMatrix;

/// The text of the model of an IMU.
pub(crate) fn text_of(imu: &CalibratedImu) -> String {
    let mut model = CalibratedImu { covariance: None, degrees_of_freedom: None, shared: None, ..imu.clone() };
    for quantity in &imu.quantities {
        quantity.add_to(&mut model.parameters, -quantity.value(&imu.parameters));
    }
    let none = Thermal::none();
    (model.parameters.thermal.reference_c, model.parameters.thermal.range_c) =
        (none.reference_c, none.range_c);
    to_json(&ImuFields::of(model))
}

/// The IMU of a model's text; all its estimates are zero.
pub(crate) fn read(text: &str) -> Option<CalibratedImu> {
    let core: ImuCore = serde_json::from_str(text).ok()?;
    Some(core.into_imu().ok()?.0)
}

/// What a calibration has beside its model and its estimates.
pub(crate) struct Further {
    pub(crate) reference_c: Option<f64>,
    pub(crate) range_c: Option<[f64; 2]>,
    /// Degrees of freedom behind the covariance: accelerometer, gyroscope at rest, matrix of the gyroscope.
    pub(crate) degrees: Option<[f64; 3]>,
    /// The lower triangle by rows.
    pub(crate) covariance: Option<Vec<f64>>,
    pub(crate) shared: Option<SharedErrors>,
}

impl Further {
    /// Of an IMU.
    pub(crate) fn of(imu: &CalibratedImu) -> Self {
        let thermal = &imu.parameters.thermal;
        let triangle = |sigma: &DMatrix<f64>| {
            let entry = |i: usize| (0..=i).map(move |j| sigma[(i, j)]);
            (0..sigma.nrows()).flat_map(entry).collect()
        };
        let degrees =
            |CovarianceDegrees { accelerometer, gyroscope_at_rest, gyroscope_matrix }: CovarianceDegrees| {
                [accelerometer, gyroscope_at_rest, gyroscope_matrix]
            };
        Self {
            reference_c: imu.follows_temperature().then_some(thermal.reference_c),
            range_c: thermal.range_c.filter(|_| imu.follows_temperature()),
            degrees: imu.degrees_of_freedom.map(degrees),
            covariance: imu.covariance.as_ref().map(triangle),
            shared: imu.shared.clone(),
        }
    }

    /// The IMU of a model with these estimates. `None` where the sizes do not fit.
    pub(crate) fn onto(self, model: &CalibratedImu, estimates: &[f64]) -> Option<CalibratedImu> {
        let size = model.quantities.len();
        if estimates.len() != size {
            return None;
        }
        let mut imu = model.clone();
        for (quantity, value) in model.quantities.iter().zip(estimates) {
            quantity.add_to(&mut imu.parameters, *value);
        }
        if let Some(reference_c) = self.reference_c {
            (imu.parameters.thermal.reference_c, imu.parameters.thermal.range_c) =
                (reference_c, self.range_c);
        }
        imu.covariance = match self.covariance {
            Some(triangle) if triangle.len() == size * (size + 1) / 2 => {
                let at = |i: usize, j: usize| triangle[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)];
                Some(DMatrix::from_fn(size, size, at))
            }
            Some(_) => return None,
            None => None,
        };
        imu.degrees_of_freedom = self.degrees.map(|[accelerometer, gyroscope_at_rest, gyroscope_matrix]| {
            CovarianceDegrees { accelerometer, gyroscope_at_rest, gyroscope_matrix }
        });
        imu.shared = self.shared;
        Some(imu)
    }
}
