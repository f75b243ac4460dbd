use calibrant_core::sensor::*;
use calibrant_machine::estimate::*;
use calibrant_machine::log::*;
use calibrant_machine::spline::Degree;
use nalgebra::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let dir = std::path::Path::new(&args[1]);
    let refname = &args[2];
    let step: f64 = args[3].parse().unwrap();
    let degree = if args[4] == "3" { Degree::Cubic } else { Degree::Quintic };
    let trust = if args[5] == "known" { MachineTrust::Known } else { MachineTrust::Noisy };
    let read = |name: &str| -> Vec<Vec<f64>> {
        std::fs::read_to_string(dir.join(name))
            .unwrap()
            .lines()
            .skip(1)
            .map(|l| l.split(',').map(|v| v.parse().unwrap_or(f64::NAN)).collect())
            .collect()
    };
    let imu = read("imu.csv");
    let poses = read(refname);
    let rec = |c: usize, unit| Recording {
        times_s: imu.iter().map(|r| r[0]).collect(),
        readings: imu.iter().map(|r| Vector3::new(r[c], r[c + 1], r[c + 2])).collect(),
        axes: 3,
        unit,
    };
    let recording = ImuRecording {
        accelerometer: Some(rec(4, ReadingUnit::MetrePerSecondSquared)),
        gyroscope: Some(rec(1, ReadingUnit::RadianPerSecond)),
        temperature_c: None,
    };
    let fin = |v: &[f64]| v.iter().all(|x| x.is_finite());
    let poses: Vec<&Vec<f64>> = poses.iter().filter(|r| fin(&r[1..8])).collect();
    let log = PoseLog {
        times_s: poses.iter().map(|r| r[0]).collect(),
        positions_m: poses.iter().map(|r| fin(&r[5..8]).then(|| Vector3::new(r[5], r[6], r[7]))).collect(),
        world_from_body: poses
            .iter()
            .map(|r| {
                fin(&r[1..5])
                    .then(|| UnitQuaternion::from_quaternion(Quaternion::new(r[1], r[2], r[3], r[4])))
            })
            .collect(),
    };
    let setup = MachineSetup {
        trust,
        lever_sd_m: 0.1,
        mounting: MountingPrior::Exact,
        gravity_mps2: 9.81,
        gravity_sd_mps2: 0.0,
        knot_step_s: Some(step),
        tilt_sd_rad: 0.05,
        clock_rate_sd: 1e-3,
        ..Default::default()
    };
    explore(&recording, &ReferenceLog::Poses(log), &setup, degree).unwrap();
}
