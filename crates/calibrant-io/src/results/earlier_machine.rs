//! What an earlier `calibration.json` found of a machine: its geometry, mount and delays, and the noise of the sensor.

use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::SensorKind;
use calibrant_machine::chain::{ChainCorrections, KinematicChain};
use calibrant_machine::estimate::{MachineQuantity, MachineSetup};
use calibrant_recording::text::decoding::{self, Checked, refuse};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// Largest calibration file, bytes.
const LARGEST: u64 = 1 << 30;

/// What an earlier calibration found of a machine.
#[derive(Debug, Clone, PartialEq)]
pub struct EarlierMachine {
    /// The file, where it was one.
    pub file: Option<PathBuf>,
    /// Links of the chain: the one that stands still, and the one that carries the sensor.
    pub ends: [String; 2],
    /// Name and value of what was found beside the sensor's parameters: `zero.elbow`.
    pub quantities: Vec<(String, f64)>,
    /// From the tip to the sensor, m.
    pub lever_m: Vector3<f64>,
    /// The sensor's orientation at the tip.
    pub tip_from_sensor: UnitQuaternion<f64>,
    /// Density `N` of each sensor's noise in SI units: a sample's standard deviation is `N √rate`. Sensors that read counts are left out.
    pub noise_density: Vec<(SensorKind, f64)>,
    /// Noise while moving over noise at rest, where it was found.
    pub moving_noise: Option<f64>,
}

#[derive(Deserialize)]
struct File {
    schema: Option<u32>,
    machine: Option<Machine>,
    #[serde(default)]
    inputs: Vec<Input>,
}

#[derive(Deserialize)]
struct Input {
    rate_hz: f64,
}

#[derive(Deserialize)]
struct Machine {
    base: Option<String>,
    tip: Option<String>,
    quantities: Vec<Found>,
    lever_m: [f64; 3],
    tip_from_sensor_wxyz: [f64; 4],
    sensor_noise: Vec<Noise>,
}

#[derive(Deserialize)]
struct Found {
    name: String,
    value: f64,
}

#[derive(Deserialize)]
struct Noise {
    sensor: String,
    unit: String,
    noise: [f64; 3],
    growth: Option<f64>,
}

/// Reads what a `calibration.json` of a sensor on a machine found of it.
///
/// # Errors
/// [`Error::Experiment`] with the file: it cannot be read, is no such calibration, or has numbers that make no sense.
pub fn read_earlier_machine(path: &Path) -> Result<EarlierMachine> {
    let earlier = decoding::parsed(path, (LARGEST, "the calibration"), parse)?;
    Ok(EarlierMachine { file: Some(path.to_path_buf()), ..earlier })
}

/// Reads the bytes of one.
///
/// # Errors
/// As [`read_earlier_machine`], without the file.
pub fn parse_earlier_machine(bytes: &[u8]) -> Result<EarlierMachine> {
    parse(bytes).map_err(Error::Experiment)
}

fn parse(bytes: &[u8]) -> Checked<EarlierMachine> {
    let help =
        "give a calibration.json of a sensor on a machine: `calibrant calibrate arm.toml recording.csv`";
    let File { schema, machine, inputs } = serde_json::from_slice(bytes)
        .map_err(|error| InputError::new(Refusal::CalibrationUnsuited, error.to_string(), help))?;
    // a tracker has no tip, and its body is no link of a machine
    let with_ends =
        machine.and_then(|machine| Some(([machine.base.clone()?, machine.tip.clone()?], machine)));
    let Some((ends, of)) = with_ends else {
        return refuse(
            Refusal::CalibrationUnsuited,
            "this calibration is not of a sensor on a machine with joints",
            help,
        );
    };
    if schema != Some(2) {
        return refuse(Refusal::CalibrationUnsuited, "this file is not of schema 2", help);
    }
    let sizes = [
        ("machine.lever_m", of.lever_m.iter().fold(0.0, |most: f64, x| most.max(x.abs())), 100.0),
        ("machine.quantities", of.quantities.iter().fold(0.0, |most: f64, of| most.max(of.value.abs())), 1e3),
        (
            "machine.sensor_noise.noise",
            of.sensor_noise.iter().flat_map(|of| of.noise).fold(0.0, f64::max),
            1e3,
        ),
        (
            "machine.sensor_noise.growth",
            of.sensor_noise.iter().filter_map(|of| of.growth).fold(0.0, f64::max),
            1e6,
        ),
    ];
    if let Some((key, size, most)) = sizes.into_iter().find(|(_, size, most)| *size > *most) {
        let message = format!("`{key}` has a number of size {size:.0e}, and {most:.0e} is much already");
        return refuse(
            Refusal::ValueOutOfRange,
            message,
            "is the file damaged? give it as calibrant wrote it",
        );
    }
    let [w, x, y, z] = of.tip_from_sensor_wxyz;
    let turn = Quaternion::new(w, x, y, z);
    if (turn.norm() - 1.0).abs() > 1e-3 || !turn.norm().is_finite() {
        return refuse(
            Refusal::ValueInvalid,
            "machine.tip_from_sensor_wxyz is no rotation",
            "give the file as calibrant wrote it",
        );
    }
    // one file of both sensors, or one for each
    let rate = |place: usize| {
        inputs
            .get(place)
            .or(inputs.first())
            .map(|input| input.rate_hz)
            .filter(|rate| (1e-3..1e7).contains(rate))
    };
    let density = |(place, noise): (usize, &Noise)| {
        let sensor = SensorKind::ALL.into_iter().find(|kind| kind.to_string() == noise.sensor)?;
        let square = noise.noise.iter().map(|sd| sd * sd).sum::<f64>() / 3.0;
        let density = (square / rate(place)?).sqrt();
        (noise.unit == sensor.stimulus_unit().symbol() && density > 0.0).then_some((sensor, density))
    };
    let growth = of
        .sensor_noise
        .iter()
        .filter_map(|noise| noise.growth)
        .fold(None, |most: Option<f64>, one| Some(most.map_or(one, |most| most.max(one))));
    Ok(EarlierMachine {
        file: None,
        ends,
        quantities: of.quantities.into_iter().map(|found| (found.name, found.value)).collect(),
        lever_m: of.lever_m.into(),
        tip_from_sensor: UnitQuaternion::from_quaternion(turn),
        noise_density: of.sensor_noise.iter().enumerate().filter_map(density).collect(),
        moving_noise: growth.map(|growth| (1.0 + growth.max(0.0)).sqrt()),
    })
}

impl EarlierMachine {
    fn value(&self, name: &str) -> Option<f64> {
        self.quantities.iter().find(|(found, _)| found == name).map(|(_, value)| *value)
    }

    /// The chain with the zeros and the geometry that were found.
    ///
    /// # Errors
    /// [`Error::Experiment`]: it is the calibration of another machine.
    pub fn chain(&self, nominal: &KinematicChain) -> Result<KinematicChain> {
        let names: Vec<String> = nominal.joints.iter().map(|joint| joint.name.clone()).collect();
        let all = (0..names.len()).flat_map(|j| {
            let geometry =
                (0..ChainCorrections::GEOMETRY_PER_JOINT).map(move |k| MachineQuantity::Geometry(j, k));
            geometry.chain([MachineQuantity::Zero(j)])
        });
        let known: Vec<String> = all.map(|quantity| quantity.name(&names)).collect();
        let of_joint = |name: &str| name.starts_with("zero.") || name.starts_with("geometry.");
        let mut unknown = self.quantities.iter().filter(|(name, _)| of_joint(name) && !known.contains(name));
        let [base, tip] = &self.ends;
        let difference = match unknown.next() {
            _ if [base, tip] != [&nominal.base, &nominal.tip] => Some(format!(
                "it goes from {base} to {tip}, and here from {} to {}",
                nominal.base, nominal.tip
            )),
            Some((name, _)) => Some(format!("it has {name}, and the joints here are {}", names.join(", "))),
            None => None,
        };
        if let Some(difference) = difference {
            let message = format!("this calibration is of another machine: {difference}");
            let help = "give a calibration of the machine of the experiment";
            let mut input_error = InputError::new(Refusal::CalibrationUnsuited, message, help);
            input_error.file = self.file.clone();
            return Err(Error::experiment(input_error));
        }
        let of = |quantity: MachineQuantity| self.value(&quantity.name(&names)).unwrap_or(0.0);
        let mut corrections = ChainCorrections::none(names.len());
        for (j, joint) in corrections.joints.iter_mut().enumerate() {
            joint.zero = of(MachineQuantity::Zero(j));
            joint.translation_m = Vector3::from_fn(|k, _| of(MachineQuantity::Geometry(j, k)));
            joint.rotation_rad = Vector3::from_fn(|k, _| of(MachineQuantity::Geometry(j, 3 + k)));
        }
        Ok(nominal.with(&corrections))
    }

    /// What is known beforehand, with mount and delay as they were found. How well they are known stays: another sensor is mounted anew.
    #[must_use]
    pub fn setup(&self, nominal: &MachineSetup) -> MachineSetup {
        let delays: Vec<f64> = SensorKind::ALL
            .into_iter()
            .filter_map(|sensor| self.value(&MachineQuantity::Delay(sensor).name(&[])))
            .collect();
        let delay_s = match delays.len() {
            0 => nominal.delay_s,
            number => delays.iter().sum::<f64>() / number as f64,
        };
        MachineSetup {
            lever_m: self.lever_m,
            tip_from_sensor: self.tip_from_sensor,
            delay_s,
            ..nominal.clone()
        }
    }
}
