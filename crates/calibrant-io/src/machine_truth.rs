//! Writes `truth.json` of a simulation on a machine: the fields of that of an IMU, and in `machine` what a calibration finds of the machine.

use super::json;
use super::truth::{TruthFile, imu_truth};
use calibrant_core::error::Result;
use calibrant_core::sensor::{ImuQuantity, ReadingUnit};
use calibrant_machine::chain::KinematicChain;
use calibrant_machine::simulate::{DrawnMachine, LogErrors, SensorErrors};
use serde::Serialize;
use std::path::Path;

/// A simulated machine and the sensor on it.
#[derive(Debug, Clone, Copy)]
pub struct MachineTruth<'a> {
    /// The parameters, and those that were drawn.
    pub machine: &'a DrawnMachine,
    /// The quantities of the sensor that a calibration finds.
    pub quantities: &'a [ImuQuantity],
    /// Units of accelerometer and gyroscope.
    pub units: [ReadingUnit; 2],
    /// The joints; `None` for a body with poses.
    pub chain: Option<&'a KinematicChain>,
    /// Noise of the sensors.
    pub sensors: &'a [SensorErrors],
    /// Noise of the log.
    pub log: &'a LogErrors,
}

/// Writes `truth.json`, with the names and units of `calibration.json`.
///
/// # Errors
/// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
pub fn write_machine_truth(path: &Path, seed: u64, truth: &MachineTruth<'_>) -> Result<()> {
    let imu = imu_truth(seed, truth.quantities, truth.units, &truth.machine.parameters.imu);
    json::write_json(path, &MachineTruthFile { imu, machine: MachineFields::of(truth) })
}

#[derive(Serialize)]
struct MachineTruthFile {
    #[serde(flatten)]
    imu: TruthFile,
    machine: MachineFields,
}

#[derive(Serialize)]
struct MachineFields {
    quantities: Vec<TrueQuantity>,
    gravity_mps2: f64,
    lever_m: Vec<f64>,
    tip_from_sensor_wxyz: [f64; 4],
    sensor_noise: Vec<TrueSensorNoise>,
    log_noise: Vec<TrueLogNoise>,
}

#[derive(Serialize)]
struct TrueQuantity {
    name: String,
    unit: &'static str,
    value: f64,
}

#[derive(Serialize)]
struct TrueSensorNoise {
    sensor: &'static str,
    unit: &'static str,
    noise: Vec<f64>,
    vibration: f64,
}

#[derive(Serialize)]
struct TrueLogNoise {
    name: String,
    unit: &'static str,
    sd: f64,
    resolution: f64,
}

impl MachineFields {
    fn of(truth: &MachineTruth<'_>) -> Self {
        let joints = truth.chain.map_or(&[][..], |chain| &chain.joints);
        let names: Vec<String> = joints.iter().map(|joint| joint.name.clone()).collect();
        let units: Vec<&'static str> = joints.iter().map(|joint| joint.kind.unit()).collect();
        let parameters = &truth.machine.parameters;
        let rotation = parameters.mount.tip_from_sensor;
        let component = |k: usize| match truth.chain {
            Some(_) => (names[k].clone(), units[k]),
            None => {
                let part = ["position", "orientation"][k / 3];
                (format!("{part}.{}", ["x", "y", "z"][k % 3]), ["m", "rad"][k / 3])
            }
        };
        Self {
            quantities: (truth.machine.drawn.iter())
                .map(|(quantity, value)| TrueQuantity {
                    name: quantity.name(&names),
                    unit: quantity.unit(&units).unwrap_or_default(),
                    value: *value,
                })
                .collect(),
            gravity_mps2: parameters.gravity_mps2,
            lever_m: parameters.mount.lever_m.iter().copied().collect(),
            tip_from_sensor_wxyz: [rotation.w, rotation.i, rotation.j, rotation.k],
            sensor_noise: (truth.sensors.iter())
                .map(|of| TrueSensorNoise {
                    sensor: of.sensor.name(),
                    unit: of.unit.symbol(),
                    noise: of.noise.iter().copied().collect(),
                    vibration: of.vibration,
                })
                .collect(),
            log_noise: (truth.log.noise.iter().enumerate())
                .map(|(k, sd)| {
                    let (name, unit) = component(k);
                    TrueLogNoise { name, unit, sd: *sd, resolution: truth.log.resolution }
                })
                .collect(),
        }
    }
}
