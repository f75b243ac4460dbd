//! A sensor on something soft, and one on a drone: gains that no fold doubts. The motion is integrated here, by nothing of the estimator.

use super::hard_log_tests::codes;
use super::{
    MachineCalibration, MachineProblem, MachineQuantity, MachineSettings, MachineSetup, MountingPrior,
    calibrate_on_machine,
};
use crate::log::{PoseLog, ReferenceLog};
use calibrant_core::sensor::{
    ImuParameters, ImuQuantity, ImuRecording, ParameterList, ReadingUnit, Recording, SensorKind, SensorModel,
};
use calibrant_core::simulate::{Purpose, stream};
use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;

/// Fine step, s, and fine steps of a sample of sensor and log.
const STEP_S: f64 = 5e-4;
const EVERY: usize = 20;
const SAMPLES: usize = 2400;

/// A tracked body in a hand, with a sensor 3 cm off. `tilt`: the largest angles of roll and pitch. `soft_hz`: the sensor is on a damped spring of this frequency, in
/// displacement and turn. `correlated`: errors of the tracker that last half a second.
fn calibrated(tilt: f64, soft_hz: Option<f64>, correlated: bool) -> MachineCalibration {
    let gravity = Vector3::new(0.0, 0.0, 9.806_65);
    let lever = Vector3::new(0.02, 0.01, 0.03);
    // a drone that hardly tilts hardly rises and falls
    let height = if tilt < 0.5 { 0.2 } else { 1.0 };
    let wave = |t: f64, f: f64, phase: f64| (TAU * f * t + phase).sin();
    let body = |t: f64| {
        let roll = tilt * (0.6 * wave(t, 0.23, 0.3) + 0.4 * wave(t, 0.71, 2.0));
        let pitch = tilt * (0.6 * wave(t, 0.31, 1.1) + 0.4 * wave(t, 0.57, 0.4));
        let yaw = 2.0 * wave(t, 0.11, 0.0) + 0.5 * wave(t, 0.83, 1.0);
        let position = Vector3::new(
            0.2 * wave(t, 0.4, 0.5) + 0.04 * wave(t, 1.1, 0.0),
            0.2 * wave(t, 0.47, 1.5) + 0.04 * wave(t, 1.23, 2.0),
            height * (0.15 * wave(t, 0.37, 2.5) + 0.03 * wave(t, 1.37, 1.0)),
        );
        (Rotation3::from_euler_angles(roll, pitch, yaw), position)
    };
    let number = SAMPLES * EVERY + 3;
    let bodies: Vec<_> = (0..number).map(|k| body(k as f64 * STEP_S)).collect();
    let second = |of: &dyn Fn(usize) -> Vector3<f64>, k: usize| {
        (of(k + 1) - of(k) * 2.0 + of(k - 1)) / (STEP_S * STEP_S)
    };
    let rate = |of: &dyn Fn(usize) -> Rotation3<f64>, k: usize| {
        (of(k - 1).inverse() * of(k + 1)).scaled_axis() / (2.0 * STEP_S)
    };
    let mounted = |k: usize| bodies[k].1 + bodies[k].0 * lever;
    let force = |k: usize| bodies[k].0.inverse() * (second(&mounted, k) + gravity);
    let of_body = |k: usize| bodies[k].0;
    let mut displaced = vec![(Vector3::zeros(), Vector3::zeros()); number];
    if let Some(hz) = soft_hz {
        let (stiffness, damping) = ((TAU * hz).powi(2), 0.3 * TAU * hz);
        let mut d = -force(1) / stiffness;
        let (mut d_rate, mut turn, mut turn_rate) = (Vector3::zeros(), Vector3::zeros(), Vector3::zeros());
        for (k, of_sample) in displaced.iter_mut().enumerate().take(number - 2).skip(2) {
            d_rate += STEP_S * (-force(k) - stiffness * d - damping * d_rate);
            d += STEP_S * d_rate;
            let acceleration = (rate(&of_body, k + 1) - rate(&of_body, k - 1)) / (2.0 * STEP_S);
            turn_rate += STEP_S * (-acceleration - stiffness * turn - damping * turn_rate);
            turn += STEP_S * turn_rate;
            *of_sample = (d, turn);
        }
    }
    let place = |k: usize| bodies[k].1 + bodies[k].0 * (lever + displaced[k].0);
    let turned = |k: usize| bodies[k].0 * Rotation3::new(displaced[k].1);
    let mut rng = stream(5, Purpose::Sensor, 0);
    let mut noise =
        |sd: f64| Vector3::from_fn(|_, _| sd * Distribution::<f64>::sample(&StandardNormal, &mut rng));
    let (mut times_s, mut forces, mut rates) = (Vec::new(), Vec::new(), Vec::new());
    let (mut positions_m, mut world_from_body) = (Vec::new(), Vec::new());
    let size = if correlated { 1.0 } else { 0.0 };
    let (mut of_place, mut of_turn) = (Vector3::zeros(), Vector3::zeros());
    let kept = (-(EVERY as f64) * STEP_S / 0.5).exp();
    for k in (400..number - 20).step_by(EVERY) {
        let fresh = size * (1.0 - kept * kept).sqrt();
        of_place = of_place * kept + noise(3e-4 * fresh);
        of_turn = of_turn * kept + noise(1e-3 * fresh);
        times_s.push(k as f64 * STEP_S);
        forces.push(turned(k).inverse() * (second(&place, k) + gravity) + noise(0.02));
        rates.push(rate(&turned, k) + noise(2e-3));
        positions_m.push(Some(bodies[k].1 + of_place + noise(2e-4)));
        world_from_body.push(Some(
            UnitQuaternion::from_rotation_matrix(&bodies[k].0) * UnitQuaternion::new(of_turn + noise(5e-4)),
        ));
    }
    let recording = |readings, unit| Recording::new(times_s.clone(), readings, 3, unit).expect("in order");
    let recording = ImuRecording {
        sensors: [
            Some(recording(forces, ReadingUnit::MetrePerSecondSquared)),
            Some(recording(rates, ReadingUnit::RadianPerSecond)),
        ]
        .into(),
        temperature_c: None,
    };
    let list = ParameterList::new(3, SensorModel::Full);
    let of = |kind: SensorKind| list.quantities().iter().map(move |of| ImuQuantity::Of(kind, *of));
    let problem = MachineProblem {
        recording: &recording,
        log: &ReferenceLog::Poses(PoseLog { times_s: times_s.clone(), positions_m, world_from_body }),
        chain: None,
        setup: &MachineSetup { lever_sd_m: 0.1, mounting: MountingPrior::Unknown, ..MachineSetup::default() },
        nominal: &ImuParameters::identity(),
        quantities: &SensorKind::ALL.into_iter().flat_map(of).collect::<Vec<_>>(),
    };
    calibrate_on_machine(&problem, &MachineSettings::default()).expect("determined")
}

/// Through all orientations.
const ALL_OVER: f64 = 1.6;

#[test]
fn a_soft_mount_is_named_and_a_stiff_one_is_not() {
    let stiff = codes(&calibrated(ALL_OVER, None, false));
    assert!(!stiff.contains(&"mount-gives-way"), "{stiff:?}");
    assert!(!stiff.contains(&"gain-not-separable"), "{stiff:?}");
    for soft_hz in [4.0, 8.0] {
        let soft = codes(&calibrated(ALL_OVER, Some(soft_hz), false));
        assert!(soft.contains(&"mount-gives-way"), "{soft_hz} Hz: {soft:?}");
    }
}

#[test]
fn bias_and_gain_of_an_axis_that_hardly_tilts_are_one_number() {
    let drone = calibrated(15_f64.to_radians(), None, false);
    let said = drone.sensors.warnings.iter().find(|found| found.code().name() == "gain-not-separable");
    let said = said.expect("said").message();
    assert!(said.contains("axis z are not separable"), "{said}");
}

/// The truth is the nominal sensor.
#[test]
fn correlated_errors_of_a_tracker_leave_room_for_a_mount_and_the_room_is_stated() {
    let found = calibrated(ALL_OVER, None, true);
    assert!(codes(&found).contains(&"mount-allowed-for"), "{:?}", codes(&found));
    assert!(
        !found.sensors.warnings.iter().any(calibrant_core::diagnostic::Diagnostic::is_warning),
        "{:?}",
        codes(&found)
    );
    let sd = found.sd();
    for (k, quantity) in found.quantities.iter().enumerate() {
        let MachineQuantity::Imu(of) = quantity else { continue };
        assert!(found.unseen[(k, k)] > 0.0);
        let off = (found.values[k] - of.value(&ImuParameters::identity())) / sd[k];
        assert!(off.abs() < 4.0, "{}: {off} sd", quantity.name(&[]));
    }
    assert!(codes(&calibrated(ALL_OVER, Some(8.0), true)).contains(&"mount-gives-way"));
}
