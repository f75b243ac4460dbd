//! The entries of an IMU's model as one vector: biases, matrices, g-sensitivity and temperature terms. It is
//! the coordinate system of all changes of frame and reference.
//!
//! The order is `b_a` (3), `S_a` row by row (9), `b_g` (3), `S_g` (9), `Γ` (9). Then come `b_1`, `b_2` and so on,
//! `k_1`, `k_2` and so on (3 each) of each sensor, and the coefficients that bend the accelerometer's response (3 of each term). Derivatives of results that depend on an IMU are taken with respect
//! to these entries. A covariance of any list of quantities becomes a covariance of the entries.

use super::{
    Axis, CalibratedImu, HIGHEST_ORDER, ImuParameters, ImuQuantity, NonlinearTerm, ParameterList, PerSensor,
    Quantity, SensorKind, SensorParameters, SensorThermal, SharedErrors, Thermal, ThermalPart,
};
use nalgebra::{DMatrix, Matrix3, SMatrix, SVector, Vector3};

/// Number of entries.
pub(crate) const ENTRIES: usize = LINEAR + 3 * NonlinearTerm::ALL.len();

/// Number of entries of a linear response; they come first.
pub(crate) const LINEAR: usize = AT_REFERENCE + 2 * THERMAL_OF_SENSOR;

/// Number of entries that are not temperature terms; they come first.
pub(crate) const AT_REFERENCE: usize = 33;

/// Number of temperature terms of one sensor.
const THERMAL_OF_SENSOR: usize = 2 * 3 * HIGHEST_ORDER;

/// A value for each entry.
pub(super) type EntryVector = SVector<f64, ENTRIES>;

/// A matrix over the entries.
pub(super) type EntryMatrix = SMatrix<f64, ENTRIES, ENTRIES>;

/// Place of the bias of an axis.
pub(super) fn bias(sensor_kind: SensorKind, axis: usize) -> usize {
    first(sensor_kind) + axis
}

/// Place of an entry of a sensor's matrix.
pub(super) fn matrix(sensor_kind: SensorKind, row: usize, column: usize) -> usize {
    first(sensor_kind) + 3 + 3 * row + column
}

/// Place of an entry of `Γ`.
pub(super) fn g_sensitivity(row: usize, column: usize) -> usize {
    24 + 3 * row + column
}

/// Place of a temperature term.
pub(super) fn thermal(sensor_kind: SensorKind, part: ThermalPart, order: usize, axis: usize) -> usize {
    let of_sensor = match sensor_kind {
        SensorKind::Accelerometer => 0,
        SensorKind::Gyroscope => THERMAL_OF_SENSOR,
    };
    let of_part = match part {
        ThermalPart::Bias => 0,
        ThermalPart::Scale => 3 * HIGHEST_ORDER,
    };
    AT_REFERENCE + of_sensor + of_part + 3 * (order - 1) + axis
}

/// Place of the coefficient of a term that bends the accelerometer's response.
pub(super) fn nonlinear(term: NonlinearTerm, axis: usize) -> usize {
    LINEAR + 3 * term as usize + axis
}

fn first(sensor_kind: SensorKind) -> usize {
    match sensor_kind {
        SensorKind::Accelerometer => 0,
        SensorKind::Gyroscope => 12,
    }
}

/// The entries of an IMU.
pub(super) fn from_parameters(imu: &ImuParameters) -> EntryVector {
    let mut entries = EntryVector::zeros();
    for sensor_kind in SensorKind::ALL {
        let sensor = imu.sensor(sensor_kind);
        for row in 0..3 {
            entries[bias(sensor_kind, row)] = sensor.bias[row];
            for column in 0..3 {
                entries[matrix(sensor_kind, row, column)] = sensor.matrix[(row, column)];
            }
        }
    }
    for row in 0..3 {
        for column in 0..3 {
            entries[g_sensitivity(row, column)] = imu.g_sensitivity[(row, column)];
        }
    }
    for sensor_kind in SensorKind::ALL {
        let terms = imu.thermal.sensor(sensor_kind);
        for order in 1..=HIGHEST_ORDER {
            for axis in 0..3 {
                entries[thermal(sensor_kind, ThermalPart::Bias, order, axis)] = terms.bias[order - 1][axis];
                entries[thermal(sensor_kind, ThermalPart::Scale, order, axis)] = terms.scale[order - 1][axis];
            }
        }
    }
    for term in NonlinearTerm::ALL {
        for axis in 0..3 {
            entries[nonlinear(term, axis)] = imu[SensorKind::Accelerometer].nonlinearity.of(term)[axis];
        }
    }
    entries
}

/// An IMU with these entries: the inverse of [`from_parameters`]. The reference
/// temperature is not among the entries.
pub(super) fn to_imu(entries: &EntryVector) -> ImuParameters {
    let sensor = |sensor_kind| {
        SensorParameters::linear(
            Vector3::from_fn(|row, _| entries[bias(sensor_kind, row)]),
            Matrix3::from_fn(|row, column| entries[matrix(sensor_kind, row, column)]),
        )
    };
    let mut sensors = PerSensor::from_fn(sensor);
    for term in NonlinearTerm::ALL {
        *sensors[SensorKind::Accelerometer].nonlinearity.of_mut(term) =
            Vector3::from_fn(|axis, _| entries[nonlinear(term, axis)]);
    }
    let sensor_thermal = |sensor_kind| {
        let of = |part| {
            std::array::from_fn(|m| {
                Vector3::from_fn(|axis, _| entries[thermal(sensor_kind, part, m + 1, axis)])
            })
        };
        SensorThermal { bias: of(ThermalPart::Bias), scale: of(ThermalPart::Scale) }
    };
    ImuParameters {
        sensors,
        g_sensitivity: Matrix3::from_fn(|row, column| entries[g_sensitivity(row, column)]),
        thermal: Thermal { sensors: PerSensor::from_fn(sensor_thermal), ..Thermal::none() },
    }
}

/// What one unit of a quantity adds to the entries.
pub(super) fn of_quantity(quantity: ImuQuantity) -> EntryVector {
    let mut imu = to_imu(&EntryVector::zeros());
    quantity.add_to(&mut imu, 1.0);
    from_parameters(&imu)
}

/// Covariance of the entries of an IMU, zero where they are known exactly; `None` where the IMU has no
/// covariance.
pub(super) fn covariance(imu: &CalibratedImu) -> Option<EntryMatrix> {
    let sigma = imu.covariance.as_ref()?;
    let embedding = embedding(imu);
    let entries = &embedding * sigma * embedding.transpose();
    Some(EntryMatrix::from_fn(|i, j| 0.5 * (entries[(i, j)] + entries[(j, i)])))
}

/// What one unit of each quantity of an IMU adds to the entries: a column for each.
fn embedding(imu: &CalibratedImu) -> DMatrix<f64> {
    let columns: Vec<_> = imu.quantities.iter().map(|&quantity| of_quantity(quantity)).collect();
    DMatrix::from_fn(ENTRIES, columns.len(), |entry, k| columns[k][entry])
}

/// Covariance and shared errors of these quantities after a change of the entries with this derivative. The first
/// entry of a quantity gives its value: both entries of a symmetric pair are the same.
pub(super) fn transformed(
    imu: &CalibratedImu,
    jacobian: impl FnOnce() -> EntryMatrix,
    quantities: &[ImuQuantity],
) -> (Option<DMatrix<f64>>, Option<SharedErrors>) {
    let Some(sigma) = covariance(imu) else { return (None, None) };
    let jacobian = jacobian();
    let sigma = jacobian * sigma * jacobian.transpose();
    let place: Vec<usize> = quantities.iter().map(|&quantity| of_quantity(quantity).imax()).collect();
    let symmetric = |i: usize, j: usize| 0.5 * (sigma[(i, j)] + sigma[(j, i)]);
    let covariance = DMatrix::from_fn(place.len(), place.len(), |i, j| symmetric(place[i], place[j]));
    let shared = imu.shared.as_ref().map(|shared| SharedErrors {
        sources: shared.sources.clone(),
        root: (jacobian * embedding(imu) * &shared.root).select_rows(&place),
    });
    (Some(covariance), shared)
}

impl ImuQuantity {
    /// Every quantity of the model of these sensors, one for each entry of the vector. Their order is not that of the entries.
    #[must_use]
    pub fn all(accelerometer: bool, gyroscope: bool) -> Vec<Self> {
        let mut all = Self::full_list(accelerometer, gyroscope, gyroscope);
        all.extend(Self::all_thermal(accelerometer, gyroscope));
        if accelerometer {
            let terms = ParameterList::from_quantities(Vec::new()).with_terms(&NonlinearTerm::ALL);
            all.extend(terms.of_accelerometer());
        }
        all
    }

    /// Every quantity of a full model, in the order of a result. Each sensor that is there has its bias,
    /// scale factors and cross-axis sensitivities. The g-sensitivity follows.
    #[must_use]
    pub fn full_list(accelerometer: bool, gyroscope: bool, g_sensitivity: bool) -> Vec<Self> {
        let mut list = Vec::new();
        for (sensor_kind, there) in
            [(SensorKind::Accelerometer, accelerometer), (SensorKind::Gyroscope, gyroscope)]
        {
            if there {
                list.extend(Axis::ALL.map(|axis| Self::Of(sensor_kind, Quantity::Bias(axis))));
                list.extend(Axis::ALL.map(|axis| Self::Of(sensor_kind, Quantity::Scale(axis))));
                let pairs = Axis::ALL.into_iter().flat_map(|row| Axis::ALL.map(|column| (row, column)));
                list.extend(
                    pairs
                        .filter(|(row, column)| row != column)
                        .map(|(row, column)| Self::Of(sensor_kind, Quantity::CrossAxis(row, column))),
                );
            }
        }
        if g_sensitivity {
            let pairs = Axis::ALL.into_iter().flat_map(|row| Axis::ALL.map(|column| (row, column)));
            list.extend(pairs.map(|(row, column)| Self::GSensitivity(row, column)));
        }
        list
    }

    /// Is it an entry of the matrix of this sensor, on the diagonal or off it? A bias is not.
    #[must_use]
    pub(super) fn in_matrix_of(self, sensor_kind: SensorKind) -> bool {
        matches!(self, Self::Of(of, quantity) if of == sensor_kind && quantity.entry().is_some())
    }
}

/// Derivative of the entries of an IMU after a change with respect to the entries before. `linear` gives the
/// effect of a small step.
pub(super) fn jacobian(linear: impl Fn(&ImuParameters) -> ImuParameters) -> EntryMatrix {
    let mut jacobian = EntryMatrix::zeros();
    for entry in 0..ENTRIES {
        let mut step = EntryVector::zeros();
        step[entry] = 1.0;
        jacobian.set_column(entry, &from_parameters(&linear(&to_imu(&step))));
    }
    jacobian
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_go_there_and_back_and_every_quantity_has_its_place() {
        let entries = EntryVector::from_fn(|k, _| k as f64 + 1.0);
        assert_eq!(from_parameters(&to_imu(&entries)), entries);
        let imu = to_imu(&entries);
        let all = ImuQuantity::all(true, true);
        for quantity in &all {
            assert_eq!(of_quantity(*quantity).dot(&entries), quantity.value(&imu), "{}", quantity.name());
        }
        assert_eq!(ImuQuantity::full_list(true, true, true).len(), AT_REFERENCE);
        assert_eq!(all.len(), ENTRIES);
    }
}
