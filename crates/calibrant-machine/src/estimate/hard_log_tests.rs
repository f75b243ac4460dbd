//! Logs as machines and trackers write them, of simulated motions whose truth is known.

use super::{
    MachineCalibration, MachineParameters, MachineProblem, MachineQuantity, MachineSettings, MachineSetup,
    MountingPrior, calibrate_on_machine,
};
use crate::chain::{Joint, JointKind, JointLimits, KinematicChain};
use crate::estimate::fitted;
use crate::log::{PoseLog, ReferenceLog};
use crate::reference::Motion;
use crate::simulate::{
    LogErrors, MotionToDraw, SensorErrors, SensorSampling, draw_body_motion, draw_joint_motion, draw_machine,
    record_log, record_sensors,
};
use crate::spline::{Degree, UniformKnots};
use calibrant_core::error::Result;
use calibrant_core::estimate::CalibrationStatus;
use calibrant_core::sensor::{
    ImuParameters, ImuQuantity, ImuRecording, ParameterList, PerSensor, ReadingUnit, Recording, SensorKind,
    SensorModel,
};
use calibrant_core::simulate::{Purpose, stream};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use std::f64::consts::TAU;

/// An IMU on something that moves, and the log of that.
pub(super) struct Simulated {
    pub(super) setup: MachineSetup,
    pub(super) model: SensorModel,
    chain: Option<KinematicChain>,
    truth: MachineParameters,
    pub(super) recording: ImuRecording,
    log: ReferenceLog,
}

impl Simulated {
    /// In a hand, or on a chain, for a third of a minute.
    pub(super) fn new(chain: Option<KinematicChain>, setup: MachineSetup, errors: &LogErrors) -> Self {
        let mut rng = stream(3, Purpose::Motion, 0);
        let wanted = MotionToDraw { duration_s: 20.0, rest_s: 1.0, acceleration: 5.0, knot_step_s: None };
        let motion = match &chain {
            Some(chain) => draw_joint_motion(chain, &wanted, &mut rng),
            None => draw_body_motion(&wanted, &mut rng),
        };
        Self::moved(&motion, chain, setup, errors, None)
    }

    /// In this motion, with a delay that is drawn or given.
    fn moved(
        motion: &Motion,
        chain: Option<KinematicChain>,
        setup: MachineSetup,
        errors: &LogErrors,
        delay_s: Option<f64>,
    ) -> Self {
        let mut rng = stream(4, Purpose::Motion, 0);
        let joints = chain.as_ref().map_or(0, |chain| chain.joints.len());
        let imu = ImuParameters::identity();
        let mut truth = draw_machine(&setup, imu, &SensorKind::ALL, joints, &mut rng).parameters;
        truth.delays_s = delay_s.map_or(truth.delays_s, |delay_s| [delay_s; 2].into());
        let sampling = SensorSampling { start_s: 0.2, samples: 1960, rate_hz: 100.0 };
        let sensors = [
            (SensorKind::Accelerometer, ReadingUnit::MetrePerSecondSquared, 0.02),
            (SensorKind::Gyroscope, ReadingUnit::RadianPerSecond, 2e-3),
        ];
        let sensors = sensors.map(|(sensor, unit, noise)| SensorErrors {
            sensor,
            unit,
            noise: Vector3::repeat(noise),
            vibration: 0.0,
        });
        let recording =
            record_sensors(motion, &truth, &setup, &sampling, &sensors, &mut rng).expect("recorded");
        let log = record_log(motion, errors, &mut rng);
        assert_eq!(matches!(motion, Motion::Joints(_)), chain.is_some());
        Self { setup, model: SensorModel::Full, chain, truth, recording, log }
    }

    /// All times since 1970.
    fn since_1970(mut self) -> Self {
        let later = |times: &[f64]| times.iter().map(|time_s| time_s + 1.7e9).collect::<Vec<_>>();
        let moved = |of: &Recording| {
            let (times_s, readings) = (later(of.times_s()), of.readings().to_vec());
            Recording::new(times_s, readings, 3, of.unit()).expect("in order")
        };
        self.recording = ImuRecording {
            sensors: PerSensor::from_fn(|kind| self.recording.sensor(kind).map(moved)),
            temperature_c: None,
        };
        match &mut self.log {
            ReferenceLog::Joints(log) => log.times_s = later(&log.times_s),
            ReferenceLog::Poses(log) => log.times_s = later(&log.times_s),
        }
        self
    }

    fn in_a_hand() -> Self {
        let setup =
            MachineSetup { lever_sd_m: 0.05, mounting: MountingPrior::Unknown, ..MachineSetup::default() };
        let noise = [[3e-4; 3], [5e-4; 3]].concat();
        Self::new(None, setup, &LogErrors { rate_hz: 30.0, noise, resolution: 0.0 })
    }

    pub(super) fn calibrated(&self) -> Result<MachineCalibration> {
        let list = ParameterList::new(3, self.model);
        let of = |kind: &SensorKind| {
            let kind = *kind;
            list.quantities().iter().map(move |of| ImuQuantity::Of(kind, *of)).collect::<Vec<_>>()
        };
        let quantities: Vec<ImuQuantity> = SensorKind::ALL.iter().flat_map(of).collect();
        let problem = MachineProblem {
            recording: &self.recording,
            log: &self.log,
            chain: self.chain.as_ref(),
            setup: &self.setup,
            nominal: &ImuParameters::identity(),
            quantities: &quantities,
        };
        calibrate_on_machine(&problem, &MachineSettings::default())
    }

    /// Root mean square of the errors of gains and biases that do not depend on the frame, in standard deviations.
    fn error(&self, calibration: &MachineCalibration) -> f64 {
        let of_sensor = |quantity: &&MachineQuantity| matches!(quantity, MachineQuantity::Imu(of) if of.name().contains("accelerometer"));
        let squares: Vec<f64> = (calibration.quantities.iter().filter(of_sensor))
            .filter_map(|quantity| {
                let (value, sd) = calibration.estimate(*quantity)?;
                Some(((value - self.truth.value(*quantity, &self.truth)) / sd).powi(2))
            })
            .collect();
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
    }

    fn poses(&mut self) -> &mut PoseLog {
        match &mut self.log {
            ReferenceLog::Poses(log) => log,
            ReferenceLog::Joints(_) => panic!("of joints"),
        }
    }
}

/// A body that is shaken evenly at 5 Hz while it turns slowly.
fn shaken() -> Motion {
    let shake = |t: f64, phase: f64| {
        (1.0 + 0.35 * (0.31 * (1.0 + 0.2 * phase) * t + phase).sin()) * (TAU * 5.0 * t + phase).sin()
    };
    let turn = |t: f64| {
        let slow = Vector3::new(1.2 * (0.5 * t).sin(), 1.5 * (0.37 * t + 1.0).sin(), (0.23 * t).sin());
        slow + Vector3::new(0.3 * shake(t, 0.0), 0.2 * shake(t, 1.1), 0.25 * shake(t, 2.3))
    };
    let place = |t: f64| Vector3::new(0.05 * shake(t, 0.3), 0.04 * shake(t, 2.0), 0.03 * shake(t, 4.0));
    let times_s: Vec<f64> = (0..=4000).map(|k| 0.005 * f64::from(k)).collect();
    let log = PoseLog {
        positions_m: times_s.iter().map(|t| Some(place(*t))).collect(),
        world_from_body: times_s.iter().map(|t| Some(UnitQuaternion::from_scaled_axis(turn(*t)))).collect(),
        times_s,
    };
    let knots = UniformKnots::covering(0.0, 20.0, 0.02, Degree::Quintic);
    fitted(&ReferenceLog::Poses(log), None, knots).expect("seen").motion
}

/// A spline whose knots are too far apart to follow the shaking correlates best one period of it later.
#[test]
fn of_delays_that_correlate_alike_the_one_that_fits_is_taken() {
    let setup =
        MachineSetup { lever_sd_m: 0.05, mounting: MountingPrior::Unknown, ..MachineSetup::default() };
    let errors = LogErrors { rate_hz: 120.0, noise: [[3e-4; 3], [5e-4; 3]].concat(), resolution: 0.0 };
    let simulated = Simulated::moved(&shaken(), None, setup, &errors, Some(-0.05));
    let calibration = simulated.calibrated().expect("determined");
    assert_eq!(calibration.sensors.status, CalibrationStatus::Converged);
    let delay = MachineQuantity::Delay(SensorKind::Gyroscope);
    let (delay_s, _) = calibration.estimate(delay).expect("estimated");
    assert!((delay_s + 0.05).abs() < 1e-3, "{delay_s}");
}

#[test]
fn times_since_1970_change_nothing() {
    let errors = LogErrors { rate_hz: 100.0, noise: vec![2e-5; 3], resolution: 0.0 };
    let simulated = || Simulated::new(Some(wrist()), MachineSetup::default(), &errors);
    let [one, two] = [simulated(), simulated().since_1970()].map(|of| of.calibrated().expect("determined"));
    assert_eq!(two.sensors.status, CalibrationStatus::Converged);
    for ((one, two), sd) in one.values.iter().zip(&two.values).zip(one.sd()) {
        // the times themselves are rounded to 0.24 µs
        assert!((one - two).abs() < 0.02 * sd, "{one} {two} {sd}");
    }
}

pub(super) fn codes(calibration: &MachineCalibration) -> Vec<&'static str> {
    calibration.sensors.warnings.iter().map(|found| found.code().name()).collect()
}

#[test]
fn the_sensors_bridge_short_gaps_of_a_slow_log() {
    let mut simulated = Simulated::in_a_hand();
    for (k, orientation) in simulated.poses().world_from_body.iter_mut().enumerate() {
        // a third of a second in each three
        if k % 90 < 11 && k >= 90 {
            *orientation = None;
        }
    }
    let calibration = simulated.calibrated().expect("determined");
    assert_eq!(calibration.sensors.status, CalibrationStatus::Converged);
    assert!(calibration.used_share > 0.99, "{}", calibration.used_share);
    // nine numbers know their mean square to 47 %
    assert!(simulated.error(&calibration) < 1.7, "{}", simulated.error(&calibration));
}

#[test]
fn the_usual_other_conventions_of_poses_are_named() {
    let swapped = |of: &UnitQuaternion<f64>| {
        UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(of.i, of.j, of.k, of.w))
    };
    type Mistake<'a> = (&'a str, &'a dyn Fn(&UnitQuaternion<f64>) -> UnitQuaternion<f64>);
    let mistakes: [Mistake<'_>; 2] = [
        ("x, y, z, w, not w, x, y, z", &swapped),
        ("turn the world into the body", &UnitQuaternion::inverse),
    ];
    for (words, mistake) in mistakes {
        let mut simulated = Simulated::in_a_hand();
        for orientation in simulated.poses().world_from_body.iter_mut().flatten() {
            *orientation = mistake(orientation);
        }
        let said = match simulated.calibrated() {
            Ok(calibration) => {
                let named =
                    calibration.sensors.warnings.iter().find(|of| of.code().name() == "poses-otherwise");
                named.map(|found| found.message().to_owned())
            }
            Err(error) => Some(error.to_string()),
        };
        assert!(said.as_deref().is_some_and(|said| said.contains(words)), "{words}: {said:?}");
    }
}

/// Three joints that turn, one after the other about other axes.
pub(super) fn wrist() -> KinematicChain {
    let axes = [Vector3::z_axis(), Vector3::x_axis(), Vector3::y_axis()];
    let joint = |(k, axis): (usize, &nalgebra::Unit<Vector3<f64>>)| Joint {
        name: format!("wrist_{k}"),
        kind: JointKind::Continuous,
        axis: *axis,
        origin: Isometry3::translation(0.1, 0.0, 0.05),
        limits: JointLimits::default(),
    };
    let joints = axes.iter().enumerate().map(joint).collect();
    let tip_transform = Isometry3::translation(0.05, 0.02, 0.0);
    KinematicChain { base: "base".into(), tip: "tip".into(), joints, tip_transform }
}

#[test]
fn a_joint_that_counts_the_other_way_is_named() {
    let errors = LogErrors { rate_hz: 100.0, noise: vec![2e-5; 3], resolution: 0.0 };
    let mut simulated = Simulated::new(Some(wrist()), MachineSetup::default(), &errors);
    assert!(!codes(&simulated.calibrated().expect("determined")).contains(&"joint-reversed"));
    if let ReferenceLog::Joints(log) = &mut simulated.log {
        log.positions.iter_mut().skip(1).step_by(3).for_each(|angle| *angle = -*angle);
    }
    let said = match simulated.calibrated() {
        Ok(calibration) => {
            calibration.sensors.warnings.iter().map(|found| found.message().to_owned()).collect()
        }
        Err(error) => error.to_string(),
    };
    assert!(said.contains("if the joint wrist_1 turns or slides the other way"), "{said}");
}

#[test]
fn an_encoder_without_noise_has_the_noise_of_its_steps() {
    let step = 1e-3_f64.to_radians();
    let errors = LogErrors { rate_hz: 100.0, noise: vec![0.0; 3], resolution: step };
    let simulated = Simulated::new(Some(wrist()), MachineSetup::default(), &errors);
    let calibration = simulated.calibrated().expect("determined");
    assert_eq!(calibration.sensors.status, CalibrationStatus::Converged);
    for of in &calibration.reference_noise {
        // what the spline cannot follow is in it too
        assert!((0.99..3.0).contains(&(of.sd / (step / 12.0_f64.sqrt()))) && of.outliers == 0, "{of:?}");
    }
    assert!(simulated.error(&calibration) < 1.7, "{}", simulated.error(&calibration));
}
