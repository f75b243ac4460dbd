//! The result of a calibration on a machine.

use super::drift::SensorDrift;
use super::sample_residual::SampleResidual;
use crate::estimate::begin::middle_s;
use crate::estimate::least_squares::huber;
use crate::estimate::{MachineParameters, MachineQuantity, MachineTrust};
use crate::reference::Motion;
use calibrant_core::estimate::{Calibration, VarianceSource};
use calibrant_core::sensor::{ImuQuantity, ImuRecording, SensorKind};
use nalgebra::{DMatrix, Vector3};
use schemars::JsonSchema;
use serde::Serialize;

/// Parameters of a sensor on a machine, of the machine, and everything needed to judge them.
#[derive(Debug, Clone)]
pub struct MachineCalibration {
    /// The sensors: their parameters, how the estimation ended, how it fits, the warnings.
    pub sensors: Calibration,
    /// Trust in the log.
    pub trust: MachineTrust,
    /// Names of the joints; none for poses.
    pub joints: Vec<String>,
    /// The quantities that were estimated: those of the sensor first.
    pub quantities: Vec<MachineQuantity>,
    /// Estimates, in their order. A mounting is a turn against the nominal one.
    pub values: Vec<f64>,
    /// Covariance of the estimates. Correlated residuals are taken into account ([`inflation`](Self::inflation)), and what a turn of the mounting
    /// does to a matrix beyond first order.
    pub covariance: DMatrix<f64>,
    /// The same for independent residuals, and without second-order effects of the mounting.
    pub linear_covariance: DMatrix<f64>,
    /// The factor by which correlation in time widens the standard deviation of each estimate; 1 where residuals are independent.
    pub inflation: Vec<f64>,
    /// What a mount that gives way may have done to the estimates unseen, as a part of the covariance; 0 where nothing asks for it.
    pub unseen: DMatrix<f64>,
    /// All parameters, those that were held included.
    pub parameters: MachineParameters,
    /// What was expected beforehand: where delay and mounting begin.
    pub nominal: MachineParameters,
    /// Noise of each sensor.
    pub noise: Vec<SensorResidual>,
    /// Noise of the log: of each joint, or of position and orientation.
    pub reference_noise: Vec<ReferenceNoise>,
    /// The motion: smoothed, or estimated.
    pub motion: Motion,
    /// Intervals of the motion's splines in which the sensor's samples are used: those of gaps in the log are not.
    pub covered: Vec<bool>,
    /// Part of the sensor's samples that lie in the log's time and in none of its gaps, 0 to 1.
    pub used_share: f64,
}

/// The residuals of a sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorResidual {
    /// The sensor.
    pub sensor: SensorKind,
    /// Noise of one sample at rest, per axis, in the unit of the readings: given, or from the residuals.
    pub noise: Vector3<f64>,
    /// The part of it that neighbouring samples do not share, from second differences: what the sensor alone would have.
    pub white_noise: Vector3<f64>,
    /// `κ` of the variance `σ² (1 + κ a)`, with the activity `a` of the motion. `None` where it does not grow.
    pub growth: Option<f64>,
    /// Root mean square of the residuals, in the unit of the readings.
    pub rms: Vector3<f64>,
    /// Residuals of the samples used, in the order of time.
    pub residuals: Vec<SampleResidual>,
    /// The drift through the recording that explains them best; `None` with too few of them.
    pub drift: Option<SensorDrift>,
}

impl SensorResidual {
    /// The residuals in parts of the noise that neighbouring samples do not share.
    pub(crate) fn excess(&self) -> f64 {
        (self.rms.norm_squared() / self.white_noise.norm_squared()).sqrt()
    }
}

impl SampleResidual {
    /// The residual over its standard deviation.
    #[must_use]
    pub fn whitened(&self) -> Vector3<f64> {
        self.value.component_div(&self.sd)
    }

    /// The weight that the fit gives each component, 0 to 1: Huber's (`huber1981`).
    #[must_use]
    pub fn weights(&self) -> Vector3<f64> {
        self.whitened().map(|whitened| huber(whitened).0.powi(2))
    }
}

/// The noise of a part of the log.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ReferenceNoise {
    /// `shoulder_pan_joint`, `position.x`, `orientation.z`.
    pub name: String,
    /// Its unit: m or rad.
    pub unit: &'static str,
    /// Standard deviation of one sample.
    pub sd: f64,
    /// `κ` of the variance `σ² (1 + κ a)`.
    pub growth: Option<f64>,
    /// Samples that are outliers.
    pub outliers: usize,
    /// Number of samples.
    pub samples: usize,
}

impl MachineCalibration {
    /// Standard deviation of each estimate.
    #[must_use]
    pub fn sd(&self) -> Vec<f64> {
        self.covariance.diagonal().iter().map(|variance| variance.max(0.0).sqrt()).collect()
    }

    /// Outliers of the log, and its samples.
    pub(crate) fn outliers(&self) -> (usize, usize) {
        let add = |(outliers, samples), of: &ReferenceNoise| (outliers + of.outliers, samples + of.samples);
        self.reference_noise.iter().fold((0, 0), add)
    }

    /// Name of each quantity.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        self.quantities.iter().map(|quantity| quantity.name(&self.joints)).collect()
    }

    /// The place of a quantity.
    #[must_use]
    pub fn position(&self, quantity: MachineQuantity) -> Option<usize> {
        self.quantities.iter().position(|of| *of == quantity)
    }

    /// Value and standard deviation of a quantity that was estimated.
    #[must_use]
    pub fn estimate(&self, quantity: MachineQuantity) -> Option<(f64, f64)> {
        let place = self.position(quantity)?;
        Some((self.values[place], self.covariance[(place, place)].max(0.0).sqrt()))
    }

    /// The delay of each sensor at the first sample of the recording, s: that of the parameters is in its middle, and the clocks differ in rate.
    #[must_use]
    pub fn delays_at_start_s(&self, recording: &ImuRecording) -> Vec<(SensorKind, f64)> {
        let times = |sensor: &SensorKind| recording.sensor(*sensor);
        let sensors = self.sensors.sensor_kinds();
        let Some(middle_s) = sensors.last().and_then(times).map(middle_s) else { return Vec::new() };
        let first_s = |sensor: &SensorKind| times(sensor).and_then(|of| of.times_s().first().copied());
        let delay = |sensor: SensorKind| {
            let first_s = first_s(&sensor)?;
            Some((sensor, self.parameters.motion_time(sensor, first_s, middle_s) - first_s))
        };
        sensors.into_iter().filter_map(delay).collect()
    }

    /// Widens the covariance of all quantities, by this source.
    pub(crate) fn widen(&mut self, source: VarianceSource, by: &DMatrix<f64>) {
        self.covariance += by;
        self.sensors.covariance = of_sensors(&self.quantities, &self.covariance);
        for (row, (place, _)) in self.sensors.budget.iter_mut().zip(sensor_quantities(&self.quantities)) {
            row.add(source, by[(place, place)]);
        }
    }
}

/// The places of the sensors' quantities, and these.
pub(crate) fn sensor_quantities(
    quantities: &[MachineQuantity],
) -> impl Iterator<Item = (usize, ImuQuantity)> + '_ {
    quantities.iter().enumerate().filter_map(|(place, quantity)| match quantity {
        MachineQuantity::Imu(of) => Some((place, *of)),
        _ => None,
    })
}

/// The sensors' part of a covariance of all quantities.
pub(crate) fn of_sensors(quantities: &[MachineQuantity], covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let places: Vec<usize> = sensor_quantities(quantities).map(|(place, _)| place).collect();
    covariance.select_rows(&places).select_columns(&places)
}
