//! Frame invariants of a calibration: lengths of the sensitive axes, angles between them, biases. Two
//! calibrations of one sensor must agree on them, whatever their true frames.
//!
//! Row i of `S` is the sensitive axis of sensor axis i: `y_i = S_i · s + b_i`. Another true frame turns all
//! rows of both sensors together (`S R`). So the lengths of the rows (the gains), the angles between them and
//! the biases stay. The angle between the axes `u` and `v` is `atan2(|u × v|, u · v)`, exact for small angles
//! too. Its derivative is `−(v̂ − û cos θ) · du / (|u| sin θ)`, likewise for `v`.

use super::entry_vector::{self, EntryMatrix, EntryVector};
use super::{
    Axis, CalibratedImu, CovariancePart, ImuParameters, ImuQuantity, NonlinearTerm, Quantity, ReadingUnit,
    SensorKind, ThermalPart, ThermalTerm,
};
use nalgebra::Vector3;

/// A quantity that does not depend on the true frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Invariant {
    /// Bias of an axis, in the unit of the readings.
    Bias(SensorKind, Axis),
    /// Length of a sensitive axis: the gain, in the unit of the readings per unit of the stimulus.
    Gain(SensorKind, Axis),
    /// Angle between two axes of one sensor, rad.
    Angle(SensorKind, Axis, Axis),
    /// Angle between an axis of the accelerometer and one of the gyroscope, rad.
    AngleBetween(Axis, Axis),
    /// Length of a row of `Γ`: the most that a gyroscope axis reads from 1 m/s².
    GSensitivity(Axis),
    /// What temperature does to bias or gain of an axis.
    Thermal(SensorKind, ThermalTerm),
    /// The coefficient of a term that bends the response of the accelerometer.
    Nonlinear(NonlinearTerm, Axis),
}

crate::json_name!(Invariant);

/// An invariant of an IMU.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InvariantValue {
    /// Which one.
    pub invariant: Invariant,
    /// Its value.
    pub value: f64,
    /// Its standard deviation to first order. `None` without a covariance. `None` also where a length or an
    /// angle is below three of its standard deviations: the first order does not hold there.
    pub sd: Option<f64>,
}

impl Invariant {
    /// All invariants of an IMU with these sensors at its reference temperature, in the order of a table.
    #[must_use]
    pub fn list(accelerometer: bool, gyroscope: bool) -> Vec<Self> {
        use Axis::{X, Y, Z};
        let mut list = Vec::new();
        for (sensor_kind, there) in
            [(SensorKind::Accelerometer, accelerometer), (SensorKind::Gyroscope, gyroscope)]
        {
            if there {
                list.extend(Axis::ALL.map(|axis| Self::Bias(sensor_kind, axis)));
                list.extend(Axis::ALL.map(|axis| Self::Gain(sensor_kind, axis)));
                list.extend(
                    [(X, Y), (X, Z), (Y, Z)].map(|(one, other)| Self::Angle(sensor_kind, one, other)),
                );
            }
        }
        if accelerometer && gyroscope {
            list.extend(Axis::ALL.into_iter().flat_map(|a| Axis::ALL.map(|g| Self::AngleBetween(a, g))));
        }
        if gyroscope {
            list.extend(Axis::ALL.map(Self::GSensitivity));
        }
        list
    }

    /// Its name: `gyroscope.gain.x`, `accelerometer.angle.xy`, `angle.accelerometer_x.gyroscope_y`.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Bias(sensor_kind, axis) => format!("{sensor_kind}.bias.{axis}"),
            Self::Gain(sensor_kind, axis) => format!("{sensor_kind}.gain.{axis}"),
            Self::Angle(sensor_kind, one, other) => format!("{sensor_kind}.angle.{one}{other}"),
            Self::AngleBetween(a, g) => format!("angle.accelerometer_{a}.gyroscope_{g}"),
            Self::GSensitivity(axis) => format!("gyroscope.g_sensitivity.{axis}"),
            Self::Thermal(sensor_kind, term) => format!("{sensor_kind}.{}", term.name()),
            Self::Nonlinear(term, axis) => format!("{}.{}.{axis}", SensorKind::Accelerometer, term.name()),
        }
    }

    /// Its unit in this IMU; angles are in rad.
    #[must_use]
    pub fn unit(self, imu: &CalibratedImu) -> &'static str {
        let counts = |sensor_kind| imu.unit(sensor_kind) == Some(ReadingUnit::Counts);
        match self {
            Self::Bias(sensor_kind, _) => {
                imu.unit(sensor_kind).unwrap_or(sensor_kind.stimulus_unit()).symbol()
            }
            Self::Gain(SensorKind::Accelerometer, _) if counts(SensorKind::Accelerometer) => "counts/(m/s²)",
            Self::Gain(SensorKind::Gyroscope, _) if counts(SensorKind::Gyroscope) => "counts/(rad/s)",
            Self::Gain(..) => "1",
            Self::Angle(..) | Self::AngleBetween(..) => "rad",
            Self::GSensitivity(_) if counts(SensorKind::Gyroscope) => "counts/(m/s²)",
            Self::GSensitivity(_) => "(rad/s)/(m/s²)",
            Self::Thermal(sensor_kind, term) => {
                term.unit(imu.unit(sensor_kind).unwrap_or(sensor_kind.stimulus_unit()))
            }
            Self::Nonlinear(term, _) => term.unit(),
        }
    }

    /// Does it depend on the unit of a sensor's readings? `None` for angles and shares of a gain.
    #[must_use]
    pub fn in_unit_of(self) -> Option<SensorKind> {
        match self {
            Self::Bias(sensor_kind, _) | Self::Gain(sensor_kind, _) => Some(sensor_kind),
            Self::GSensitivity(_) => Some(SensorKind::Gyroscope),
            Self::Thermal(sensor_kind, ThermalTerm { part: ThermalPart::Bias, .. }) => Some(sensor_kind),
            Self::Angle(..) | Self::AngleBetween(..) | Self::Thermal(..) | Self::Nonlinear(..) => None,
        }
    }

    /// Degrees of freedom behind its standard deviation in this IMU; infinite where that counts as known.
    #[must_use]
    pub fn degrees_behind(self, imu: &CalibratedImu) -> f64 {
        imu.degrees_behind(self.covariance_part())
    }

    /// The part of the covariance that it mainly belongs to.
    pub(crate) fn covariance_part(self) -> CovariancePart {
        let gyroscope = SensorKind::Gyroscope;
        let quantity = match self {
            Self::Bias(of, axis) => ImuQuantity::Of(of, Quantity::Bias(axis)),
            Self::Gain(of, axis) | Self::Angle(of, axis, _) => ImuQuantity::Of(of, Quantity::Scale(axis)),
            Self::AngleBetween(_, axis) => ImuQuantity::Of(gyroscope, Quantity::Scale(axis)),
            Self::GSensitivity(axis) => ImuQuantity::GSensitivity(axis, axis),
            Self::Thermal(of, term) => ImuQuantity::Thermal(of, term),
            Self::Nonlinear(term, axis) => {
                ImuQuantity::Of(SensorKind::Accelerometer, Quantity::Nonlinear(term, axis))
            }
        };
        quantity.covariance_part()
    }

    /// Can it come close to zero without changing sign?
    fn is_folded(self) -> bool {
        match self {
            Self::AngleBetween(a, g) => a == g,
            Self::GSensitivity(_) => true,
            _ => false,
        }
    }

    /// Its value in an IMU.
    #[must_use]
    pub fn value(self, imu: &ImuParameters) -> f64 {
        self.with_gradient(imu).0
    }

    /// Its value, and its derivative with respect to the entries of the IMU.
    pub(super) fn with_gradient(self, imu: &ImuParameters) -> (f64, EntryVector) {
        let mut gradient = EntryVector::zeros();
        let row = |sensor_kind: SensorKind, axis: Axis| {
            imu.sensor(sensor_kind).matrix.row(axis.index()).transpose()
        };
        let value = match self {
            Self::Thermal(sensor_kind, term) => {
                gradient[entry_vector::thermal(sensor_kind, term.part, term.order, term.axis.index())] = 1.0;
                term.value(imu.thermal.sensor(sensor_kind))
            }
            Self::Nonlinear(term, axis) => {
                gradient[entry_vector::nonlinear(term, axis.index())] = 1.0;
                imu[SensorKind::Accelerometer].nonlinearity.of(term)[axis.index()]
            }
            Self::Bias(sensor_kind, axis) => {
                gradient[entry_vector::bias(sensor_kind, axis.index())] = 1.0;
                imu.sensor(sensor_kind).bias[axis.index()]
            }
            Self::Gain(sensor_kind, axis) => {
                let u = row(sensor_kind, axis);
                put(&mut gradient, &unit_or_zero(&u), |k| entry_vector::matrix(sensor_kind, axis.index(), k));
                u.norm()
            }
            Self::GSensitivity(axis) => {
                let u = imu.g_sensitivity.row(axis.index()).transpose();
                put(&mut gradient, &unit_or_zero(&u), |k| entry_vector::g_sensitivity(axis.index(), k));
                u.norm()
            }
            Self::Angle(sensor_kind, one, other) => {
                let (u, v) = (row(sensor_kind, one), row(sensor_kind, other));
                put(&mut gradient, &angle_gradient(&u, &v), |k| {
                    entry_vector::matrix(sensor_kind, one.index(), k)
                });
                put(&mut gradient, &angle_gradient(&v, &u), |k| {
                    entry_vector::matrix(sensor_kind, other.index(), k)
                });
                angle(&u, &v)
            }
            Self::AngleBetween(a, g) => {
                let (u, v) = (row(SensorKind::Accelerometer, a), row(SensorKind::Gyroscope, g));
                let place =
                    |sensor_kind, axis: Axis| move |k| entry_vector::matrix(sensor_kind, axis.index(), k);
                put(&mut gradient, &angle_gradient(&u, &v), place(SensorKind::Accelerometer, a));
                put(&mut gradient, &angle_gradient(&v, &u), place(SensorKind::Gyroscope, g));
                angle(&u, &v)
            }
        };
        (value, gradient)
    }
}

impl CalibratedImu {
    /// All invariants of the IMU that are known, with standard deviations where it has a covariance.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::sensor::{CalibratedImu, ImuParameters, ReadingUnit};
    /// let units = [Some(ReadingUnit::MetrePerSecondSquared), None];
    /// let imu = CalibratedImu::new(ImuParameters::identity(), units, vec![], "");
    /// let angle = imu.invariants()[6];
    /// assert_eq!(angle.invariant.name(), "accelerometer.angle.xy");
    /// assert!((angle.value.to_degrees() - 90.0).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn invariants(&self) -> Vec<InvariantValue> {
        let covariance = entry_vector::covariance(self).map(Box::new);
        let (accelerometer, gyroscope) =
            (self.unit(SensorKind::Accelerometer).is_some(), self.unit(SensorKind::Gyroscope).is_some());
        let terms = ImuQuantity::all(accelerometer, gyroscope).into_iter().filter_map(|quantity| {
            let there = quantity.value(&self.parameters) != 0.0 || self.quantities.contains(&quantity);
            match quantity {
                ImuQuantity::Thermal(sensor_kind, term) if there => {
                    Some(Invariant::Thermal(sensor_kind, term))
                }
                ImuQuantity::Of(_, Quantity::Nonlinear(term, axis)) if there => {
                    Some(Invariant::Nonlinear(term, axis))
                }
                _ => None,
            }
        });
        let is_known = |invariant: &Invariant| match invariant {
            Invariant::Bias(sensor_kind, _) => self.has_bias(*sensor_kind),
            _ => true,
        };
        Invariant::list(accelerometer, gyroscope)
            .into_iter()
            .filter(is_known)
            .chain(terms)
            .map(|invariant| {
                let (value, gradient) = invariant.with_gradient(&self.parameters);
                let sd = |sigma: &EntryMatrix| gradient.dot(&(sigma * gradient)).max(0.0).sqrt();
                let sd = covariance.as_deref().map(sd).filter(|&sd| sd > 0.0);
                let sd = sd.filter(|&sd| !invariant.is_folded() || value > 3.0 * sd);
                InvariantValue { invariant, value, sd }
            })
            .collect()
    }
}

fn put(gradient: &mut EntryVector, row: &Vector3<f64>, place: impl Fn(usize) -> usize) {
    for k in 0..3 {
        gradient[place(k)] += row[k];
    }
}

fn unit_or_zero(u: &Vector3<f64>) -> Vector3<f64> {
    u.try_normalize(0.0).unwrap_or_else(Vector3::zeros)
}

fn angle(u: &Vector3<f64>, v: &Vector3<f64>) -> f64 {
    let (u, v) = (unit_or_zero(u), unit_or_zero(v));
    u.cross(&v).norm().atan2(u.dot(&v))
}

/// Derivative of the angle between `u` and `v` with respect to `u`; zero where they are parallel.
fn angle_gradient(u: &Vector3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
    let (direction, other) = (unit_or_zero(u), unit_or_zero(v));
    let across = other - direction * direction.dot(&other);
    let length = u.norm();
    if length > 0.0 { -unit_or_zero(&across) / length } else { Vector3::zeros() }
}

impl CalibratedImu {
    /// What one standard deviation of each shared source does to an invariant; empty without shared errors.
    #[must_use]
    pub fn shared_errors_of(&self, invariant: Invariant) -> Vec<f64> {
        let Some(shared) = &self.shared else { return Vec::new() };
        let (_, gradient) = invariant.with_gradient(&self.parameters);
        let slope = |quantity: &ImuQuantity| gradient.dot(&entry_vector::of_quantity(*quantity));
        let slopes: Vec<f64> = self.quantities.iter().map(slope).collect();
        shared
            .root
            .column_iter()
            .map(|column| column.iter().zip(&slopes).map(|(u, by)| u * by).sum())
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::Gauge;
    use crate::sensor::entry_vector::ENTRIES;
    use crate::sensor::gauge_change::tests::imu;

    #[test]
    fn they_are_the_same_in_every_gauge_and_so_are_their_standard_deviations() {
        // the gauge removes the uncertainty of the rotation from the covariance; no invariant depends on it
        let before = imu().invariants();
        for gauge in [Gauge::Lower, Gauge::Upper, Gauge::Symmetric] {
            let after = imu().in_gauge(gauge).expect("regular").invariants();
            for (a, b) in before.iter().zip(&after) {
                let name = a.invariant.name();
                assert!((a.value - b.value).abs() <= 1e-12 * a.value.abs().max(1.0), "{gauge:?} {name}");
                match (a.sd, b.sd) {
                    (Some(one), Some(other)) => assert!((one / other - 1.0).abs() < 1e-8, "{gauge:?} {name}"),
                    (one, other) => assert_eq!(one, other, "{name}"),
                }
            }
        }
    }

    #[test]
    fn gradients_are_those_of_differences() {
        let parameters = imu().parameters;
        for invariant in Invariant::list(true, true) {
            let (_, gradient) = invariant.with_gradient(&parameters);
            for entry in 0..ENTRIES {
                let h = if entry < 24 { 1e-2 } else { 1e-5 };
                let at = |step: f64| {
                    let mut moved = entry_vector::from_parameters(&parameters);
                    moved[entry] += step;
                    invariant.value(&entry_vector::to_imu(&moved))
                };
                let difference = (at(h) - at(-h)) / (2.0 * h);
                assert!((difference - gradient[entry]).abs() < 1e-7, "{} {entry}", invariant.name());
            }
        }
    }

    #[test]
    fn what_is_close_to_zero_has_no_first_order_sd() {
        let mut imu = imu();
        imu.parameters.g_sensitivity *= 1e-9;
        let g_sensitivity =
            imu.invariants().into_iter().find(|value| value.invariant.is_folded() && value.value < 1e-6);
        assert_eq!(g_sensitivity.expect("there").sd, None);
    }
}
