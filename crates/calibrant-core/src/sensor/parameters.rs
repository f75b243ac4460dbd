//! The parameters of a sensor: the one list that drives tables, results, errors and plots.

use super::{Axis, NonlinearTerm, Nonlinearity, ReadingUnit};
use nalgebra::{DVector, Matrix3, Vector3};
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

/// The values of a sensor's parameters: `y = matrix · s + bias` (true → raw), bent by the terms of its [`Nonlinearity`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorParameters {
    /// Bias `b`, in the unit of the readings.
    pub bias: Vector3<f64>,
    /// Matrix `S`, in the unit of the readings per m/s².
    pub matrix: Matrix3<f64>,
    /// What bends the response; none where it is linear.
    pub nonlinearity: Nonlinearity,
}

impl SensorParameters {
    /// A perfect sensor: no bias, unit matrix.
    #[must_use]
    pub fn identity() -> Self {
        Self::linear(Vector3::zeros(), Matrix3::identity())
    }

    /// A sensor of linear response.
    #[must_use]
    pub fn linear(bias: Vector3<f64>, matrix: Matrix3<f64>) -> Self {
        Self { bias, matrix, nonlinearity: Nonlinearity::default() }
    }

    /// The noiseless reading of stimulus `s`: `S s + b`, bent.
    #[must_use]
    pub fn reading(&self, stimulus: &Vector3<f64>) -> Vector3<f64> {
        let straight = self.matrix * stimulus;
        if self.nonlinearity.is_none() {
            return straight + self.bias;
        }
        let gains = self.gains();
        Vector3::from_fn(|axis, _| {
            straight[axis]
                + gains[axis] * self.nonlinearity.bend(axis, straight[axis] / gains[axis])
                + self.bias[axis]
        })
    }

    /// Derivative of the reading with respect to the stimulus: `S`, each row times the slope of its axis.
    #[must_use]
    pub fn by_stimulus(&self, stimulus: &Vector3<f64>) -> Matrix3<f64> {
        if self.nonlinearity.is_none() {
            return self.matrix;
        }
        Matrix3::from_diagonal(&self.slopes(stimulus)) * self.matrix
    }

    /// The reading of an axis beyond its bias: `ρ h(u)`.
    #[must_use]
    pub fn response(&self, axis: usize, stimulus: &Vector3<f64>) -> f64 {
        let straight = self.matrix.row(axis).transpose().dot(stimulus);
        if self.nonlinearity.is_none() {
            return straight;
        }
        let gain = self.matrix.row(axis).norm();
        straight + gain * self.nonlinearity.bend(axis, straight / gain)
    }

    /// `h′(u)` of each axis at a stimulus.
    fn slopes(&self, stimulus: &Vector3<f64>) -> Vector3<f64> {
        let along = self.along_axes(stimulus);
        Vector3::from_fn(|axis, _| self.nonlinearity.slope(axis, along[axis]))
    }

    /// `ρ`: the gain of each axis, the norm of its row of `S`, whatever the true frame.
    #[must_use]
    pub fn gains(&self) -> Vector3<f64> {
        Vector3::from_fn(|axis, _| self.matrix.row(axis).norm())
    }

    /// `u = S s/ρ`: the stimulus along the sensitive direction of each axis.
    #[must_use]
    pub fn along_axes(&self, stimulus: &Vector3<f64>) -> Vector3<f64> {
        (self.matrix * stimulus).component_div(&self.gains())
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
    /// The coefficient of a term that bends the response; printed `second_order.x`.
    Nonlinear(NonlinearTerm, Axis),
}

impl Quantity {
    /// Its name among the parameters of one sensor, as in designs: `bias.x`.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Bias(axis) => format!("bias.{axis}"),
            Self::Scale(axis) => format!("scale.{axis}"),
            Self::CrossAxis(row, column) | Self::Symmetric(row, column) => format!("matrix.{row}{column}"),
            Self::Nonlinear(term, axis) => format!("{}.{axis}", term.name()),
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
            (Self::Nonlinear(term, _), _) => term.unit(),
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
            Self::Nonlinear(term, axis) => sensor.nonlinearity.of(term)[axis.index()],
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
            Self::Nonlinear(term, axis) => sensor.nonlinearity.of_mut(term)[axis.index()] += step,
        }
    }

    /// The axis whose reading it moves, of a symmetric pair the first.
    #[must_use]
    pub fn axis(self) -> Axis {
        match self {
            Self::Bias(axis) | Self::Nonlinear(_, axis) => axis,
            Self::Scale(row) | Self::CrossAxis(row, _) | Self::Symmetric(row, _) => row,
        }
    }

    /// Row and column in `S`, of a symmetric pair those of the first; `None` for what is no entry of `S`.
    #[must_use]
    pub fn entry(self) -> Option<(Axis, Axis)> {
        match self {
            Self::Scale(axis) => Some((axis, axis)),
            Self::CrossAxis(row, column) | Self::Symmetric(row, column) => Some((row, column)),
            Self::Bias(_) | Self::Nonlinear(..) => None,
        }
    }

    /// Derivative of a sensor's [reading](SensorParameters::reading) with respect to it, at a stimulus.
    ///
    /// # Numerics
    /// `∂y_i/∂S_ij = h′ s_j + (S_ij/ρ) (h − u h′)`: the second part is that of the gain `ρ`, and zero where the response is linear.
    #[must_use]
    pub fn derivative(self, sensor: &SensorParameters, stimulus: &Vector3<f64>) -> Vector3<f64> {
        let mut derivative = Vector3::zeros();
        let entry = |row: Axis, column: Axis| {
            let (row, column, bends) = (row.index(), column.index(), &sensor.nonlinearity);
            if bends.is_none() {
                return stimulus[column];
            }
            let gain = sensor.matrix.row(row).norm();
            let u = sensor.matrix.row(row).transpose().dot(stimulus) / gain;
            let slope = bends.slope(row, u);
            slope * stimulus[column]
                + sensor.matrix[(row, column)] / gain * (u + bends.bend(row, u) - u * slope)
        };
        match self {
            Self::Bias(axis) => derivative[axis.index()] = 1.0,
            Self::Scale(axis) => derivative[axis.index()] = entry(axis, axis),
            Self::CrossAxis(row, column) => derivative[row.index()] = entry(row, column),
            Self::Symmetric(row, column) => {
                derivative[row.index()] = entry(row, column);
                derivative[column.index()] = entry(column, row);
            }
            Self::Nonlinear(term, axis) => {
                let row = sensor.matrix.row(axis.index()).transpose();
                derivative[axis.index()] = row.norm() * term.value(row.dot(stimulus) / row.norm());
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

    /// The same with the coefficients of these terms, one for each axis of three.
    #[must_use]
    pub fn with_terms(mut self, terms: &[NonlinearTerm]) -> Self {
        let coefficients =
            terms.iter().flat_map(|&term| Axis::ALL.map(|axis| Quantity::Nonlinear(term, axis)));
        self.quantities.extend(coefficients);
        self
    }

    /// The sensor with these values; what is not in the list is zero.
    #[must_use]
    pub fn sensor(&self, values: &DVector<f64>) -> SensorParameters {
        let mut sensor = SensorParameters::linear(Vector3::zeros(), Matrix3::zeros());
        for (quantity, value) in self.quantities.iter().zip(values.iter()) {
            quantity.add_to(&mut sensor, *value);
        }
        sensor
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
