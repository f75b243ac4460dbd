//! Solves a problem of `peers/casadi/machine_estimate.py` and compares the answers: a small machine with noisy joints.
//! `cargo run --release -p calibrant --features programs --example peer_machine_estimate -- PROBLEM.json RESULT.json`; `scripts/peers` runs both.
//!
//! Fails where a parameter differs by more than 1e-6 of its standard deviation, or a standard deviation by more than 1e-3 of itself.

use calibrant::machine::chain::{Joint, JointKind, JointLimits, KinematicChain};
use calibrant::machine::estimate::{
    MachineProblem, MachineQuantity, MachineSettings, MachineSetup, MountingPrior, calibrate_on_machine,
};
use calibrant::machine::log::{JointLog, ReferenceLog};
use calibrant::sensor::{
    Axis, ImuParameters, ImuQuantity, ImuRecording, ParameterList, ReadingUnit, Recording, SensorKind,
    SensorModel,
};
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, Unit, UnitQuaternion, Vector3};
use serde_json::Value;
use std::error::Error;
use std::f64::consts::SQRT_2;

/// Largest difference of a parameter, in standard deviations.
const SAME: f64 = 1e-6;
/// Largest relative difference of a standard deviation: control points have a little information of their own.
const SAME_SD: f64 = 1e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let files: Vec<String> = std::env::args().skip(1).collect();
    let [problem, result] = files.as_slice() else {
        return Err("usage: peer_machine_estimate PROBLEM.json RESULT.json".into());
    };
    let read = |file: &String| -> Result<Value, Box<dyn Error>> {
        Ok(serde_json::from_str(&std::fs::read_to_string(file)?)?)
    };
    let (problem, result) = (read(problem)?, read(result)?);
    let chain = chain(&problem["chain"])?;
    let log = joint_log(&problem["joint_log"], &chain)?;
    let recording = recording(&problem["imu"])?;
    let list = ParameterList::new(3, SensorModel::Full);
    let quantities: Vec<ImuQuantity> = SensorKind::ALL
        .into_iter()
        .flat_map(|kind| list.quantities().iter().map(move |of| ImuQuantity::Of(kind, *of)))
        .collect();
    let setup = setup(&problem)?;
    let problem = MachineProblem {
        recording: &recording,
        log: &ReferenceLog::Joints(log),
        chain: Some(&chain),
        setup: &setup,
        nominal: &ImuParameters::identity(),
        quantities: &quantities,
    };
    let settings = MachineSettings { tolerance: 1e-9, ..MachineSettings::default() };
    let ours = calibrate_on_machine(&problem, &settings)?;
    let (parameters, covariance) = (numbers(&result["parameters"])?, &result["covariance"]);
    let (mut largest, mut largest_sd) = (0.0_f64, 0.0_f64);
    for (k, quantity) in ours.quantities.iter().enumerate() {
        let place = place(*quantity, chain.joints.len());
        let sd = number(&covariance[place][place])?.sqrt();
        let our_sd = ours.linear_covariance[(k, k)].sqrt();
        largest = largest.max((ours.values[k] - parameters[place]).abs() / sd);
        largest_sd = largest_sd.max((our_sd / sd - 1.0).abs());
    }
    println!(
        "{} parameters, {} iterations: the largest difference is {largest:.1e} standard deviations; these differ by {largest_sd:.1e}",
        ours.quantities.len(),
        ours.sensors.iterations
    );
    if largest > SAME || largest_sd > SAME_SD {
        return Err("the answers differ".into());
    }
    Ok(())
}

/// Where the peer has a parameter.
fn place(quantity: MachineQuantity, joints: usize) -> usize {
    let of_sensor = |kind: SensorKind| if kind == SensorKind::Accelerometer { 0 } else { 12 };
    match quantity {
        MachineQuantity::Imu(ImuQuantity::Of(kind, of)) => match of.entry() {
            Some((row, column)) => of_sensor(kind) + 3 + 3 * row.index() + column.index(),
            None => of_sensor(kind) + of.axis().index(),
        },
        MachineQuantity::Imu(_) | MachineQuantity::Gravity => unreachable!("it is not estimated"),
        MachineQuantity::Lever(axis) => 24 + axis.index(),
        MachineQuantity::Mounting(axis) => 27 + axis.index(),
        MachineQuantity::Tilt(k) => 30 + k,
        MachineQuantity::Delay(SensorKind::Accelerometer) => 32,
        MachineQuantity::Delay(SensorKind::Gyroscope) => 33,
        MachineQuantity::ClockRate => 34,
        MachineQuantity::Geometry(j, k) => 35 + 6 * j + k,
        MachineQuantity::Zero(j) => 35 + 6 * joints + j,
    }
}

fn setup(problem: &Value) -> Result<MachineSetup, Box<dyn Error>> {
    let (mean, sd) = (numbers(&problem["prior"]["mean"])?, &problem["prior"]["sd"]);
    let sd = |k: usize| number(&sd[k]);
    let spacing_s = number(&problem["knots"]["spacing"])?;
    let imu = &problem["imu"];
    let of_sensor = |key: &str| number(&imu[key]).map(|sd| Some(Vector3::repeat(sd)));
    Ok(MachineSetup {
        gravity_mps2: number(&problem["gravity"])?,
        lever_m: Vector3::new(mean[24], mean[25], mean[26]),
        lever_sd_m: sd(24)?,
        mounting: MountingPrior::Within(sd(27)?),
        tilt_sd_rad: sd(30)?,
        // independent delays: their mean and half their difference have the same standard deviation
        delay_sd_s: sd(32)? / SQRT_2,
        delay_difference_sd_s: sd(32)? * SQRT_2,
        clock_rate_sd: sd(34)?,
        geometry_translation_sd_m: sd(35)?,
        geometry_rotation_sd_rad: sd(38)?,
        zero_sd: sd(mean.len() - 1)?,
        knot_step_s: Some(spacing_s),
        accelerometer_noise: of_sensor("accelerometer_sd")?,
        gyroscope_noise: of_sensor("gyroscope_sd")?,
        reference_noise: Some(numbers(&problem["joint_log"]["sd"])?),
        ..MachineSetup::default()
    })
}

fn chain(of: &Value) -> Result<KinematicChain, Box<dyn Error>> {
    let joints = of["joints"].as_array().ok_or("no joints")?.iter().enumerate().map(|(j, joint)| {
        let turns = joint["kind"] == "revolute";
        Ok(Joint {
            name: format!("joint_{j}"),
            kind: if turns { JointKind::Continuous } else { JointKind::Prismatic },
            axis: Unit::new_normalize(vector(&joint["axis"])?),
            origin: pose(joint)?,
            limits: JointLimits::default(),
        })
    });
    Ok(KinematicChain {
        base: "base".into(),
        tip: "tip".into(),
        joints: joints.collect::<Result<_, Box<dyn Error>>>()?,
        tip_transform: pose(&of["tip"])?,
    })
}

fn pose(of: &Value) -> Result<Isometry3<f64>, Box<dyn Error>> {
    let rotation = Matrix3::from_row_slice(&numbers(&of["rotation"])?);
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
    Ok(Isometry3::from_parts(Translation3::from(vector(&of["translation"])?), rotation))
}

fn joint_log(of: &Value, chain: &KinematicChain) -> Result<JointLog, Box<dyn Error>> {
    let rows = of["positions"].as_array().ok_or("no positions")?;
    let positions = rows.iter().map(numbers).collect::<Result<Vec<_>, _>>()?.concat();
    let names = chain.joints.iter().map(|joint| joint.name.clone()).collect();
    Ok(JointLog { names, times_s: numbers(&of["times"])?, positions, velocities: None })
}

fn recording(of: &Value) -> Result<ImuRecording, Box<dyn Error>> {
    let sensor = |key: &str, unit: ReadingUnit| -> Result<Option<Recording>, Box<dyn Error>> {
        let rows = of[key].as_array().ok_or("no readings")?;
        let readings = rows.iter().map(vector).collect::<Result<_, _>>()?;
        Ok(Some(Recording::new(numbers(&of["times"])?, readings, Axis::ALL.len(), unit)?))
    };
    Ok(ImuRecording {
        sensors: [
            sensor("accelerometer", ReadingUnit::MetrePerSecondSquared)?,
            sensor("gyroscope", ReadingUnit::RadianPerSecond)?,
        ]
        .into(),
        ..ImuRecording::default()
    })
}

fn number(of: &Value) -> Result<f64, Box<dyn Error>> {
    of.as_f64().ok_or_else(|| format!("{of} is not a number").into())
}

fn numbers(of: &Value) -> Result<Vec<f64>, Box<dyn Error>> {
    of.as_array().ok_or_else(|| format!("{of} is not a list"))?.iter().map(number).collect()
}

fn vector(of: &Value) -> Result<Vector3<f64>, Box<dyn Error>> {
    Ok(Vector3::from_row_slice(&numbers(of)?))
}
