//! The model of an inertial measurement unit: an accelerometer and a gyroscope that share a frame. It defines
//! the recordings, parameters and quantities of an IMU.
//!
//! `y_a = S_a f + b_a + ν_a`, `y_g = S_g ω + b_g + Γ f + ν_g`, true → raw. `f` is the specific force in m/s²
//! and `ω` the angular rate in rad/s, both in the true frame. `Γ` is the g-sensitivity: how the gyroscope
//! responds to specific force. `S` and `b` may follow temperature ([`Thermal`]).

use super::per_sensor::indexed_by_sensor;
use super::spikes::{Spikes, without};
use super::{
    Axis, CovarianceDegrees, CovariancePart, PerSensor, Quantity, ReadingUnit, Recording, SensorKind,
    SensorParameters, SharedErrors, Thermal, ThermalPart, ThermalTerm,
};
use nalgebra::{DMatrix, Matrix3, Vector3};
use std::borrow::Cow;

/// A recording of an IMU. Its sensors share a clock, not necessarily their sample times.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ImuRecording {
    /// Readings of each sensor, in the unit of its stimulus or in counts.
    pub sensors: PerSensor<Option<Recording>>,
    /// Temperature in °C at the sample times of the accelerometer (of the gyroscope where there is none).
    pub temperature_c: Option<Vec<f64>>,
}

impl ImuRecording {
    /// The recording of one sensor.
    #[must_use]
    pub fn sensor(&self, sensor_kind: SensorKind) -> Option<&Recording> {
        self.sensors[sensor_kind].as_ref()
    }

    /// The sensors that it has.
    pub fn sensors(&self) -> impl Iterator<Item = (SensorKind, &Recording)> {
        self.sensors.present()
    }

    /// The accelerometer, where nothing else was recorded.
    #[must_use]
    pub fn accelerometer_alone(&self) -> Option<&Recording> {
        let others = self.sensors().any(|(sensor_kind, _)| sensor_kind != SensorKind::Accelerometer);
        self.sensor(SensorKind::Accelerometer).filter(|_| !others && self.temperature_c.is_none())
    }

    /// Adds another recording of the same sensors, which begins `pause_s` after the end of this one: in the pause nothing is known of the motion. Returns when it begins, s.
    pub fn append(&mut self, other: &Self, pause_s: f64) -> f64 {
        let ends = |of: &Self, end: fn(&[f64]) -> Option<&f64>, far: fn(f64, f64) -> f64| {
            of.sensors().filter_map(|(_, recording)| end(&recording.times_s).copied()).reduce(far)
        };
        let end_s = ends(self, <[f64]>::last, f64::max).unwrap_or_default();
        let start_s = ends(other, <[f64]>::first, f64::min).unwrap_or_default();
        let later_s = end_s + pause_s - start_s;
        for (sensor_kind, added) in other.sensors() {
            if let Some(recording) = &mut self.sensors[sensor_kind] {
                recording.append(added, later_s);
            }
        }
        if let (Some(temperature_c), Some(added)) = (&mut self.temperature_c, &other.temperature_c) {
            temperature_c.extend_from_slice(added);
        }
        start_s + later_s
    }

    /// The recording at one temperature, °C, whatever temperature was recorded.
    #[must_use]
    pub fn at_temperature(self, celsius: f64) -> Self {
        let samples = self.sensors().next().map_or(0, |(_, first)| first.len());
        Self { temperature_c: Some(vec![celsius; samples]), ..self }
    }

    /// The recording without spikes and invalid readings of either sensor ([`Recording::without_spikes`]),
    /// and those that were removed.
    #[must_use]
    pub fn without_spikes(&self) -> (Cow<'_, Self>, Vec<(SensorKind, Spikes)>) {
        self.cleaned(|sensor_kind| sensor_kind == SensorKind::Gyroscope)
    }

    /// The gyroscope with the spikes that [`without_spikes`](Self::without_spikes) finds in its movements, where there are some: they may be knocks. With
    /// the number of them, and what is removed nevertheless.
    #[must_use]
    pub fn gyroscope_with_knocks(&self) -> Option<(Recording, usize, Option<Spikes>)> {
        let gyroscope = self[SensorKind::Gyroscope].as_ref()?;
        let (_, all) = gyroscope.without_spikes_beside(self[SensorKind::Accelerometer].as_ref(), true);
        let (kept, at_rest) =
            gyroscope.without_spikes_beside(self[SensorKind::Accelerometer].as_ref(), false);
        let others = all?.samples.len() - at_rest.as_ref().map_or(0, |spikes| spikes.samples.len());
        (others > 0).then(|| (kept.into_owned(), others, at_rest))
    }

    /// The same for a recording on a machine, where the movements of both sensors count.
    #[must_use]
    pub fn without_spikes_in_motion(&self) -> (Cow<'_, Self>, Vec<(SensorKind, Spikes)>) {
        self.cleaned(|_| true)
    }

    fn cleaned(
        &self,
        moves: impl Fn(SensorKind) -> bool + Sync,
    ) -> (Cow<'_, Self>, Vec<(SensorKind, Spikes)>) {
        let clean = |sensor_kind: SensorKind| {
            let beside = self.sensors().find(|(other, _)| *other != sensor_kind).map(|(_, other)| other);
            let recording = self.sensor(sensor_kind)?;
            let (clean, spikes) = recording.without_spikes_beside(beside, moves(sensor_kind));
            spikes.map(|spikes| (clean.into_owned(), spikes))
        };
        let (accelerometer, gyroscope) =
            rayon::join(|| clean(SensorKind::Accelerometer), || clean(SensorKind::Gyroscope));
        let mut recording = Cow::Borrowed(self);
        let mut found = Vec::new();
        for (sensor_kind, clean) in SensorKind::ALL.into_iter().zip([accelerometer, gyroscope]) {
            let Some((clean, spikes)) = clean else { continue };
            let recording = recording.to_mut();
            // there is one temperature for each sample of the accelerometer
            let of_temperature = recording.sensors().next().is_some_and(|(first, _)| first == sensor_kind);
            if let Some(temperatures) = recording.temperature_c.as_mut().filter(|_| of_temperature) {
                without(temperatures, &spikes.cut);
            }
            recording[sensor_kind] = Some(clean);
            found.push((sensor_kind, spikes));
        }
        (recording, found)
    }
}

impl From<Recording> for ImuRecording {
    /// The recording of an accelerometer alone.
    fn from(accelerometer: Recording) -> Self {
        Self::default().with(SensorKind::Accelerometer, Some(accelerometer))
    }
}

indexed_by_sensor!(ImuRecording, Option<Recording>);

/// The values of an IMU's parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImuParameters {
    /// `b`, `S` of each sensor.
    pub sensors: PerSensor<SensorParameters>,
    /// `Γ`, in the unit of the gyroscope's readings per m/s².
    pub g_sensitivity: Matrix3<f64>,
    /// The temperature coefficients. Biases and gains are those at the reference temperature.
    pub thermal: Thermal,
}

impl ImuParameters {
    /// A perfect IMU.
    #[must_use]
    pub fn identity() -> Self {
        Self {
            sensors: PerSensor::from_fn(|_| SensorParameters::identity()),
            g_sensitivity: Matrix3::zeros(),
            thermal: Thermal::none(),
        }
    }

    /// The parameters of one sensor.
    #[must_use]
    pub fn sensor(&self, sensor_kind: SensorKind) -> &SensorParameters {
        &self.sensors[sensor_kind]
    }
}

indexed_by_sensor!(ImuParameters, SensorParameters);

/// One scalar quantity of an IMU's model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImuQuantity {
    /// A quantity of one of the sensors; printed `gyroscope.scale.x`.
    Of(SensorKind, Quantity),
    /// Entry of `Γ`, (row, column): the response of gyroscope axis `row` to the specific force along
    /// `column`; printed `gyroscope.g_sensitivity.xy`.
    GSensitivity(Axis, Axis),
    /// A temperature coefficient of one of the sensors; printed `gyroscope.bias_per_k.x`.
    Thermal(SensorKind, ThermalTerm),
}

/// Where the derivative of a reading is taken.
#[derive(Debug, Clone, Copy)]
pub struct Condition<'a> {
    /// The IMU.
    pub imu: &'a ImuParameters,
    /// Stimulus of the sensor.
    pub stimulus: Vector3<f64>,
    /// Specific force, m/s².
    pub force: Vector3<f64>,
    /// Temperature, °C.
    pub temperature_c: f64,
}

impl ImuQuantity {
    /// Its name everywhere: files, tables, errors and plots.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Of(sensor_kind, quantity) => format!("{sensor_kind}.{}", quantity.name()),
            Self::GSensitivity(row, column) => format!("gyroscope.g_sensitivity.{row}{column}"),
            Self::Thermal(sensor_kind, term) => format!("{sensor_kind}.{}", term.name()),
        }
    }

    /// Its unit, for readings of its sensor in this unit; pure numbers are printed as `1`.
    #[must_use]
    pub fn unit(self, reading: ReadingUnit) -> &'static str {
        match (self, reading) {
            (Self::Of(_, Quantity::Bias(_)), unit) => unit.symbol(),
            (Self::Of(_, Quantity::Nonlinear(term, _)), _) => term.unit(),
            (Self::Of(SensorKind::Accelerometer, _), ReadingUnit::Counts) => "counts/(m/s²)",
            (Self::Of(SensorKind::Gyroscope, _), ReadingUnit::Counts) => "counts/(rad/s)",
            (Self::Of(..), _) => "1",
            (Self::GSensitivity(..), ReadingUnit::Counts) => "counts/(m/s²)",
            (Self::GSensitivity(..), _) => "(rad/s)/(m/s²)",
            (Self::Thermal(_, term), unit) => term.unit(unit),
        }
    }

    /// The sensor that it belongs to.
    #[must_use]
    pub fn sensor_kind(self) -> SensorKind {
        match self {
            Self::Of(sensor_kind, _) | Self::Thermal(sensor_kind, _) => sensor_kind,
            Self::GSensitivity(..) => SensorKind::Gyroscope,
        }
    }

    /// The part of the covariance that it belongs to.
    pub(crate) fn covariance_part(self) -> CovariancePart {
        match self {
            _ if self.sensor_kind() == SensorKind::Accelerometer => CovariancePart::Accelerometer,
            Self::GSensitivity(..) => CovariancePart::GyroscopeAtRest,
            _ if self.is_of_bias() => CovariancePart::GyroscopeAtRest,
            _ => CovariancePart::GyroscopeMatrix,
        }
    }

    /// Its value in an IMU.
    #[must_use]
    pub fn value(self, imu: &ImuParameters) -> f64 {
        match self {
            Self::Of(sensor_kind, quantity) => quantity.value(imu.sensor(sensor_kind)),
            Self::GSensitivity(row, column) => imu.g_sensitivity[(row.index(), column.index())],
            Self::Thermal(sensor_kind, term) => term.value(imu.thermal.sensor(sensor_kind)),
        }
    }

    /// Adds `step` to it.
    pub fn add_to(self, imu: &mut ImuParameters, step: f64) {
        match self {
            Self::Of(sensor_kind, quantity) => quantity.add_to(&mut imu[sensor_kind], step),
            Self::GSensitivity(row, column) => imu.g_sensitivity[(row.index(), column.index())] += step,
            Self::Thermal(sensor_kind, term) => term.add_to(&mut imu.thermal[sensor_kind], step),
        }
    }

    /// Is it a term of a bias? It then moves readings for any stimulus.
    #[must_use]
    pub fn is_of_bias(self) -> bool {
        match self {
            Self::Of(_, quantity) => matches!(quantity, Quantity::Bias(_)),
            Self::Thermal(_, term) => term.part == ThermalPart::Bias,
            Self::GSensitivity(..) => false,
        }
    }

    /// Derivative of the reading of its sensor with respect to it.
    #[must_use]
    pub fn derivative(self, at: &Condition<'_>) -> Vector3<f64> {
        let thermal = &at.imu.thermal;
        let mut derivative = Vector3::zeros();
        match self {
            Self::Of(sensor_kind, quantity) => {
                let of_reading = quantity.derivative(at.imu.sensor(sensor_kind), &at.stimulus);
                if matches!(quantity, Quantity::Bias(_)) {
                    return of_reading;
                }
                // the gain follows temperature, bent or not
                let factor = thermal.sensor(sensor_kind).gain_factor(thermal.tau_k(at.temperature_c));
                return of_reading.component_mul(&factor);
            }
            Self::GSensitivity(row, column) => derivative[row.index()] = at.force[column.index()],
            Self::Thermal(sensor_kind, term) => {
                let axis = term.axis.index();
                let power = term.power(thermal.tau_k(at.temperature_c));
                derivative[axis] = match term.part {
                    ThermalPart::Bias => power,
                    ThermalPart::Scale => power * at.imu.sensor(sensor_kind).response(axis, &at.stimulus),
                };
            }
        }
        derivative
    }
}

/// A calibrated IMU in the form that `convert`, `apply` and `compare` share with other programs.
#[derive(Debug, Clone, PartialEq)]
pub struct CalibratedImu {
    /// The values. Those of a sensor that was not calibrated have no meaning.
    pub parameters: ImuParameters,
    /// Unit of each sensor's readings; `None` where it was not calibrated.
    pub units: PerSensor<Option<ReadingUnit>>,
    /// The sensitivity of each sensor whose raw readings are counts: those per m/s² or rad/s, by which they are readings in [`units`](Self::units). `None` where the
    /// readings were not counts, or are calibrated as counts.
    pub counts_per_unit: PerSensor<Option<f64>>,
    /// The quantities of the covariance, in its order. Without a covariance, the quantities that are known.
    pub quantities: Vec<ImuQuantity>,
    /// Covariance of these quantities; `None` where it is not known.
    pub covariance: Option<DMatrix<f64>>,
    /// Degrees of freedom behind the covariance; `None` where they are not known.
    pub degrees_of_freedom: Option<CovarianceDegrees>,
    /// The part of the covariance that other calibrations at the same place share; `None` where none is known.
    pub shared: Option<SharedErrors>,
    /// The true frame, in words.
    pub frame: String,
}

impl CalibratedImu {
    /// An IMU without a covariance, from the units of its sensors and its frame in words.
    #[must_use]
    pub fn new(
        parameters: ImuParameters,
        units: impl Into<PerSensor<Option<ReadingUnit>>>,
        quantities: Vec<ImuQuantity>,
        frame: impl Into<String>,
    ) -> Self {
        let (units, frame) = (units.into(), frame.into());
        Self {
            parameters,
            units,
            counts_per_unit: PerSensor::default(),
            quantities,
            covariance: None,
            degrees_of_freedom: None,
            shared: None,
            frame,
        }
    }

    /// Unit of a sensor's readings; `None` where it was not calibrated.
    #[must_use]
    pub fn unit(&self, sensor_kind: SensorKind) -> Option<ReadingUnit> {
        self.units[sensor_kind]
    }

    /// Degrees of freedom behind a part of its covariance; infinite where the variances count as known.
    pub(crate) fn degrees_behind(&self, part: CovariancePart) -> f64 {
        let degrees = self.degrees_of_freedom.map(|degrees| degrees.of_part(part));
        degrees.filter(|degrees| *degrees > 0.0).unwrap_or(f64::INFINITY)
    }

    /// Are the biases of a sensor known? Kalibr's files have no covariance and list no biases: zeros stand in
    /// their place.
    #[must_use]
    pub fn has_bias(&self, sensor_kind: SensorKind) -> bool {
        let listed = |quantity: &ImuQuantity| matches!(quantity, ImuQuantity::Of(of, Quantity::Bias(_)) if *of == sensor_kind);
        // in one pose, only what temperature does to it is known
        let changes = |quantity: &ImuQuantity| matches!(quantity, ImuQuantity::Thermal(of, term) if *of == sensor_kind && term.part == ThermalPart::Bias);
        let known = self.covariance.is_some() && !self.quantities.iter().any(changes);
        self.unit(sensor_kind).is_some()
            && (known || self.quantities.is_empty() || self.quantities.iter().any(listed))
    }

    /// One sensor alone; the gyroscope keeps its g-sensitivity.
    #[must_use]
    pub fn only(&self, sensor_kind: SensorKind) -> Self {
        let kept: Vec<usize> =
            (0..self.quantities.len()).filter(|&k| self.quantities[k].sensor_kind() == sensor_kind).collect();
        let mut imu = self.clone();
        for without in SensorKind::ALL.into_iter().filter(|of| *of != sensor_kind) {
            imu.units[without] = None;
            imu.counts_per_unit[without] = None;
            imu.parameters[without] = SensorParameters::identity();
            imu.parameters.thermal[without] = Default::default();
        }
        if imu.units[SensorKind::Gyroscope].is_none() {
            imu.parameters.g_sensitivity = Matrix3::zeros();
        }
        imu.restrict(&kept);
        imu
    }

    /// Removes all quantities but these.
    pub(super) fn restrict(&mut self, kept: &[usize]) {
        self.quantities = kept.iter().map(|&k| self.quantities[k]).collect();
        self.covariance = self
            .covariance
            .as_ref()
            .map(|sigma| DMatrix::from_fn(kept.len(), kept.len(), |i, j| sigma[(kept[i], kept[j])]));
        self.shared = self.shared.as_ref().map(|shared| shared.restricted(kept));
    }
}
