//! What a soak measures of each parameter, and the parameters at the reference temperature that follow from polynomials.
//!
//! Gains are relative to their mean over the soaks, `q = S_ii / S̄_ii − 1`; entries off the diagonal are shares of the gain of their row, which temperature
//! leaves as they are. Biases of readings in counts are divided by the gain: what is known of sensors is in their stimulus.

use calibrant_core::sensor::legendre::powers_of_legendre;
use calibrant_core::sensor::{
    Axis, CalibratedImu, ImuParameters, ImuQuantity, PerSensor, Quantity, ReadingUnit, SensorKind,
    ThermalPart, ThermalTerm,
};
use nalgebra::{DMatrix, DVector, Vector3};
use std::ops::Range;

/// The means by which parameters are relative.
#[derive(Debug, Clone)]
pub(super) struct Means {
    gains: PerSensor<Vector3<f64>>,
    /// What a bias is divided by: the gain for counts.
    units: PerSensor<Vector3<f64>>,
}

impl Means {
    pub(super) fn of(imus: &[&CalibratedImu]) -> Self {
        let mean = |sensor_kind: SensorKind| {
            let gains = imus.iter().map(|imu| imu.parameters.sensor(sensor_kind).matrix.diagonal());
            gains.sum::<Vector3<f64>>() / imus.len() as f64
        };
        let gains = PerSensor::from_fn(mean);
        let counts = |kind| imus.first().is_some_and(|imu| imu.unit(kind) == Some(ReadingUnit::Counts));
        let units = PerSensor::from_fn(|kind| if counts(kind) { gains[kind] } else { Vector3::repeat(1.0) });
        Self { gains, units }
    }

    /// The mean gain that a gain is relative to; 1 of other parameters.
    pub(super) fn relative_to(&self, quantity: ImuQuantity) -> f64 {
        match quantity {
            ImuQuantity::Of(kind, Quantity::Scale(axis)) => self.gains[kind][axis.index()],
            _ => 1.0,
        }
    }

    /// What a parameter of an IMU measures, and its derivatives by the parameters.
    pub(super) fn measured(
        &self,
        quantity: ImuQuantity,
        imu: &ImuParameters,
    ) -> (f64, Vec<(ImuQuantity, f64)>) {
        let value = quantity.value(imu);
        match quantity {
            ImuQuantity::Of(kind, Quantity::Bias(axis)) => {
                let unit = self.units[kind][axis.index()];
                (value / unit, vec![(quantity, unit.recip())])
            }
            ImuQuantity::Of(kind, Quantity::Scale(axis)) => {
                let mean = self.gains[kind][axis.index()];
                (value / mean - 1.0, vec![(quantity, mean.recip())])
            }
            ImuQuantity::Of(kind, Quantity::CrossAxis(row, _)) => {
                let scale = ImuQuantity::Of(kind, Quantity::Scale(row));
                let gain = scale.value(imu);
                (value / gain, vec![(quantity, gain.recip()), (scale, -value / gain.powi(2))])
            }
            ImuQuantity::GSensitivity(row, _) => {
                let unit = self.units[SensorKind::Gyroscope][row.index()];
                (value / unit, vec![(quantity, unit.recip())])
            }
            _ => (value, vec![(quantity, 1.0)]),
        }
    }
}

/// A parameter of the soaks, and where its coefficients stand among all.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    pub(super) quantity: ImuQuantity,
    /// Its channel.
    pub(super) channel: usize,
    /// Its coefficients: those of the polynomial come first.
    pub(super) places: Range<usize>,
}

/// The parameters at the reference temperature with their temperature terms, and their derivatives by the coefficients.
pub(super) struct AtReference {
    pub(super) quantities: Vec<ImuQuantity>,
    pub(super) values: Vec<f64>,
    pub(super) jacobian: DMatrix<f64>,
}

/// A value with its derivatives by the coefficients.
#[derive(Clone)]
struct Dual {
    value: f64,
    slope: DVector<f64>,
}

impl Dual {
    fn times(&self, factor: f64) -> Self {
        Self { value: self.value * factor, slope: &self.slope * factor }
    }

    fn product(&self, other: &Self) -> Self {
        let slope = &self.slope * other.value + &other.slope * self.value;
        Self { value: self.value * other.value, slope }
    }

    fn over(&self, other: &Self) -> Self {
        let inverse = other.value.recip();
        let slope = (&self.slope - &other.slope * (self.value * inverse)) * inverse;
        Self { value: self.value * inverse, slope }
    }
}

impl AtReference {
    /// Of these coefficients. `legendre`: what the coefficients of an entry are in Legendre polynomials over the range.
    pub(super) fn of(
        entries: &[Entry],
        means: &Means,
        coefficients: &DVector<f64>,
        legendre: impl Fn(&Entry) -> DMatrix<f64>,
        (range_c, reference_c): ([f64; 2], f64),
    ) -> Self {
        let powers = |entry: &Entry| -> Vec<Dual> {
            let legendre = legendre(entry);
            let basis = powers_of_legendre(range_c, reference_c, legendre.nrows()) * legendre;
            (0..basis.nrows())
                .map(|power| {
                    let mut slope = DVector::zeros(coefficients.len());
                    slope.rows_range_mut(entry.places.clone()).copy_from(&basis.row(power).transpose());
                    Dual { value: slope.dot(coefficients), slope }
                })
                .collect()
        };
        let entry_of = |quantity: ImuQuantity| entries.iter().find(|entry| entry.quantity == quantity);
        let one = |slope: DVector<f64>| Dual { value: 1.0, slope };
        // 1 + q at the reference; 1 where the gain is not among the parameters
        let factor = |kind: SensorKind, axis: Axis| {
            let found =
                entry_of(ImuQuantity::Of(kind, Quantity::Scale(axis))).map(|entry| powers(entry).remove(0));
            found.map_or_else(
                || one(DVector::zeros(coefficients.len())),
                |q| Dual { value: 1.0 + q.value, slope: q.slope },
            )
        };
        let mut found: Vec<(ImuQuantity, Dual)> = Vec::new();
        for entry in entries {
            let at_reference = powers(entry).remove(0);
            let dual = match entry.quantity {
                ImuQuantity::Of(kind, Quantity::Bias(axis)) => {
                    at_reference.times(means.units[kind][axis.index()])
                }
                ImuQuantity::Of(kind, Quantity::Scale(axis)) => {
                    factor(kind, axis).times(means.gains[kind][axis.index()])
                }
                ImuQuantity::Of(kind, Quantity::CrossAxis(row, _)) => {
                    at_reference.product(&factor(kind, row)).times(means.gains[kind][row.index()])
                }
                ImuQuantity::GSensitivity(row, _) => {
                    at_reference.times(means.units[SensorKind::Gyroscope][row.index()])
                }
                _ => at_reference,
            };
            found.push((entry.quantity, dual));
        }
        for entry in entries {
            let terms = powers(entry).into_iter().enumerate().skip(1);
            match entry.quantity {
                ImuQuantity::Of(kind, Quantity::Bias(axis)) => found.extend(terms.map(|(order, term)| {
                    let of = ThermalTerm { part: ThermalPart::Bias, axis, order };
                    (ImuQuantity::Thermal(kind, of), term.times(means.units[kind][axis.index()]))
                })),
                ImuQuantity::Of(kind, Quantity::Scale(axis)) => found.extend(terms.map(|(order, term)| {
                    let of = ThermalTerm { part: ThermalPart::Scale, axis, order };
                    (ImuQuantity::Thermal(kind, of), term.over(&factor(kind, axis)))
                })),
                _ => {}
            }
        }
        let rows: Vec<_> = found.iter().map(|(_, dual)| dual.slope.transpose()).collect();
        Self {
            jacobian: DMatrix::from_rows(&rows),
            values: found.iter().map(|(_, dual)| dual.value).collect(),
            quantities: found.into_iter().map(|(quantity, _)| quantity).collect(),
        }
    }

    /// Sets the parameters of an IMU to them.
    pub(super) fn set(&self, parameters: &mut ImuParameters) {
        for (quantity, value) in self.quantities.iter().zip(&self.values) {
            let before = quantity.value(parameters);
            quantity.add_to(parameters, value - before);
        }
    }
}
