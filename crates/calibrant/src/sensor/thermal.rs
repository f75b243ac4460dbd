//! How bias and gain follow temperature: polynomials about a reference.
//!
//! With `τ = T − T₀` in K: `b(T) = b + Σ_m b_m τ^m` and `S(T) = diag(1 + Σ_m k_m τ^m) S`. The gain of each sense element drifts, its direction does not;
//! `k_m` in 1/K^m, as datasheets give it. A change of the true frame, `S → S R`, leaves both as they are. The g-sensitivity `Γ` does not follow temperature.

use super::{Axis, ImuParameters, ImuQuantity, ReadingUnit, Triad};
use nalgebra::{Matrix3, Vector3};

/// Highest power of τ.
pub const HIGHEST_ORDER: usize = 2;

/// The reference temperature where nothing follows temperature, °C.
const ROOM_C: f64 = 25.0;

/// What temperature does to an IMU.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thermal {
    /// The reference `T₀`, °C: the temperature at which biases and matrices are given.
    pub reference_c: f64,
    /// Least and greatest temperature at which the terms were determined, °C, where it is known; beyond it they extrapolate.
    pub range_c: Option<[f64; 2]>,
    /// Terms of the accelerometer.
    pub accelerometer: TriadThermal,
    /// Terms of the gyroscope.
    pub gyroscope: TriadThermal,
}

/// What temperature does to one sensor; entry `m − 1` is of the power `τ^m`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TriadThermal {
    /// `b_m`, in the unit of the readings per K^m.
    pub bias: [Vector3<f64>; HIGHEST_ORDER],
    /// `k_m`, in 1/K^m.
    pub scale: [Vector3<f64>; HIGHEST_ORDER],
}

/// What follows temperature.
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
    /// What follows temperature.
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
        let power = if self.order > 1 { self.order.to_string() } else { String::new() };
        format!("{part}_per_k{power}.{}", self.axis)
    }

    /// Its unit, for readings in this unit.
    #[must_use]
    pub fn unit(self, reading: ReadingUnit) -> &'static str {
        match (self.part, reading, self.order) {
            (ThermalPart::Bias, ReadingUnit::MetrePerSecondSquared, 1) => "m/s²/K",
            (ThermalPart::Bias, ReadingUnit::MetrePerSecondSquared, _) => "m/s²/K²",
            (ThermalPart::Bias, ReadingUnit::RadianPerSecond, 1) => "rad/s/K",
            (ThermalPart::Bias, ReadingUnit::RadianPerSecond, _) => "rad/s/K²",
            (ThermalPart::Bias, ReadingUnit::Counts, 1) => "counts/K",
            (ThermalPart::Bias, ReadingUnit::Counts, _) => "counts/K²",
            (ThermalPart::Scale, _, 1) => "1/K",
            (ThermalPart::Scale, ..) => "1/K²",
        }
    }

    /// `τ^m`.
    #[must_use]
    pub fn power(self, tau_k: f64) -> f64 {
        tau_k.powi(self.order as i32)
    }

    /// Its value in a sensor.
    #[must_use]
    pub fn of(self, thermal: &TriadThermal) -> f64 {
        match self.part {
            ThermalPart::Bias => thermal.bias[self.order - 1][self.axis.index()],
            ThermalPart::Scale => thermal.scale[self.order - 1][self.axis.index()],
        }
    }

    /// Adds `step` to it.
    pub fn add_to(self, thermal: &mut TriadThermal, step: f64) {
        match self.part {
            ThermalPart::Bias => thermal.bias[self.order - 1][self.axis.index()] += step,
            ThermalPart::Scale => thermal.scale[self.order - 1][self.axis.index()] += step,
        }
    }
}

impl TriadThermal {
    /// Does nothing follow temperature?
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::default()
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
        Self {
            reference_c: ROOM_C,
            range_c: None,
            accelerometer: TriadThermal::default(),
            gyroscope: TriadThermal::default(),
        }
    }

    /// Does nothing follow temperature?
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.accelerometer.is_none() && self.gyroscope.is_none()
    }

    /// The terms of one sensor.
    #[must_use]
    pub fn triad(&self, triad: Triad) -> &TriadThermal {
        match triad {
            Triad::Accelerometer => &self.accelerometer,
            Triad::Gyroscope => &self.gyroscope,
        }
    }

    pub(super) fn triad_mut(&mut self, triad: Triad) -> &mut TriadThermal {
        match triad {
            Triad::Accelerometer => &mut self.accelerometer,
            Triad::Gyroscope => &mut self.gyroscope,
        }
    }

    /// Is a temperature so far outside the range that the polynomials extrapolate: by more than a tenth of the range, or 1 K where that is more?
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

impl ImuParameters {
    /// The IMU at a temperature: `b(T)`, `S(T)` and `Γ`, and nothing that follows temperature any more.
    ///
    /// # Examples
    /// ```
    /// use calibrant::sensor::ImuParameters;
    /// let mut imu = ImuParameters::identity();
    /// imu.thermal.reference_c = 20.0;
    /// imu.thermal.gyroscope.bias[0].x = 1e-4; // rad/s/K
    /// imu.thermal.accelerometer.scale[1].z = 2e-6; // 1/K²
    /// let hot = imu.at(50.0);
    /// assert!((hot.gyroscope.bias.x - 3e-3).abs() < 1e-15);
    /// assert!((hot.accelerometer.matrix[(2, 2)] - 1.0018).abs() < 1e-15);
    /// ```
    #[must_use]
    pub fn at(&self, temperature_c: f64) -> Self {
        if self.thermal.is_none() {
            return *self;
        }
        let tau_k = self.thermal.tau_k(temperature_c);
        let mut imu = Self { thermal: Thermal::none(), ..*self };
        for triad in Triad::ALL {
            let (thermal, sensor) = (self.thermal.triad(triad), imu.triad_mut(triad));
            sensor.bias += thermal.bias_change(tau_k);
            sensor.matrix = Matrix3::from_diagonal(&thermal.gain_factor(tau_k)) * sensor.matrix;
        }
        imu
    }
}

impl ImuQuantity {
    /// The temperature terms of one sensor up to these orders: of the bias first, then of the scale, order by order.
    #[must_use]
    pub fn thermal_list(triad: Triad, bias_order: usize, scale_order: usize) -> Vec<Self> {
        let mut list = Vec::new();
        for (part, order) in [(ThermalPart::Bias, bias_order), (ThermalPart::Scale, scale_order)] {
            for order in 1..=order.min(HIGHEST_ORDER) {
                list.extend(Axis::ALL.map(|axis| Self::Thermal(triad, ThermalTerm { part, axis, order })));
            }
        }
        list
    }

    /// Every temperature term of the sensors that are there.
    #[must_use]
    pub fn all_thermal(accelerometer: bool, gyroscope: bool) -> Vec<Self> {
        [(Triad::Accelerometer, accelerometer), (Triad::Gyroscope, gyroscope)]
            .into_iter()
            .filter(|(_, there)| *there)
            .flat_map(|(triad, _)| Self::thermal_list(triad, HIGHEST_ORDER, HIGHEST_ORDER))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::Condition;

    #[test]
    fn names_and_units_say_the_power() {
        let list = ImuQuantity::thermal_list(Triad::Gyroscope, 2, 1);
        let names: Vec<String> = list.iter().map(|quantity| quantity.name()).collect();
        assert_eq!(names[0], "gyroscope.bias_per_k.x");
        assert_eq!(names[4], "gyroscope.bias_per_k2.y");
        assert_eq!(names[8], "gyroscope.scale_per_k.z");
        assert_eq!(list[4].unit(ReadingUnit::Counts), "counts/K²");
        assert_eq!(ImuQuantity::all_thermal(true, true).len(), 24);
    }

    #[test]
    fn derivatives_equal_differences() {
        let mut imu = ImuParameters::identity();
        let mut all = ImuQuantity::full_list(true, true, true);
        all.extend(ImuQuantity::all_thermal(true, true));
        for (k, quantity) in all.iter().enumerate() {
            quantity.add_to(&mut imu, 1e-3 * ((5 * k % 13) as f64 - 6.0));
        }
        let (stimulus, force, temperature_c) =
            (Vector3::new(0.4, -1.2, 0.3), Vector3::new(1.0, -5.0, 8.0), 29.5);
        let reading = |imu: &ImuParameters, triad: Triad| {
            let felt = if triad == Triad::Gyroscope { imu.g_sensitivity * force } else { Vector3::zeros() };
            imu.at(temperature_c).triad(triad).reading(&stimulus) + felt
        };
        for quantity in all {
            let moved = |by: f64| {
                let mut moved = imu;
                quantity.add_to(&mut moved, by);
                reading(&moved, quantity.triad())
            };
            let difference = (moved(1e-4) - moved(-1e-4)) / 2e-4;
            let at = Condition { imu: &imu, stimulus, force, temperature_c };
            assert!((difference - quantity.derivative(&at)).amax() < 1e-8, "{}", quantity.name());
        }
    }

    #[test]
    fn each_term_is_found_where_it_was_added() {
        for (k, quantity) in ImuQuantity::all_thermal(true, true).into_iter().enumerate() {
            let mut imu = ImuParameters::identity();
            quantity.add_to(&mut imu, 1.0 + k as f64);
            let found: Vec<f64> =
                ImuQuantity::all_thermal(true, true).iter().map(|other| other.of(&imu)).collect();
            assert_eq!(found.iter().sum::<f64>(), 1.0 + k as f64);
            assert_eq!(found[k], 1.0 + k as f64, "{}", quantity.name());
        }
    }
}
