//! The temperature model: bias and gain as polynomials of temperature about a reference.
//!
//! With `τ = T − T₀` in K: `b(T) = b + Σ_m b_m τ^m` and `S(T) = diag(1 + Σ_m k_m τ^m) S`. The gain of each
//! sense element drifts, its direction does not; `k_m` in 1/K^m, as datasheets give it. A change of the true
//! frame, `S → S R`, leaves both as they are. The g-sensitivity `Γ` does not follow temperature.

use super::per_sensor::indexed_by_sensor;
use super::{Axis, PerSensor, ReadingUnit, SensorKind};
use nalgebra::Vector3;

/// Highest power of τ.
pub const HIGHEST_ORDER: usize = 5;

/// A unit per K, K² and so on.
macro_rules! per_kelvin {
    ($unit:literal) => {
        [
            concat!($unit, "/K"),
            concat!($unit, "/K²"),
            concat!($unit, "/K³"),
            concat!($unit, "/K⁴"),
            concat!($unit, "/K⁵"),
        ]
    };
}

/// The reference temperature where nothing follows temperature, °C.
const ROOM_C: f64 = 25.0;

/// How the names of each order end: those of fields, constants and columns.
pub const PER_K: [&str; HIGHEST_ORDER] = ["per_k", "per_k2", "per_k3", "per_k4", "per_k5"];

/// The temperature model of an IMU.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thermal {
    /// The reference `T₀`, °C: the temperature at which biases and matrices are given.
    pub reference_c: f64,
    /// Least and greatest temperature at which the terms were determined, °C, where it is known. Beyond it
    /// the polynomials extrapolate.
    pub range_c: Option<[f64; 2]>,
    /// Terms of each sensor.
    pub sensors: PerSensor<SensorThermal>,
}

indexed_by_sensor!(Thermal, SensorThermal);

/// The temperature model of one sensor; entry `m − 1` belongs to the power `τ^m`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SensorThermal {
    /// `b_m`, in the unit of the readings per K^m.
    pub bias: [Vector3<f64>; HIGHEST_ORDER],
    /// `k_m`, in 1/K^m.
    pub scale: [Vector3<f64>; HIGHEST_ORDER],
}

/// The part of the model that follows temperature.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ThermalPart {
    /// The bias.
    Bias,
    /// The gain, as a share of itself.
    Scale,
}

/// One coefficient of a sensor's polynomials.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ThermalTerm {
    /// The part that follows temperature.
    pub part: ThermalPart,
    /// The axis of the sensor.
    pub axis: Axis,
    /// The power of τ, from 1 to [`HIGHEST_ORDER`].
    pub order: usize,
}

impl ThermalTerm {
    /// `bias_per_k.x`, `scale_per_k2.z`.
    #[must_use]
    pub fn name(self) -> String {
        let part = match self.part {
            ThermalPart::Bias => "bias",
            ThermalPart::Scale => "scale",
        };
        format!("{part}_{}.{}", PER_K[self.order - 1], self.axis)
    }

    /// Its unit, for readings in this unit.
    #[must_use]
    pub fn unit(self, reading: ReadingUnit) -> &'static str {
        let of_orders = match (self.part, reading) {
            (ThermalPart::Bias, ReadingUnit::MetrePerSecondSquared) => per_kelvin!("m/s²"),
            (ThermalPart::Bias, ReadingUnit::RadianPerSecond) => per_kelvin!("rad/s"),
            (ThermalPart::Bias, ReadingUnit::Counts) => per_kelvin!("counts"),
            (ThermalPart::Scale, _) => per_kelvin!("1"),
        };
        of_orders[self.order - 1]
    }

    /// `/K` of a first-order term, `/K²` of a second.
    #[must_use]
    pub fn per(self) -> &'static str {
        per_kelvin!("")[self.order - 1]
    }

    /// `τ^m`.
    #[must_use]
    pub fn power(self, tau_k: f64) -> f64 {
        tau_k.powi(self.order as i32)
    }

    /// Its value in a sensor.
    #[must_use]
    pub fn value(self, thermal: &SensorThermal) -> f64 {
        match self.part {
            ThermalPart::Bias => thermal.bias[self.order - 1][self.axis.index()],
            ThermalPart::Scale => thermal.scale[self.order - 1][self.axis.index()],
        }
    }

    /// Adds `step` to it.
    pub fn add_to(self, thermal: &mut SensorThermal, step: f64) {
        match self.part {
            ThermalPart::Bias => thermal.bias[self.order - 1][self.axis.index()] += step,
            ThermalPart::Scale => thermal.scale[self.order - 1][self.axis.index()] += step,
        }
    }
}

impl SensorThermal {
    /// Does nothing follow temperature?
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// The highest order of a part that is not zero.
    #[must_use]
    pub fn order(&self, part: ThermalPart) -> usize {
        let of_orders = match part {
            ThermalPart::Bias => &self.bias,
            ThermalPart::Scale => &self.scale,
        };
        of_orders.iter().rposition(|of| *of != Vector3::zeros()).map_or(0, |highest| highest + 1)
    }

    /// `Σ_m b_m τ^m`, in the unit of the readings.
    #[must_use]
    pub fn bias_change(&self, tau_k: f64) -> Vector3<f64> {
        polynomial(&self.bias, tau_k)
    }

    /// `1 + Σ_m k_m τ^m` of each axis.
    #[must_use]
    pub fn gain_factor(&self, tau_k: f64) -> Vector3<f64> {
        Vector3::repeat(1.0) + polynomial(&self.scale, tau_k)
    }
}

/// `Σ_m c_m τ^m`, m from 1.
fn polynomial(coefficients: &[Vector3<f64>; HIGHEST_ORDER], tau_k: f64) -> Vector3<f64> {
    coefficients.iter().rev().fold(Vector3::zeros(), |sum, coefficient| (sum + coefficient) * tau_k)
}

impl Thermal {
    /// Nothing follows temperature.
    #[must_use]
    pub fn none() -> Self {
        Self { reference_c: ROOM_C, range_c: None, sensors: PerSensor::default() }
    }

    /// Does nothing follow temperature?
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.sensors.iter().all(|(_, terms)| terms.is_none())
    }

    /// The terms of one sensor.
    #[must_use]
    pub fn sensor(&self, sensor_kind: SensorKind) -> &SensorThermal {
        &self.sensors[sensor_kind]
    }

    /// Is a temperature so far outside the range that the polynomials extrapolate? The limit is a tenth of
    /// the range, or 1 K where that is more.
    #[must_use]
    pub fn extrapolates_to(&self, temperature_c: f64) -> bool {
        self.range_c.is_some_and(|[low, high]| {
            let margin = (0.1 * (high - low)).max(1.0);
            temperature_c < low - margin || temperature_c > high + margin
        })
    }

    /// `τ = T − T₀`, K.
    #[must_use]
    pub fn tau_k(&self, temperature_c: f64) -> f64 {
        temperature_c - self.reference_c
    }
}
