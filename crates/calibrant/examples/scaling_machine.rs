//! Measures time and memory of a calibration on a six-joint arm against the length of the recording:
//! `cargo run --release -p calibrant --features programs --example scaling_machine`. Every size runs in a process of its own, so that its peak memory is its own.
//!
//! The joints are logged at 500 Hz. The time is that of the whole `calibrate_on_machine()` call, the search for the knots included, on all threads:
//! the median of five, or of one for the long ones. Memory is the peak of the resident set (`VmHWM`, Linux) less the resident set before.

use calibrant::io::{Urdf, machine_preset};
use calibrant::machine::chain::KinematicChain;
use calibrant::machine::estimate::{
    MachineProblem, MachineSettings, MachineSetup, MachineTrust, calibrate_on_machine,
};
use calibrant::machine::simulate::{
    LogErrors, MotionToDraw, SensorErrors, SensorSampling, draw_joint_motion, draw_machine, record_log,
    record_sensors,
};
use calibrant::sensor::{ImuParameters, ImuQuantity, SensorKind};
use calibrant::simulate::{Purpose, stream};
use nalgebra::Vector3;
use std::process::Command;
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

/// Length of the recording, s, and rate of the IMU, Hz.
const SIZES: [(u32, u32); 5] = [(20, 200), (20, 500), (60, 200), (600, 200), (3600, 200)];
/// Recordings up to this length are calibrated five times, s.
const SHORT_S: u32 = 60;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [trust, length_s, rate_hz] = arguments.as_slice() {
        return measure(trust, length_s.parse()?, rate_hz.parse()?);
    }
    println!(
        "| trust | length, s | IMU, Hz | parameters | knots | time, s | time/length, ms/s | peak growth, MB |"
    );
    println!("|---|--:|--:|--:|--:|--:|--:|--:|");
    for trust in ["known", "noisy"] {
        for (length_s, rate_hz) in SIZES {
            let numbers = [length_s.to_string(), rate_hz.to_string()];
            let status = Command::new(std::env::current_exe()?).arg(trust).args(&numbers).status()?;
            if !status.success() {
                return Err(format!("{trust} {numbers:?}: {status}").into());
            }
        }
    }
    Ok(())
}

fn arm() -> Result<KinematicChain, Failure> {
    Ok(Urdf::parse(machine_preset("arm").ok_or("no preset")?.as_bytes())?.chain(None, None)?)
}

/// One size: simulates, calibrates, prints a row of the table.
fn measure(trust: &str, length_s: u32, rate_hz: u32) -> Result<(), Failure> {
    let chain = arm()?;
    let setup = MachineSetup {
        trust: if trust == "known" { MachineTrust::Known } else { MachineTrust::Noisy },
        ..MachineSetup::default()
    };
    let wanted = MotionToDraw {
        duration_s: f64::from(length_s) + 2.0,
        rest_s: 1.0,
        acceleration: 5.0,
        knot_step_s: None,
    };
    let motion = draw_joint_motion(&chain, &wanted, &mut stream(1, Purpose::Motion, 0));
    let rng = &mut stream(1, Purpose::Sensor, 0);
    let joints = chain.joints.len();
    let truth = draw_machine(&setup, ImuParameters::identity(), &SensorKind::ALL, joints, rng).parameters;
    let sampling =
        SensorSampling { start_s: 1.0, samples: (length_s * rate_hz) as usize, rate_hz: f64::from(rate_hz) };
    let sensors =
        [(SensorKind::Accelerometer, 5.5e-3), (SensorKind::Gyroscope, 9e-4)].map(|(sensor, noise)| {
            SensorErrors {
                sensor,
                unit: sensor.stimulus_unit(),
                noise: Vector3::repeat(noise),
                vibration: 0.0,
            }
        });
    let recording = record_sensors(&motion, &truth, &setup, &sampling, &sensors, rng).expect("a rate");
    let errors = LogErrors { rate_hz: 500.0, noise: vec![2e-5; joints], resolution: 0.0 };
    let log = record_log(&motion, &errors, rng);
    drop(motion);
    let quantities = ImuQuantity::full_list(true, true, false);
    let problem = MachineProblem {
        recording: &recording,
        log: &log,
        chain: Some(&chain),
        setup: &setup,
        nominal: &ImuParameters::identity(),
        quantities: &quantities,
    };
    let before = memory_kb("VmRSS:")?;
    let start = Instant::now();
    let calibration = calibrate_on_machine(&problem, &MachineSettings::default())?;
    let mut seconds = vec![start.elapsed().as_secs_f64()];
    let growth = memory_kb("VmHWM:")?.saturating_sub(before);
    while length_s <= SHORT_S && seconds.len() < 5 {
        let start = Instant::now();
        calibrate_on_machine(&problem, &MachineSettings::default())?;
        seconds.push(start.elapsed().as_secs_f64());
    }
    seconds.sort_unstable_by(f64::total_cmp);
    let median = seconds[seconds.len() / 2];
    println!(
        "| {trust} | {length_s} | {rate_hz} | {} | {} | {median:.2} | {:.1} | {:.0} |",
        calibration.quantities.len(),
        calibration.motion.knots().controls(),
        1e3 * median / f64::from(length_s),
        growth as f64 / 1024.0,
    );
    Ok(())
}

/// A line of `/proc/self/status`, in kB.
fn memory_kb(key: &str) -> Result<usize, Failure> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find(|line| line.starts_with(key)).ok_or("the system does not tell")?;
    Ok(line.split_whitespace().nth(1).ok_or("no number")?.parse()?)
}
