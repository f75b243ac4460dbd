//! The estimator of a sensor on a machine, against other estimators, simulated truth and real recordings.

use crate::common::shared_data;
use calibrant::estimate::{CalibrationProblem, CalibrationSettings, CalibrationStatus, Stimulus, calibrate};
use calibrant::io::{
    ImuReadOptions, ReferenceLogOptions, Urdf, machine_preset, read_imu_recording, read_reference_log,
};
use calibrant::machine::chain::KinematicChain;
use calibrant::machine::estimate::{
    MachineCalibration, MachineProblem, MachineQuantity, MachineSettings, MachineSetup, MachineTrust,
    MountingPrior, calibrate_on_machine,
};
use calibrant::machine::log::{JointLog, ReferenceLog};
use calibrant::motion::{CommandedMotion, JerkControlledMotion, KnownEnds, MotionClock, Trust};
use calibrant::sensor::{
    Axis, ImuParameters, ImuQuantity, ImuRecording, ParameterList, ReadingUnit, Recording, Sensor,
    SensorKind, SensorModel,
};
use calibrant::simulate::{Purpose, stream};
use nalgebra::{Matrix3, Vector3};
use rand_distr::{Distribution, StandardNormal};

fn preset(name: &str) -> KinematicChain {
    let text = machine_preset(name).expect("known");
    Urdf::parse(text.as_bytes()).and_then(|machine| machine.chain(None, None)).expect("a chain")
}

fn quantities(sensors: &[SensorKind]) -> Vec<ImuQuantity> {
    let list = ParameterList::new(3, SensorModel::Full);
    sensors
        .iter()
        .flat_map(|kind| list.quantities().iter().map(move |of| ImuQuantity::Of(*kind, *of)))
        .collect()
}

/// A machine of which everything is known.
fn exact(setup: MachineSetup) -> MachineSetup {
    MachineSetup {
        tilt_sd_rad: 0.0,
        lever_sd_m: 0.0,
        mounting: MountingPrior::Exact,
        delay_sd_s: 0.0,
        delay_difference_sd_s: 0.0,
        clock_rate_sd: 0.0,
        geometry_translation_sd_m: 0.0,
        geometry_rotation_sd_rad: 0.0,
        zero_sd: 0.0,
        ..setup
    }
}

/// A gantry moves an accelerometer along its axes, as in the report.
struct Gantry {
    motion: JerkControlledMotion,
    log: ReferenceLog,
    recording: Recording,
    noise: f64,
}

impl Gantry {
    const INTERVAL_S: f64 = 0.5;
    const INTERVALS: usize = 20;

    fn new() -> Self {
        let mut rng = stream(20, Purpose::Motion, 0);
        let mut number = || -> f64 { StandardNormal.sample(&mut rng) };
        let nodes: Vec<Vector3<f64>> =
            (0..=Self::INTERVALS).map(|_| Vector3::from_fn(|_, _| 3.0 * number())).collect();
        let motion = JerkControlledMotion::uniform(Self::INTERVAL_S, nodes.clone()).expect("a motion");
        let position = |t: f64| -> Vector3<f64> {
            let (mut p, mut v) = (Vector3::zeros(), Vector3::zeros());
            let last = ((t / Self::INTERVAL_S) as usize).min(Self::INTERVALS - 1);
            for i in 0..=last {
                let u = if i < last { Self::INTERVAL_S } else { t - last as f64 * Self::INTERVAL_S };
                let jerk = (nodes[i + 1] - nodes[i]) / Self::INTERVAL_S;
                p += v * u + nodes[i] * (u * u / 2.0) + jerk * (u * u * u / 6.0);
                v += nodes[i] * u + jerk * (u * u / 2.0);
            }
            p
        };
        let end_s = Self::INTERVAL_S * Self::INTERVALS as f64;
        let times_s: Vec<f64> = (0..=1000).map(|k| end_s * f64::from(k) / 1000.0).collect();
        let positions = times_s.iter().flat_map(|t| position(*t).data.0[0]).collect();
        let names = ["x", "y", "z"].map(String::from).to_vec();
        let log = ReferenceLog::Joints(JointLog { names, times_s, positions, velocities: None });
        let truth = Matrix3::new(1.01, 0.002, -0.003, 0.001, 0.99, 0.004, -0.002, 0.003, 1.005);
        let noise = 1e-3;
        let times_s: Vec<f64> = (0..400).map(|k| 0.01 + end_s * f64::from(k) / 401.0).collect();
        let reading = |t: &f64| {
            let i = ((t / Self::INTERVAL_S) as usize).min(Self::INTERVALS - 1);
            let u = t / Self::INTERVAL_S - i as f64;
            let force = nodes[i] * (1.0 - u) + nodes[i + 1] * u;
            let error: Vector3<f64> = Vector3::from_fn(|_, _| number().clamp(-2.0, 2.0));
            truth * force + Vector3::new(0.1, -0.2, 0.05) + error * noise
        };
        let readings = times_s.iter().map(reading).collect();
        let unit = ReadingUnit::MetrePerSecondSquared;
        let recording = Recording::new(times_s, readings, 3, unit).expect("samples in order");
        Self { motion, log, recording, noise }
    }

    fn on_machine(&self, trust: MachineTrust, reference_noise: Option<Vec<f64>>) -> MachineCalibration {
        let setup = exact(MachineSetup {
            trust,
            gravity_mps2: 0.0,
            knot_step_s: Some(Self::INTERVAL_S),
            accelerometer_noise: Some(Vector3::repeat(self.noise)),
            reference_noise,
            ..MachineSetup::default()
        });
        let problem = MachineProblem {
            recording: &ImuRecording::from(self.recording.clone()),
            log: &self.log,
            chain: Some(&preset("gantry")),
            setup: &setup,
            nominal: &ImuParameters::identity(),
            quantities: &quantities(&[SensorKind::Accelerometer]),
        };
        let settings = MachineSettings { tolerance: 1e-10, ..MachineSettings::default() };
        calibrate_on_machine(&problem, &settings).expect("it is determined")
    }
}

#[test]
fn a_gantry_that_is_trusted_gives_the_estimate_of_the_report() {
    let gantry = Gantry::new();
    let sensor =
        Sensor { noise_mps2: Some(Vector3::repeat(gantry.noise)), ..Sensor::triaxial(SensorModel::Full) };
    let command = CommandedMotion {
        motion: gantry.motion.clone(),
        trust: Trust::Known,
        known_ends: KnownEnds::Start,
        gravity: None,
        clock: MotionClock::default(),
    };
    let problem = CalibrationProblem {
        sensor: &sensor,
        recording: &gantry.recording,
        stimulus: Stimulus::Motion(&command),
    };
    let expected = calibrate(&problem, &CalibrationSettings::default()).expect("it is determined");
    let found = gantry.on_machine(MachineTrust::Known, None);
    assert_eq!(found.values.len(), 12);
    for k in 0..12 {
        assert_eq!(found.quantities[k], MachineQuantity::Imu(expected.quantities[k]));
        assert!(
            (found.values[k] - expected.values[k]).abs() < 1e-9,
            "{k}: {} {}",
            found.values[k],
            expected.values[k]
        );
        for j in 0..12 {
            let own = found.covariance[(k, j)] / (found.inflation[k] * found.inflation[j]);
            let size = (expected.covariance[(k, k)] * expected.covariance[(j, j)]).sqrt();
            assert!((own - expected.covariance[(k, j)]).abs() < 1e-9 * size);
        }
    }
    assert!((found.sensors.fit.chi2 - expected.fit.chi2).abs() < 1e-6 * expected.fit.chi2);
}

#[test]
fn a_log_without_noise_is_as_good_as_a_trusted_one() {
    let gantry = Gantry::new();
    let known = gantry.on_machine(MachineTrust::Known, None);
    let noisy = gantry.on_machine(MachineTrust::Noisy, Some(vec![1e-8; 3]));
    for ((one, other), sd) in known.values.iter().zip(&noisy.values).zip(known.sd()) {
        assert!((one - other).abs() < 1e-4 * sd, "{one} {other} {sd}");
    }
}

#[test]
fn a_motion_that_determines_too_little_is_named_with_a_remedy() {
    let mut gantry = Gantry::new();
    if let ReferenceLog::Joints(log) = &mut gantry.log {
        log.positions.iter_mut().skip(2).step_by(3).for_each(|z| *z = 0.0);
    }
    let setup = exact(MachineSetup {
        trust: MachineTrust::Known,
        gravity_mps2: 0.0,
        knot_step_s: Some(Gantry::INTERVAL_S),
        ..MachineSetup::default()
    });
    let problem = MachineProblem {
        recording: &ImuRecording::from(gantry.recording.clone()),
        log: &gantry.log,
        chain: Some(&preset("gantry")),
        setup: &setup,
        nominal: &ImuParameters::identity(),
        quantities: &quantities(&[SensorKind::Accelerometer]),
    };
    let error = calibrate_on_machine(&problem, &MachineSettings::default()).expect_err("z does not move");
    assert!(error.is_not_identifiable());
    let words = error.to_string();
    assert!(words.contains("accelerometer.scale.z") && words.contains("along z"), "{words}");
}

/// Delay, lever arm and bias of a trial of BROAD. The bias is also that of the gyroscope at rest before and after the motion.
struct Published {
    trial: &'static str,
    delays_ms: [f64; 2],
    lever_mm: [f64; 3],
    bias_at_rest: [f64; 3],
}

fn broad(of: &Published, knot_step_s: Option<f64>) {
    let data = |name: &str| shared_data(&format!("broad-mocap/{}/{name}", of.trial));
    let (Some(imu), Some(poses)) = (data("imu.csv"), data("ref_120hz_recovered.csv")) else { return };
    let file = read_imu_recording(&imu, &ImuReadOptions::default()).expect("a recording");
    let log = read_reference_log(&poses, &ReferenceLogOptions::default());
    let setup = MachineSetup {
        lever_sd_m: 0.1,
        mounting: MountingPrior::Exact,
        gravity_mps2: 9.8127,
        tilt_sd_rad: 0.05,
        clock_rate_sd: 1e-3,
        knot_step_s,
        ..MachineSetup::default()
    };
    let problem = MachineProblem {
        recording: &file.recording,
        log: &log.expect("a log").log,
        chain: None,
        setup: &setup,
        nominal: &ImuParameters::identity(),
        quantities: &quantities(&SensorKind::ALL),
    };
    let found = calibrate_on_machine(&problem, &MachineSettings::default()).expect("it is determined");
    assert_eq!(found.sensors.status, CalibrationStatus::Converged);
    let near = |quantity: MachineQuantity, expected: f64, sd: f64, deviations: f64| {
        let (value, own) = found.estimate(quantity).expect("it was estimated");
        let off = (value - expected) / own.hypot(sd);
        assert!(off.abs() < deviations, "{}: {value} ± {own}, {expected}: {off:.1} sd", quantity.name(&[]));
    };
    for (sensor, delay_ms) in SensorKind::ALL.into_iter().zip(of.delays_ms) {
        near(MachineQuantity::Delay(sensor), 1e-3 * delay_ms, 4e-5, 3.0);
    }
    for axis in Axis::ALL {
        near(MachineQuantity::Lever(axis), 1e-3 * of.lever_mm[axis.index()], 1e-4, 3.0);
        let bias = ImuQuantity::Of(SensorKind::Gyroscope, calibrant::sensor::Quantity::Bias(axis));
        near(MachineQuantity::Imu(bias), of.bias_at_rest[axis.index()], 1e-4, 3.0);
        for sensor in SensorKind::ALL {
            let scale = ImuQuantity::Of(sensor, calibrant::sensor::Quantity::Scale(axis));
            near(MachineQuantity::Imu(scale), 1.0, 1e-3, 3.0);
        }
    }
    // a tracker's error is correlated: the intervals are wider, and it is said
    assert!(found.inflation.iter().any(|factor| *factor > 1.2));
    let says_so = ["residuals-correlated", "reference-undermodelled"];
    assert!(found.sensors.warnings.iter().any(|found| says_so.contains(&found.code().name())));
}

#[test]
#[ignore = "long: scripts/test-all runs it"]
fn motion_capture_agrees_with_an_independent_fit() {
    for of in [
        Published {
            trial: "broad_21_undisturbed_fast_combined",
            delays_ms: [-2.83, -4.10],
            lever_mm: [0.46, -1.93, 7.64],
            bias_at_rest: [0.00317, 0.00203, -0.00384],
        },
        Published {
            trial: "broad_03_undisturbed_slow_rotation_C",
            delays_ms: [-2.72, -4.14],
            lever_mm: [-0.73, 1.69, 8.28],
            bias_at_rest: [0.00874, -0.00323, -0.00430],
        },
    ] {
        broad(&of, None);
    }
}
