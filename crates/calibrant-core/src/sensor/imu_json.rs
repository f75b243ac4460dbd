//! A calibrated IMU as JSON: direction, frame, gauge, the unit of each sensor, the named quantities with their covariance,
//! and the temperature model.
//!
//! Values stand twice. The sensors' matrices are complete. The list of parameters has the quantities of the covariance.

use super::{
    CalibratedImu, Correction, CovarianceDegrees, Gauge, HIGHEST_ORDER, ImuQuantity, NonlinearTerm,
    Nonlinearity, PER_K, Quantity, ReadingUnit, SensorKind, SensorThermal,
};
use crate::form::{Form, block, finite, per_axis};
use crate::json::{if_some, named, with_ending};
use crate::json_object;
use nalgebra::Vector3;

/// The words of the field `direction`.
const DIRECTION: &str =
    "true to raw: y_a = S_a f + b_a, y_g = S_g w + b_g + G f; matrix is S, g_sensitivity is G";

/// The words of the field `covariance_of`.
const COVARIANCE_OF: &str =
    "the parameters in their order; entry (i, j) in the unit of parameter i times that of parameter j";

/// A calibrated IMU, or an accelerometer with this number of axes.
pub struct ImuFields {
    /// The IMU.
    pub imu: CalibratedImu,
    /// Number of axes of the accelerometer.
    pub axes: usize,
    /// What was known beforehand of each quantity; empty where that is not said.
    pub knowledge: Vec<ParameterKnowledge>,
}

/// What was known of a parameter before its calibration.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ParameterKnowledge {
    /// The datasheet's value.
    pub nominal: Option<f64>,
    /// The datasheet's standard deviation.
    pub spread_sd: Option<f64>,
    /// The share of its information that comes from a prior.
    pub prior_share: Option<f64>,
}

json_object! {
    ImuFields as of {
        /// What matrices and biases mean.
        direction: DIRECTION,
        /// The true frame, in words.
        frame: &of.imu.frame,
        /// Form of the matrix of the reference sensor, where it has one.
        gauge: of.imu.gauge().map(Gauge::name),
        accelerometer: of.sensor(SensorKind::Accelerometer),
        gyroscope: of.sensor(SensorKind::Gyroscope),
        temperature: if_some(of.imu.follows_temperature().then_some(ThermalOf(&of.imu))),
        parameters: (0..of.imu.quantities.len()).map(|place| ParameterOf { of, place }).collect::<Vec<_>>(),
        /// What the rows of the covariance stand for, and its units.
        covariance_of: COVARIANCE_OF,
        /// Covariance of the parameters; none where it is not known.
        covariance: Form::<Option<Vec<Vec<f64>>>>::form(&of.imu.covariance),
        covariance_degrees_of_freedom: if_some(of.imu.degrees_of_freedom),
        shared_errors: if_some(of.imu.shared.as_ref()),
    }
}

impl ImuFields {
    /// An IMU, of which nothing is said that was known beforehand.
    #[must_use]
    pub fn of(imu: CalibratedImu) -> Self {
        Self { imu, axes: 3, knowledge: Vec::new() }
    }

    fn sensor(&self, sensor_kind: SensorKind) -> Option<SensorOf<'_>> {
        self.imu.unit(sensor_kind).map(|unit| SensorOf { of: self, sensor_kind, unit })
    }
}

struct SensorOf<'a> {
    of: &'a ImuFields,
    sensor_kind: SensorKind,
    unit: ReadingUnit,
}

json_object! {
    /// One sensor. Each quantity has the key in its unit.
    SensorOf<'_> as of {
        /// Unit of its readings.
        reading_unit: of.unit,
        /// Sensitivity, where raw readings are counts: by it they are readings in m/s².
        counts_per_mps2: if_some(of.counts(SensorKind::Accelerometer)),
        /// The same for rad/s.
        counts_per_radps: if_some(of.counts(SensorKind::Gyroscope)),
        bias: with_ending(of.unit.suffix(), per_axis(&of.of.imu.parameters.sensor(of.sensor_kind).bias, of.of.axes)),
        /// `matrix`, or `matrix_counts_per_mps2`, `matrix_counts_per_radps` for readings in counts; and `g_sensitivity_radps_per_mps2` or
        /// `g_sensitivity_counts_per_mps2` of a gyroscope.
        matrices: named(of.matrices()),
        /// What bends the response of each axis, where it is not linear.
        nonlinearity: if_some(Some(of.of.imu.parameters.sensor(of.sensor_kind).nonlinearity).filter(|bends| !bends.is_none()).map(NonlinearityOf)),
        /// Raw to true.
        correction: if_some(Correction::of(of.of.imu.parameters.sensor(of.sensor_kind)).map(|correction| CorrectionOf { of, correction })),
    }
}

impl SensorOf<'_> {
    fn counts(&self, sensor_kind: SensorKind) -> Option<f64> {
        self.of.imu.counts_per_unit[sensor_kind].filter(|_| sensor_kind == self.sensor_kind)
    }

    fn matrices(&self) -> Vec<(&'static str, Vec<Vec<f64>>)> {
        let imu = &self.of.imu.parameters;
        let name = match (self.unit, self.sensor_kind) {
            (ReadingUnit::Counts, SensorKind::Accelerometer) => "matrix_counts_per_mps2",
            (ReadingUnit::Counts, SensorKind::Gyroscope) => "matrix_counts_per_radps",
            _ => "matrix",
        };
        let mut matrices = vec![(name, block(&imu.sensor(self.sensor_kind).matrix, self.of.axes))];
        if self.sensor_kind == SensorKind::Gyroscope {
            let name = match self.unit {
                ReadingUnit::Counts => "g_sensitivity_counts_per_mps2",
                _ => "g_sensitivity_radps_per_mps2",
            };
            matrices.push((name, block(&imu.g_sensitivity, 3)));
        }
        matrices
    }
}

struct NonlinearityOf(Nonlinearity);

json_object! {
    /// The coefficients of the terms that bend the response, and how they do: `second_order_per_mps2`, `gain_by_sign`.
    NonlinearityOf as of {
        /// How readings follow from true values.
        formula: "with r the norms of the rows of S and u = S f / r: y = b + r (u + second_order u^2 + gain_by_sign |u| / 2), each axis by itself",
        terms: named(NonlinearTerm::ALL.map(|term| (term.key(), per_axis(of.0.of(term), 3)))),
    }
}

struct CorrectionOf<'a> {
    of: &'a SensorOf<'a>,
    correction: Correction,
}

json_object! {
    /// Raw to true, for readers of the file.
    CorrectionOf<'_> as correction {
        /// How true values follow from readings.
        direction: match correction.of.sensor_kind {
            SensorKind::Accelerometer if !correction.correction.nonlinearity.is_none() => "raw to true: f = C (r u), with u from y_a = b_a + r h(u) of each axis; matrix is C, the inverse of S",
            SensorKind::Accelerometer => "raw to true: f = C (y_a - b_a); matrix is C, the inverse of S",
            SensorKind::Gyroscope => "raw to true: w = C (y_g - b_g - G f); matrix is C, the inverse of S",
        },
        /// `matrix`, or `matrix_mps2_per_count`, `matrix_radps_per_count` for readings in counts.
        matrix: named([(
            correction_name(correction.of.unit, correction.of.sensor_kind),
            block(&correction.correction.matrix, correction.of.of.axes),
        )]),
    }
}

/// The key of the matrix of a correction.
#[must_use]
pub fn correction_name(unit: ReadingUnit, sensor_kind: SensorKind) -> &'static str {
    match (unit, sensor_kind) {
        (ReadingUnit::Counts, SensorKind::Accelerometer) => "matrix_mps2_per_count",
        (ReadingUnit::Counts, SensorKind::Gyroscope) => "matrix_radps_per_count",
        _ => "matrix",
    }
}

struct ParameterOf<'a> {
    of: &'a ImuFields,
    place: usize,
}

impl ParameterOf<'_> {
    fn quantity(&self) -> ImuQuantity {
        self.of.imu.quantities[self.place]
    }

    /// A fit that did not converge has a covariance of zeros, and no sd.
    fn sd(&self) -> Option<f64> {
        let covariance = self.of.imu.covariance.as_ref()?;
        Some(covariance[(self.place, self.place)]).filter(|variance| *variance > 0.0).map(f64::sqrt)
    }

    fn known(&self) -> ParameterKnowledge {
        self.of.knowledge.get(self.place).copied().unwrap_or_default()
    }
}

json_object! {
    /// A quantity, its value and standard deviation, and what was known of it beforehand.
    ParameterOf<'_> as parameter {
        /// The quantity: `accelerometer.bias.x`.
        name: parameter.quantity().name(),
        /// Unit of its value and of its standard deviation.
        unit: parameter.of.imu.unit_of(parameter.quantity()),
        /// The estimate.
        value: parameter.quantity().value(&parameter.of.imu.parameters),
        /// Its standard deviation, the root of the covariance's diagonal.
        sd: parameter.sd(),
        /// The datasheet's value.
        nominal: if_some(parameter.known().nominal),
        /// The datasheet's standard deviation.
        spread_sd: if_some(parameter.known().spread_sd),
        /// The share of its information that comes from a prior.
        prior_share: if_some(parameter.known().prior_share),
    }
}

json_object! {
    /// Those behind each part of the covariance; none where its size is known.
    CovarianceDegrees as degrees {
        /// Behind the parameters of the accelerometer: the scatter between holds.
        accelerometer: finite(degrees.accelerometer),
        /// Behind the bias and the g-sensitivity of the gyroscope: its scatter between holds.
        gyroscope_at_rest: finite(degrees.gyroscope_at_rest),
        /// Behind the matrix of the gyroscope: the scatter between rotations.
        gyroscope_matrix: finite(degrees.gyroscope_matrix),
    }
}

impl CalibratedImu {
    /// The gauge, where it has one and is not diagonal.
    #[must_use]
    pub fn gauge(&self) -> Option<Gauge> {
        let pair = |quantity: &ImuQuantity| matches!(quantity, ImuQuantity::Of(_, Quantity::Symmetric(..)));
        if self.quantities.iter().any(pair) {
            return Some(Gauge::Symmetric);
        }
        Gauge::of(&self.parameters.sensor(self.reference()).matrix)
    }

    /// Unit of a quantity.
    #[must_use]
    pub fn unit_of(&self, quantity: ImuQuantity) -> &'static str {
        let sensor_kind = quantity.sensor_kind();
        quantity.unit(self.unit(sensor_kind).unwrap_or(sensor_kind.stimulus_unit()))
    }
}

/// The formula that the file states.
const FORMULA: &str = "with t = T - reference_c: b(T) = b + bias_per_k t + bias_per_k2 t^2 + ..., S(T) = diag(1 + scale_per_k t + scale_per_k2 t^2 + ...) S";

/// The temperature model of an IMU that has one.
pub(super) struct ThermalOf<'a>(pub(super) &'a CalibratedImu);

json_object! {
    /// How biases and gains follow temperature.
    ThermalOf<'_> as of {
        /// How bias and scale factors follow the temperature.
        formula: FORMULA,
        reference_c: of.0.parameters.thermal.reference_c,
        /// The temperatures of the recording.
        range_c: of.0.parameters.thermal.range_c,
        accelerometer: if_some(of.terms(SensorKind::Accelerometer)),
        gyroscope: if_some(of.terms(SensorKind::Gyroscope)),
    }
}

impl ThermalOf<'_> {
    fn terms(&self, sensor_kind: SensorKind) -> Option<TermsOf<'_>> {
        let terms = self.0.parameters.thermal.sensor(sensor_kind);
        self.0.unit(sensor_kind).map(|unit| TermsOf { terms, unit })
    }
}

struct TermsOf<'a> {
    terms: &'a SensorThermal,
    unit: ReadingUnit,
}

json_object! {
    /// The temperature coefficients of one sensor: `bias_mps2_per_k`, `bias_mps2_per_k2` and so on in its unit, `scale_per_k`, `scale_per_k2` and so on.
    TermsOf<'_> as of {
        bias: named(of_orders(&format!("bias_{}", of.unit.suffix()), &of.terms.bias)),
        scale: named(of_orders("scale", &of.terms.scale)),
    }
}

/// Those of order 1 and 2, and up to the highest that is not zero.
fn of_orders(name: &str, of: &[Vector3<f64>; HIGHEST_ORDER]) -> Vec<(String, Vec<f64>)> {
    let there = of.iter().rposition(|of| *of != Vector3::zeros()).map_or(0, |highest| highest + 1);
    let fields = PER_K.iter().zip(of).take(there.max(2));
    fields.map(|(power, of)| (format!("{name}_{power}"), per_axis(of, 3))).collect()
}
