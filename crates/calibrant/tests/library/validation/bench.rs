//! The bench of the validation tests: a simulated IMU, calibrated from one recording and validated on
//! another.

use crate::common::normal;
use crate::common::{steady_imu, unfeeling_gyroscope};
use calibrant::estimate::{
    Calibration, CalibrationSettings, CovarianceVerdict, ErrorKind, Gyroscope, GyroscopeCalibration,
    HoldCalibration, ImuProblem, ImuSetup, Recovered, ValidatedErrors, Validation, calibrate_imu,
    cross_validate_imu, validate_imu,
};
use calibrant::sensor::{ImuParameters, ImuRecording, Sensor, SensorKind, SensorModel};
use calibrant::simulate::{ImuSimulation, Rng, simulate_imu};
use nalgebra::Vector3;

pub(crate) struct Bench {
    pub(crate) accelerometer: Sensor,
    pub(crate) gyroscope: Gyroscope,
    pub(crate) setup: ImuSetup,
}

impl Bench {
    pub(crate) fn new() -> Self {
        Self {
            accelerometer: Sensor::triaxial(SensorModel::Full),
            gyroscope: unfeeling_gyroscope(),
            setup: steady_imu(),
        }
    }

    pub(crate) fn problem<'a>(&'a self, recording: &'a ImuRecording) -> ImuProblem<'a> {
        ImuProblem {
            accelerometer: &self.accelerometer,
            gyroscope: &self.gyroscope,
            recording,
            setup: &self.setup,
        }
    }

    pub(crate) fn calibrate(&self, recording: &ImuRecording) -> Calibration {
        calibrate_imu(&self.problem(recording), &CalibrationSettings::default()).expect("determined")
    }

    pub(crate) fn validate(&self, calibration: &Calibration, recording: &ImuRecording) -> Validation {
        validate_imu(calibration, &self.problem(recording)).expect("holds")
    }

    pub(crate) fn fold(
        &self,
        calibration: &Calibration,
        recording: &ImuRecording,
        folds: usize,
    ) -> Validation {
        cross_validate_imu(calibration, &self.problem(recording), &CalibrationSettings::default(), folds)
            .expect("determined")
    }
}

/// Holds known to the sample, so that no slow start of a turn falls into one.
pub(crate) fn intervals(simulation: &ImuSimulation) -> Vec<(f64, f64)> {
    let period = simulation.hold_s + simulation.turn_s;
    (0..simulation.poses)
        .map(|j| j as f64 * period)
        .map(|start| (start + 0.02, start + simulation.hold_s - 0.02))
        .collect()
}

/// Scatter that no sample's noise explains. It is a disturbance of each hold, a bias that wanders from hold
/// to hold, and one that comes and goes with each turn.
fn scatter(recording: &mut ImuRecording, simulation: &ImuSimulation, size: f64, rng: &mut Rng) {
    let period = simulation.hold_s + simulation.turn_s;
    let mut vectors = |sd: f64| -> Vec<Vector3<f64>> {
        (0..=simulation.poses).map(|_| Vector3::from_fn(|_, _| sd * normal(rng))).collect()
    };
    let (pushes, biases, swings) = (vectors(2e-3 * size), vectors(5e-4 * size), vectors(2e-3 * size));
    let accelerometer = recording[SensorKind::Accelerometer].as_mut().expect("there");
    for (t, y) in accelerometer.samples_mut() {
        *y += pushes[(t / period) as usize];
    }
    let gyroscope = recording[SensorKind::Gyroscope].as_mut().expect("there");
    for (t, y) in gyroscope.samples_mut() {
        let j = (t / period) as usize;
        let into = t - j as f64 * period - simulation.hold_s;
        if into > 0.0 {
            let x = into / simulation.turn_s;
            *y += swings[j] + biases[j] * (1.0 - x) + biases[j + 1] * x;
        } else {
            *y += biases[j];
        }
    }
}

pub(crate) fn simulate(
    truth: &ImuParameters,
    simulation: &ImuSimulation,
    size: f64,
    rng: &mut Rng,
) -> ImuRecording {
    let mut recording = simulate_imu(truth, simulation, rng);
    scatter(&mut recording, simulation, size, rng);
    recording
}

pub(crate) fn bench(simulation: &ImuSimulation) -> Bench {
    let mut bench = Bench::new();
    bench.setup.holds.intervals_s = Some(intervals(simulation));
    bench
}

/// The kinds of errors.
pub(crate) const KINDS: [ErrorKind; 3] = [ErrorKind::Magnitude, ErrorKind::Rate, ErrorKind::Rotation];

pub(crate) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    values.iter().sum::<f64>() / values.len() as f64
}

/// Share of the validations with this verdict.
pub(crate) fn share(of: &[&ValidatedErrors], verdict: CovarianceVerdict) -> f64 {
    mean(of.iter().map(|errors| f64::from(u8::from(errors.verdict == verdict))))
}

/// What a calibration found of its holds, to tamper with it.
pub(crate) fn holds_mut(calibration: &mut Calibration) -> &mut HoldCalibration {
    match &mut calibration.recovered {
        Recovered::Holds(holds) => holds,
        _ => panic!("held"),
    }
}

/// What a calibration found of its gyroscope, to tamper with it.
pub(crate) fn gyroscope_mut(calibration: &mut Calibration) -> &mut GyroscopeCalibration {
    calibration.gyroscope.as_mut().expect("an IMU")
}
