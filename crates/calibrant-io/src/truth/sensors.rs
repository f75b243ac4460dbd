//! `truth.json`: the true parameters of a simulated recording.

use super::machine::TrueMachine;
use super::parameter::TrueParameter;
use crate::results::heading::{Heading, JsonFile};
use calibrant_core::json::{flat, if_any, if_some};
use calibrant_core::json_object;
use calibrant_core::sensor::{
    Gauge, ImuParameters, ImuQuantity, ParameterList, Quantity, ReadingUnit, SensorKind, SensorParameters,
};
use calibrant_core::simulate::{TrueClock, TrueGravity};
use nalgebra::{Matrix3, Vector3};

/// The content of `truth.json`: what a simulated recording was made of.
///
/// # Examples
/// ```
/// use calibrant_core::sensor::{Sensor, SensorParameters};
/// use calibrant_io::{Truth, to_json};
///
/// let sensor = Sensor::memsic_mxd2020u();
/// let truth = Truth::of_sensor(7, &sensor.parameter_list(), sensor.unit, &SensorParameters::identity());
/// assert!(to_json(&truth).contains("\"seed\": 7"));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    seed: u64,
    convention: &'static str,
    gauge: Option<&'static str>,
    reference_c: Option<f64>,
    parameters: Vec<TrueParameter>,
    gravity: Option<TrueGravity>,
    clock: Option<TrueClock>,
    fixed: Vec<TrueParameter>,
    machine: Option<TrueMachine>,
}

json_object! {
    /// What a simulated recording was made of.
    Truth as of {
        heading: flat(Heading::<Self>::of()),
        /// The seed of the noise.
        seed: of.seed,
        /// What matrices and biases mean.
        convention: of.convention,
        /// The form of the accelerometer's matrix, where it has one.
        gauge: if_some(of.gauge),
        /// The reference temperature of an IMU that follows temperature.
        reference_c: if_some(of.reference_c),
        /// What a calibration finds, by the same names.
        parameters: &of.parameters,
        /// What the sensor sensed beside a commanded motion.
        gravity: if_some(of.gravity),
        /// The clock of the recording beside that of a commanded motion.
        clock: if_some(of.clock),
        /// Everything else that differs from an ideal sensor: what a calibration of the experiment takes as given.
        fixed: if_any(of.fixed.as_slice()),
        machine: if_some(of.machine.as_ref()),
    }
}

impl JsonFile for Truth {
    const KIND: &'static str = "truth";
}

impl Truth {
    /// Of an accelerometer: the true value of each parameter of the list.
    #[must_use]
    pub fn of_sensor(seed: u64, list: &ParameterList, unit: ReadingUnit, truth: &SensorParameters) -> Self {
        let parameter = |quantity: &Quantity| TrueParameter {
            name: ImuQuantity::Of(SensorKind::Accelerometer, *quantity).name(),
            unit: quantity.unit(unit),
            value: quantity.value(truth),
        };
        Self {
            seed,
            convention: "true to raw: y = S s + b",
            gauge: gauge_of(list.quantities(), &truth.matrix),
            reference_c: None,
            parameters: list.quantities().iter().map(parameter).collect(),
            gravity: None,
            clock: None,
            fixed: Vec::new(),
            machine: None,
        }
    }

    /// The true value of the parameter of this name.
    #[must_use]
    pub fn value(&self, name: &str) -> Option<f64> {
        self.parameters.iter().find(|parameter| parameter.name == name).map(|parameter| parameter.value)
    }

    /// The same, with the gravity that the sensor sensed beside a commanded motion.
    #[must_use]
    pub fn with_gravity(self, gravity: Option<TrueGravity>) -> Self {
        Self { gravity, ..self }
    }

    /// The same, with the clock of the recording.
    #[must_use]
    pub fn with_clock(self, clock: Option<TrueClock>) -> Self {
        Self { clock, ..self }
    }

    /// The same, with the machine that carried the sensor.
    #[must_use]
    pub fn on_machine(self, machine: TrueMachine) -> Self {
        Self { machine: Some(machine), ..self }
    }

    /// Of an IMU: the true value of each of these quantities, and the reference temperature where one is followed. `units` are those of
    /// accelerometer and gyroscope.
    #[must_use]
    pub fn of_imu(
        seed: u64,
        quantities: &[ImuQuantity],
        units: [ReadingUnit; 2],
        truth: &ImuParameters,
    ) -> Self {
        let unit = |sensor_kind: SensorKind| units[sensor_kind as usize];
        let value = |quantity: &ImuQuantity| TrueParameter {
            name: quantity.name(),
            unit: quantity.unit(unit(quantity.sensor_kind())),
            value: quantity.value(truth),
        };
        let parameters = quantities.iter().map(value).collect();
        let fixed = beside(quantities, truth).iter().map(value).collect();
        let thermal = quantities.iter().any(|quantity| matches!(quantity, ImuQuantity::Thermal(..)));
        let (convention, reference_c) = match thermal {
            false => ("true to raw: y_a = S_a f + b_a, y_g = S_g w + b_g + G f", None),
            true => (
                "true to raw: y_a = S_a(T) f + b_a(T), y_g = S_g(T) w + b_g(T) + G f; b(T) = b + b_1 t + b_2 t^2, S(T) = diag(1 + k_1 t + k_2 t^2) S, t = T - reference_c",
                Some(truth.thermal.reference_c),
            ),
        };
        let of_accelerometer = quantities.iter().filter_map(|quantity| match quantity {
            ImuQuantity::Of(SensorKind::Accelerometer, of) => Some(of),
            _ => None,
        });
        let gauge = gauge_of(of_accelerometer, &truth[SensorKind::Accelerometer].matrix);
        Self {
            seed,
            convention,
            gauge,
            reference_c,
            parameters,
            gravity: None,
            clock: None,
            fixed,
            machine: None,
        }
    }
}

/// The form of a matrix: symmetric where its quantities are so, although rounding may hide it.
fn gauge_of<'q>(
    quantities: impl IntoIterator<Item = &'q Quantity>,
    matrix: &Matrix3<f64>,
) -> Option<&'static str> {
    let symmetric = quantities.into_iter().any(|quantity| matches!(quantity, Quantity::Symmetric(..)));
    if symmetric { Some(Gauge::Symmetric) } else { Gauge::of(matrix) }.map(Gauge::name)
}

/// The quantities that are not zero and not among these, however they are written down.
fn beside(quantities: &[ImuQuantity], truth: &ImuParameters) -> Vec<ImuQuantity> {
    let nothing = SensorParameters::linear(Vector3::zeros(), Matrix3::zeros());
    let mut reported = ImuParameters { sensors: [nothing, nothing].into(), ..ImuParameters::identity() };
    for quantity in quantities {
        quantity.add_to(&mut reported, quantity.value(truth));
    }
    let all = ImuQuantity::all(true, true).into_iter();
    // both entries of a symmetric pair are the same up to rounding
    let rounding = |quantity: &ImuQuantity| 1e-12 * quantity.value(truth).abs();
    all.filter(|quantity| (quantity.value(&reported) - quantity.value(truth)).abs() > rounding(quantity))
        .collect()
}
