use calibrant_core::sensor::*;
use calibrant_machine::estimate::*;
use calibrant_machine::log::*;
use nalgebra::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let dir = std::path::Path::new(&args[1]);
    let trust = if args[3] == "known" { MachineTrust::Known } else { MachineTrust::Noisy };
    let read = |name: &str| -> Vec<Vec<f64>> {
        std::fs::read_to_string(dir.join(name))
            .unwrap()
            .lines()
            .skip(1)
            .map(|l| l.split(',').map(|v| v.parse().unwrap_or(f64::NAN)).collect())
            .collect()
    };
    let imu = read("imu.csv");
    let poses = read(&args[2]);
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
    let log = ReferenceLog::Poses(PoseLog {
        times_s: poses.iter().map(|r| r[0]).collect(),
        positions_m: poses.iter().map(|r| fin(&r[5..8]).then(|| Vector3::new(r[5], r[6], r[7]))).collect(),
        world_from_body: poses
            .iter()
            .map(|r| {
                fin(&r[1..5])
                    .then(|| UnitQuaternion::from_quaternion(Quaternion::new(r[1], r[2], r[3], r[4])))
            })
            .collect(),
    });
    let step = std::env::var("STEP").ok().map(|s| s.parse().unwrap());
    let setup = MachineSetup {
        trust,
        lever_sd_m: 0.1,
        mounting: MountingPrior::Exact,
        gravity_mps2: 9.8127,
        gravity_sd_mps2: 0.0,
        knot_step_s: step,
        tilt_sd_rad: 0.05,
        clock_rate_sd: 1e-3,
        ..Default::default()
    };
    let quantities: Vec<ImuQuantity> = SensorKind::ALL
        .iter()
        .flat_map(|kind| {
            ParameterList::new(3, SensorModel::Full)
                .quantities()
                .iter()
                .map(|q| ImuQuantity::Of(*kind, *q))
                .collect::<Vec<_>>()
        })
        .collect();
    let nominal = ImuParameters::identity();
    let problem = MachineProblem {
        recording: &recording,
        log: &log,
        chain: None,
        setup: &setup,
        nominal: &nominal,
        quantities: &quantities,
    };
    let clock = std::time::Instant::now();
    let c = calibrate_on_machine(&problem, &MachineSettings::default()).unwrap();
    println!(
        "{:?} {:?} it {} step {:.1e} knots {:?} used {}",
        clock.elapsed(),
        c.status,
        c.iterations,
        c.gradient_norm,
        c.motion.knots(),
        c.used_share
    );
    for n in &c.noise {
        println!(
            "{} noise {:?} white {:?} growth {:?} rms {:?}",
            n.sensor,
            n.noise.as_slice(),
            n.white_noise.as_slice(),
            n.growth,
            n.rms.as_slice()
        );
    }
    for n in &c.reference_noise {
        println!("{} {:.3e} growth {:?} out {}", n.name, n.sd, n.growth, n.outliers);
    }
    let sd = c.sd();
    for (k, name) in c.names().iter().enumerate() {
        println!("{name:28} {:10.6} sd {:.6} x{:.2}", c.values[k], sd[k], c.inflation[k]);
    }
    println!("{:?}", Source::ALL.map(|s| s.name()));
    for row in &c.budget {
        println!(
            "{:28} {:.2e} {:?}",
            row.quantity.name(),
            row.variance.sqrt(),
            row.parts.map(|p| (p / row.variance * 100.0).round())
        );
    }
}
