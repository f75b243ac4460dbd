//! The temperature model of an IMU as JSON. The bias of each sensor has the keys in its unit.

use super::{CalibratedImu, ReadingUnit, SensorKind, SensorThermal};
use crate::form::per_axis;
use crate::json::{if_some, named};
use crate::json_object;

/// The formula that the file states.
const FORMULA: &str = "with t = T - reference_c: b(T) = b + bias_per_k t + bias_per_k2 t^2, S(T) = diag(1 + scale_per_k t + scale_per_k2 t^2) S";

/// The temperature model of an IMU that has one.
pub(super) struct ThermalOf<'a>(pub(super) &'a CalibratedImu);

json_object! {
    /// How biases and gains follow temperature.
    ThermalOf<'_> as of {
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
    /// The temperature coefficients of one sensor: `bias_mps2_per_k`, `bias_mps2_per_k2` and so on in its unit.
    TermsOf<'_> as of {
        bias: named(["per_k", "per_k2"].iter().zip(&of.terms.bias).map(|(power, of_bias)| (format!("bias_{}_{power}", of.unit.suffix()), per_axis(of_bias, 3)))),
        scale_per_k: per_axis(&of.terms.scale[0], 3),
        scale_per_k2: per_axis(&of.terms.scale[1], 3),
    }
}
