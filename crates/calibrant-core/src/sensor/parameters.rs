//! The parameters of a sensor: the one list that drives tables, results, errors and plots.

use super::{Axis, ReadingUnit};
use nalgebra::{Matrix3, Vector3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which errors a sensor's model has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SensorModel {
    /// `S` is diagonal. Each axis has a bias and a scale factor, independent of the other axes.
    ScaleBias,
    /// `S` is a full 3×3 matrix: bias, scale factors and cross-axis sensitivities.
    Full,
}

/// The values of a sensor's parameters: `y = matrix · s + bias` (true → raw).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorParameters {
    /// Bias `b`, in the unit of the readings.
    pub bias: Vector3<f64>,
    /// Matrix `S`, in the unit of the readings per m/s².
    pub matrix: Matrix3<f64>,
}

impl SensorParameters {
    /// A perfect sensor: no bias, unit matrix.
    #[must_use]
    pub fn identity() -> Self {
        Self { bias: Vector3::zeros(), matrix: Matrix3::identity() }
    }

    /// The noiseless reading of stimulus `s`: `S s + b`.
    #[must_use]
    pub fn reading(&self, stimulus: &Vector3<f64>) -> Vector3<f64> {
        self.matrix * stimulus + self.bias
    }
}

/// One scalar quantity of the sensor model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Entry of the bias `b`; printed `bias.x`.
    Bias(Axis),
    /// Diagonal entry of `S`; printed `scale.x`.
    Scale(Axis),
    /// Off-diagonal entry of `S`, (row, column): the response of reading `row` to stimulus `column`; printed
    /// `matrix.xy`.
    CrossAxis(Axis, Axis),
    /// The same entry above and below the diagonal of `S`, in the symmetric gauge; printed `matrix.xy`.
    Symmetric(Axis, Axis),
}

impl Quantity {
    /// Its name among the parameters of one sensor, as in designs: `bias.x`.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Bias(axis) => format!("bias.{axis}"),
            Self::Scale(axis) => format!("scale.{axis}"),
            Self::CrossAxis(row, column) | Self::Symmetric(row, column) => format!("matrix.{row}{column}"),
        }
    }

    /// Its name as calibrations and errors have it, as a parameter of an accelerometer: `accelerometer.bias.x`.
    #[must_use]
    pub fn name_in_results(self) -> String {
        format!("accelerometer.{}", self.name())
    }

    /// Its unit, for readings in this unit. The scale factor of readings in m/s² is a pure number, printed as `1`.
    #[must_use]
    pub fn unit(self, reading: ReadingUnit) -> &'static str {
        match (self, reading) {
            (Self::Bias(_), unit) => unit.symbol(),
            (_, ReadingUnit::MetrePerSecondSquared | ReadingUnit::RadianPerSecond) => "1",
            (_, ReadingUnit::Counts) => "counts/(m/s²)",
        }
    }

    /// Its value in a sensor.
    #[must_use]
    pub fn value(self, sensor: &SensorParameters) -> f64 {
        match self {
            Self::Bias(axis) => sensor.bias[axis.index()],
            Self::Scale(axis) => sensor.matrix[(axis.index(), axis.index())],
            Self::CrossAxis(row, column) | Self::Symmetric(row, column) => {
                sensor.matrix[(row.index(), column.index())]
            }
        }
    }

    /// Adds `step` to it.
    pub fn add_to(self, sensor: &mut SensorParameters, step: f64) {
        match self {
            Self::Bias(axis) => sensor.bias[axis.index()] += step,
            Self::Scale(axis) => sensor.matrix[(axis.index(), axis.index())] += step,
            Self::CrossAxis(row, column) => sensor.matrix[(row.index(), column.index())] += step,
            Self::Symmetric(row, column) => {
                sensor.matrix[(row.index(), column.index())] += step;
                sensor.matrix[(column.index(), row.index())] += step;
            }
        }
    }

    /// Derivative of the reading `S s + b` with respect to it.
    #[must_use]
    pub fn derivative(self, stimulus: &Vector3<f64>) -> Vector3<f64> {
        let mut derivative = Vector3::zeros();
        match self {
            Self::Bias(axis) => derivative[axis.index()] = 1.0,
            Self::Scale(axis) => derivative[axis.index()] = stimulus[axis.index()],
            Self::CrossAxis(row, column) => derivative[row.index()] = stimulus[column.index()],
            Self::Symmetric(row, column) => {
                derivative[row.index()] = stimulus[column.index()];
                derivative[column.index()] = stimulus[row.index()];
            }
        }
        derivative
    }
}

/// The quantities that are estimated, in their order.
///
/// Biases come first, then the diagonal of `S`, then its off-diagonal entries row by row. So the scale-bias
/// model's list begins the full model's.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ParameterList {
    quantities: Vec<Quantity>,
}

impl ParameterList {
    /// The parameters of a model: 2 for one axis, 6 for scale-bias, 12 for full.
    #[must_use]
    pub fn new(axes: usize, model: SensorModel) -> Self {
        let axes = &Axis::ALL[..axes];
        let mut quantities: Vec<_> = axes.iter().map(|&axis| Quantity::Bias(axis)).collect();
        quantities.extend(axes.iter().map(|&axis| Quantity::Scale(axis)));
        if model == SensorModel::Full {
            for &row in axes {
                quantities.extend(
                    axes.iter()
                        .filter(|&&column| column != row)
                        .map(|&column| Quantity::CrossAxis(row, column)),
                );
            }
        }
        Self { quantities }
    }

    /// A list of quantities that the caller chooses.
    #[must_use]
    pub fn from_quantities(quantities: Vec<Quantity>) -> Self {
        Self { quantities }
    }

    /// The quantities, in order.
    #[must_use]
    pub fn quantities(&self) -> &[Quantity] {
        &self.quantities
    }

    /// Number of parameters.
    #[must_use]
    pub fn len(&self) -> usize {
        self.quantities.len()
    }

    /// Is there none?
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.quantities.is_empty()
    }

    /// The names, in order.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        self.quantities.iter().map(|quantity| quantity.name()).collect()
    }

    /// The names as calibrations have them: `accelerometer.bias.x`.
    #[must_use]
    pub fn names_in_results(&self) -> Vec<String> {
        self.quantities.iter().map(|quantity| quantity.name_in_results()).collect()
    }

    /// Position of the parameter of this name: `bias.x`, or `accelerometer.bias.x` as calibrations have it.
    #[must_use]
    pub fn position(&self, name: &str) -> Option<usize> {
        let name = name.strip_prefix("accelerometer.").unwrap_or(name);
        self.quantities.iter().position(|quantity| quantity.name() == name)
    }
}
