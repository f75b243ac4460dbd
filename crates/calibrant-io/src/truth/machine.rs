//! What a simulation on a machine adds to `truth.json`: what a calibration finds of the machine, and the noise.

use super::parameter::TrueParameter;
use calibrant_core::form::As;
use calibrant_machine::chain::KinematicChain;
use calibrant_machine::simulate::{DrawnMachine, LogErrors, SensorErrors};
use nalgebra::{UnitQuaternion, Vector3};
use schemars::JsonSchema;
use serde::Serialize;

/// A simulated machine: its parameters, and the noise of its sensors and its log.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct TrueMachine {
    quantities: Vec<TrueParameter>,
    gravity_mps2: f64,
    #[serde(with = "As::<[f64; 3]>")]
    lever_m: Vector3<f64>,
    #[serde(rename = "tip_from_sensor_wxyz", with = "As::<[f64; 4]>")]
    tip_from_sensor: UnitQuaternion<f64>,
    sensor_noise: Vec<TrueSensorNoise>,
    log_noise: Vec<TrueLogNoise>,
}

/// The noise of one sample, in `unit`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
struct TrueSensorNoise {
    sensor: &'static str,
    unit: &'static str,
    #[serde(with = "As::<[f64; 3]>")]
    noise: Vector3<f64>,
    vibration: f64,
}

/// The noise of one number of the log, in `unit`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
struct TrueLogNoise {
    name: String,
    unit: &'static str,
    sd: f64,
    resolution: f64,
}

impl TrueMachine {
    /// Of what was drawn. `chain`: the joints; `None` for a body with poses.
    #[must_use]
    pub fn new(
        machine: &DrawnMachine,
        chain: Option<&KinematicChain>,
        sensors: &[SensorErrors],
        log: &LogErrors,
    ) -> Self {
        let joints = chain.map_or(&[][..], |chain| &chain.joints);
        let names: Vec<String> = joints.iter().map(|joint| joint.name.clone()).collect();
        let units: Vec<&'static str> = joints.iter().map(|joint| joint.kind.unit()).collect();
        let parameters = &machine.parameters;
        let component = |k: usize| match chain {
            Some(_) => (names[k].clone(), units[k]),
            None => {
                let part = ["position", "orientation"][k / 3];
                (format!("{part}.{}", ["x", "y", "z"][k % 3]), ["m", "rad"][k / 3])
            }
        };
        Self {
            quantities: (machine.drawn.iter())
                .map(|(quantity, value)| TrueParameter {
                    name: quantity.name(&names),
                    unit: quantity.unit(&units).unwrap_or_default(),
                    value: *value,
                })
                .collect(),
            gravity_mps2: parameters.gravity_mps2,
            lever_m: parameters.mount.lever_m,
            tip_from_sensor: parameters.mount.tip_from_sensor,
            sensor_noise: (sensors.iter())
                .map(|of| TrueSensorNoise {
                    sensor: of.sensor.name(),
                    unit: of.unit.symbol(),
                    noise: of.noise,
                    vibration: of.vibration,
                })
                .collect(),
            log_noise: (log.noise.iter().enumerate())
                .map(|(k, sd)| {
                    let (name, unit) = component(k);
                    TrueLogNoise { name, unit, sd: *sd, resolution: log.resolution }
                })
                .collect(),
        }
    }
}
