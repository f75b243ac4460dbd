//! Bias and gain of an axis along which gravity hardly varies, as on a drone that tilts by 15°, are told by small differences of large forces. The reading at the mean
//! force is well determined; what it has of each hangs on errors of the reference, which move one against the other.

use crate::estimate::{MachineCalibration, MachineQuantity, MachineSetup, TiltedGravity};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::machine::GainNotSeparable;
use calibrant_core::sensor::{Axis, ImuQuantity, Quantity, ReadingUnit, SensorKind};
use nalgebra::{DVector, Vector3};

/// A force that varies by less than this part of its mean multiplies errors of the reference by its inverse.
const LEAST_VARIATION: f64 = 0.1;
/// A mean force along an axis below this part of gravity does not hide in its bias.
const LEAST_MEAN: f64 = 0.5;

/// The axes of the accelerometer whose bias and gain are one number.
pub(super) fn check(setup: &MachineSetup, calibration: &MachineCalibration) -> Vec<Diagnostic> {
    let sensor = SensorKind::Accelerometer;
    // joints are logged so well that small differences tell
    if calibration.sensors.units[SensorKind::Accelerometer] != Some(ReadingUnit::MetrePerSecondSquared)
        || !calibration.joints.is_empty()
    {
        return Vec::new();
    }
    let (mean, variation) = force(setup, calibration);
    let is_stated =
        |of: Quantity| setup.known.iter().any(|known| known.quantity == ImuQuantity::Of(sensor, of));
    let place = |of: Quantity| calibration.position(MachineQuantity::Imu(ImuQuantity::Of(sensor, of)));
    let found = Axis::ALL.into_iter().filter_map(|axis| {
        let i = axis.index();
        let (bias, scale) = (Quantity::Bias(axis), Quantity::Scale(axis));
        let is_one = variation[i] < LEAST_VARIATION * mean[i].abs()
            && mean[i].abs() > LEAST_MEAN * calibration.parameters.gravity_mps2;
        if !is_one || is_stated(bias) || is_stated(scale) {
            return None;
        }
        let mut weights = DVector::zeros(calibration.quantities.len());
        weights[place(bias)?] = 1.0;
        weights[place(scale)?] = mean[i];
        for other in Axis::ALL.into_iter().filter(|other| *other != axis) {
            if let Some(place) = place(Quantity::CrossAxis(axis, other)) {
                weights[place] = mean[other.index()];
            }
        }
        let variance = weights.dot(&(&calibration.covariance * &weights));
        Some(GainNotSeparable {
            axis,
            variation_mps2: variation[i],
            mean_mps2: mean[i],
            reading_mps2: calibration.parameters.imu[SensorKind::Accelerometer].reading(&mean)[i],
            reading_sd_mps2: variance.max(0.0).sqrt(),
        })
    });
    found.map(Diagnostic::from).collect()
}

/// Mean and standard deviation of the specific force along each axis, m/s².
fn force(setup: &MachineSetup, calibration: &MachineCalibration) -> (Vector3<f64>, Vector3<f64>) {
    let (motion, parameters) = (&calibration.motion, &calibration.parameters);
    let gravity = TiltedGravity::new(&setup.up).vector(parameters);
    let carrier = motion.carrier(gravity, parameters.mount, &parameters.corrections);
    let (knots, mut joints) = (motion.knots(), Default::default());
    let covered = (0..knots.intervals).filter(|i| calibration.covered[*i]);
    let forces: Vec<Vector3<f64>> = covered
        .map(|i| motion.sensor(&knots.weights(knots.knot_s(i)), &carrier, &mut joints).specific_force)
        .collect();
    let number = forces.len().max(1) as f64;
    let mean = forces.iter().sum::<Vector3<f64>>() / number;
    let squares = forces.iter().map(|of| (of - mean).map(|x| x * x)).sum::<Vector3<f64>>() / number;
    (mean, squares.map(f64::sqrt))
}
