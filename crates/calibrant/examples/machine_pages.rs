//! Writes reports of calibrations on machines for a reader to look at: a hand that cameras tracked (BROAD), and an arm in MuJoCo.
//!
//! `cargo run -p calibrant --features programs --example machine_pages -- DIRECTORY MUJOCO_RECORDING`, with the data in `$CALIBRANT_DATA`.

use calibrant_core::sensor::{
    ImuParameters, ImuQuantity, ImuRecording, ParameterList, ReadingUnit, Recording, SensorKind, SensorModel,
};
use calibrant_io::Urdf;
use calibrant_machine::estimate::{
    MachineProblem, MachineSettings, MachineSetup, MountingPrior, calibrate_on_machine,
};
use calibrant_machine::log::{JointLog, PoseLog, ReferenceLog};
use calibrant_report::{About, machine_sheet};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use std::path::{Path, PathBuf};

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let mut arguments = std::env::args().skip(1).map(PathBuf::from);
    let (Some(directory), Some(mujoco)) = (arguments.next(), arguments.next()) else {
        return Err("usage: machine_pages DIRECTORY MUJOCO_RECORDING".into());
    };
    let data = PathBuf::from(std::env::var("CALIBRANT_DATA")?);
    std::fs::create_dir_all(&directory)?;
    let trial = data.join("broad-mocap/broad_21_undisturbed_fast_combined");
    std::fs::write(directory.join("broad.html"), tracked(&trial)?)?;
    std::fs::write(directory.join("mujoco.html"), arm(&mujoco, &data.join("arms/ur5e.urdf"))?)?;
    Ok(())
}

fn numbers(path: &Path) -> Result<Vec<Vec<f64>>, Failure> {
    let text = std::fs::read_to_string(path)?;
    let row = |line: &str| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect();
    Ok(text.lines().skip(1).map(row).collect())
}

fn recording(rows: &[Vec<f64>], accelerometer: usize, gyroscope: usize) -> ImuRecording {
    let of = |first: usize, unit| {
        let times_s = rows.iter().map(|row| row[0]).collect();
        let reading = |row: &Vec<f64>| Vector3::new(row[first], row[first + 1], row[first + 2]);
        Recording::new(times_s, rows.iter().map(reading).collect(), 3, unit).expect("samples in order")
    };
    ImuRecording {
        sensors: [
            Some(of(accelerometer, ReadingUnit::MetrePerSecondSquared)),
            Some(of(gyroscope, ReadingUnit::RadianPerSecond)),
        ]
        .into(),
        temperature_c: None,
    }
}

fn page(title: &str, problem: &MachineProblem<'_>) -> Result<String, Failure> {
    let calibration = calibrate_on_machine(problem, &MachineSettings::default())?;
    let about = About {
        title: title.into(),
        facts: vec![(
            "Samples".into(),
            problem.recording[SensorKind::Accelerometer].as_ref().map_or(0, Recording::len).to_string(),
        )],
        ..About::default()
    };
    Ok(machine_sheet(&calibration, problem.setup, &[], problem.recording, &about).html())
}

fn quantities() -> Vec<ImuQuantity> {
    let parameters = ParameterList::new(3, SensorModel::Full);
    SensorKind::ALL
        .iter()
        .flat_map(|kind| {
            parameters.quantities().iter().map(|of| ImuQuantity::Of(*kind, *of)).collect::<Vec<_>>()
        })
        .collect()
}

fn tracked(folder: &Path) -> Result<String, Failure> {
    let recording = recording(&numbers(&folder.join("imu.csv"))?, 4, 1);
    let poses = numbers(&folder.join("ref_120hz_recovered.csv"))?;
    let seen = |values: &[f64]| values.iter().all(|x| x.is_finite());
    let position = |row: &Vec<f64>| seen(&row[5..8]).then(|| Vector3::new(row[5], row[6], row[7]));
    let orientation = |row: &Vec<f64>| {
        let of = Quaternion::new(row[1], row[2], row[3], row[4]);
        seen(&row[1..5]).then(|| UnitQuaternion::from_quaternion(of))
    };
    let log = ReferenceLog::Poses(PoseLog {
        times_s: poses.iter().map(|row| row[0]).collect(),
        positions_m: poses.iter().map(position).collect(),
        world_from_body: poses.iter().map(orientation).collect(),
    });
    let setup = MachineSetup {
        lever_sd_m: 0.1,
        mounting: MountingPrior::Exact,
        gravity_mps2: 9.8127,
        tilt_sd_rad: 0.05,
        clock_rate_sd: 1e-3,
        ..MachineSetup::default()
    };
    let (nominal, quantities) = (ImuParameters::identity(), quantities());
    page(
        "A hand that cameras tracked",
        &MachineProblem {
            recording: &recording,
            log: &log,
            chain: None,
            setup: &setup,
            nominal: &nominal,
            quantities: &quantities,
        },
    )
}

fn arm(folder: &Path, urdf: &Path) -> Result<String, Failure> {
    let recording = recording(&numbers(&folder.join("recording.csv"))?, 1, 4);
    let joints = numbers(&folder.join("joints.csv"))?;
    let chain = Urdf::read(urdf)?.chain(None, Some("tool0"))?;
    let log = ReferenceLog::Joints(JointLog {
        times_s: joints.iter().map(|row| row[0]).collect(),
        names: chain.joints.iter().map(|joint| joint.name.clone()).collect(),
        positions: joints.iter().flat_map(|row| row[1..].iter().copied()).collect(),
        velocities: None,
    });
    let setup = MachineSetup {
        lever_m: Vector3::new(0.020, -0.030, 0.040),
        delay_sd_s: 0.01,
        delay_difference_sd_s: 1e-3,
        clock_rate_sd: 5e-5,
        knot_step_s: Some(0.2),
        ..MachineSetup::default()
    };
    let (nominal, quantities) = (ImuParameters::identity(), quantities());
    page(
        "An arm in MuJoCo",
        &MachineProblem {
            recording: &recording,
            log: &log,
            chain: Some(&chain),
            setup: &setup,
            nominal: &nominal,
            quantities: &quantities,
        },
    )
}
