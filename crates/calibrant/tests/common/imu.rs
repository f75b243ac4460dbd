//! Simulated IMUs.

use calibrant::sensor::{Gauge, ImuParameters, SensorParameters, Thermal};
use calibrant::simulate::Rng;
use nalgebra::{Matrix3, Vector3};
use rand_distr::{Distribution, StandardNormal};

pub(crate) fn normal(rng: &mut Rng) -> f64 {
    StandardNormal.sample(rng)
}

/// An IMU of the size of MEMS errors, its accelerometer in the upper gauge, without g-sensitivity.
pub(crate) fn draw_imu(rng: &mut Rng) -> ImuParameters {
    let mut sensor = |bias: f64, spread: f64| SensorParameters {
        bias: Vector3::from_fn(|_, _| bias * normal(rng)),
        matrix: Matrix3::identity() + Matrix3::from_fn(|_, _| spread * normal(rng)),
    };
    let accelerometer = Gauge::Upper.apply(&sensor(0.1, 0.01));
    let gyroscope = sensor(0.02, 0.01);
    ImuParameters { accelerometer, gyroscope, g_sensitivity: Matrix3::zeros(), thermal: Thermal::none() }
}
