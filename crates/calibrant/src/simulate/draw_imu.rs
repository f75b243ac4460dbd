//! A whole IMU drawn from the datasheet.

use super::{Rng, draw_sensor};
use crate::sensor::{ImuParameters, Sensor, SensorModel, SensorParameters, Thermal};
use nalgebra::{Matrix3, Vector3};
use rand_distr::{Distribution, StandardNormal};

/// Spread of the bias where the datasheet gives none, m/s² and rad/s.
const BIAS_SD: [f64; 2] = [0.1, 0.02];
/// Spread of the entries of the matrix over the gain where the datasheet gives none.
const MATRIX_SD: f64 = 0.01;
/// Spread of the g-sensitivity, (rad/s)/(m/s²).
const G_SENSITIVITY_SD: f64 = 2e-4;

/// The gyroscope that is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GyroscopeToDraw {
    /// Which errors it has.
    pub model: SensorModel,
    /// Nominal gain in the unit of the readings per rad/s; 1 for readings in rad/s.
    pub gain: Vector3<f64>,
    /// Has it g-sensitivity?
    pub g_sensitivity: bool,
}

/// An IMU drawn from the accelerometer's datasheet and the gyroscope's gain. Spreads that no datasheet gives are those of common MEMS sensors: biases of
/// 0.1 m/s² and 0.02 rad/s, gains and misalignments of 1 %, g-sensitivities of 2e-4 (rad/s)/(m/s²).
#[must_use]
pub fn draw_imu(accelerometer: &Sensor, gyroscope: &GyroscopeToDraw, rng: &mut Rng) -> ImuParameters {
    let spread = Sensor {
        bias_sd_mps2: Some(accelerometer.bias_sd_mps2.unwrap_or_else(|| Vector3::repeat(BIAS_SD[0]))),
        scale_sd: Some(accelerometer.scale_sd.unwrap_or_else(|| Vector3::repeat(MATRIX_SD))),
        cross_axis_sd: Some(accelerometer.cross_axis_sd.unwrap_or(MATRIX_SD)),
        ..accelerometer.clone()
    };
    let of_accelerometer = draw_sensor(&spread, rng);
    let mut draw = |sd: f64| -> f64 {
        let z: f64 = StandardNormal.sample(rng);
        sd * z
    };
    let gain = Matrix3::from_diagonal(&gyroscope.gain);
    let bias = gain * Vector3::from_fn(|_, _| draw(BIAS_SD[1]));
    let errors = Matrix3::from_fn(|row, column| {
        let error = draw(MATRIX_SD);
        if row == column || gyroscope.model == SensorModel::Full { error } else { 0.0 }
    });
    let felt = Matrix3::from_fn(|_, _| draw(G_SENSITIVITY_SD));
    ImuParameters {
        accelerometer: of_accelerometer,
        gyroscope: SensorParameters { bias, matrix: gain * (Matrix3::identity() + errors) },
        g_sensitivity: if gyroscope.g_sensitivity { gain * felt } else { Matrix3::zeros() },
        thermal: Thermal::none(),
    }
}
