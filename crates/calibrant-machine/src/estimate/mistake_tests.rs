//! Mistakes in what is said of a machine that the residuals do not show, and sensors that drift.

use super::hard_log_tests::{Simulated, codes, wrist};
use super::{MachineSetup, MountingPrior};
use crate::chain::{Joint, JointKind, JointLimits, KinematicChain};
use crate::simulate::LogErrors;
use calibrant_core::sensor::{SensorKind, SensorModel};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};

fn encoders(joints: usize) -> LogErrors {
    LogErrors { rate_hz: 100.0, noise: vec![2e-5; joints], resolution: 0.0 }
}

/// A table that turns about the vertical, with a sensor 0.12 m from its middle and askew.
fn on_a_table() -> Simulated {
    let joint = Joint {
        name: "table".into(),
        kind: JointKind::Continuous,
        axis: Vector3::z_axis(),
        origin: Isometry3::identity(),
        limits: JointLimits::default(),
    };
    let chain = KinematicChain {
        base: "base".into(),
        tip: "plate".into(),
        joints: vec![joint],
        tip_transform: Isometry3::identity(),
    };
    let setup = MachineSetup {
        lever_m: Vector3::new(0.12, 0.0, 0.03),
        lever_sd_m: 1e-3,
        tip_from_sensor: UnitQuaternion::from_scaled_axis(Vector3::new(0.6755, -0.6755, 0.0)),
        tilt_sd_rad: 1e-3,
        geometry_translation_sd_m: 0.0,
        geometry_rotation_sd_rad: 0.0,
        zero_sd: 0.0,
        ..MachineSetup::default()
    };
    let mut simulated = Simulated::new(Some(chain), setup, &encoders(1));
    simulated.model = SensorModel::ScaleBias;
    simulated
}

/// The sentence of this code.
fn said(simulated: &Simulated, code: &str) -> Option<String> {
    let calibration = simulated.calibrated().expect("determined");
    let found = calibration.sensors.warnings.into_iter().find(|found| found.code().name() == code);
    found.map(|found| found.message().to_owned())
}

#[test]
fn gravity_and_lever_arms_that_a_table_does_not_show_are_named() {
    let mut simulated = on_a_table();
    let good = codes(&simulated.calibrated().expect("determined"));
    for code in ["up-otherwise", "bias-implausible", "gains-share-factor"] {
        assert!(!good.contains(&code), "{good:?}");
    }
    simulated.setup.up = -Vector3::z();
    let up = said(&simulated, "up-otherwise");
    assert!(up.as_deref().is_some_and(|up| up.contains("up is \"z\"")), "{up:?}");
    simulated.setup.up = Vector3::z();
    simulated.setup.lever_m.x += 0.02;
    let factor = said(&simulated, "gains-share-factor");
    // the same forces, with a longer arm
    assert!(factor.as_deref().is_some_and(|of| of.contains("accelerometer are 0.8")), "{factor:?}");
}

#[test]
fn a_mounting_that_is_called_exact_and_is_not_is_named_with_the_one_that_fits() {
    let setup = MachineSetup { mounting: MountingPrior::Exact, ..MachineSetup::default() };
    let mut simulated = Simulated::new(Some(wrist()), setup, &encoders(3));
    assert_eq!(said(&simulated, "mounting-otherwise"), None);
    let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.02, -0.025, 0.014));
    simulated.setup.tip_from_sensor = turn;
    let named = said(&simulated, "mounting-otherwise").expect("both matrices are turned");
    // the joints' axes are known to 3e-4 rad each
    let angle = ["both sensors are turned by 1.9", "both sensors are turned by 2.0"];
    assert!(angle.iter().any(|angle| named.contains(angle)), "{named}");
    let numbers = |part: &str| part.split(", ").map(|number| number.parse().ok()).collect();
    let rotation: Vec<f64> = named.split(['[', ']']).find_map(numbers).expect("a quaternion");
    // the remedy to the letter: the true mounting is none
    assert!(rotation[1..].iter().all(|half| half.abs() < 1e-3), "{named}");
    simulated.setup.tip_from_sensor = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(
        rotation[0],
        rotation[1],
        rotation[2],
        rotation[3],
    ));
    assert_eq!(said(&simulated, "mounting-otherwise"), None);
}

#[test]
fn a_sensor_that_drifts_is_named() {
    let mut simulated = Simulated::new(Some(wrist()), MachineSetup::default(), &encoders(3));
    assert_eq!(said(&simulated, "sensor-drifts"), None);
    let gyroscope = simulated.recording[SensorKind::Gyroscope].as_mut().expect("recorded");
    let count = gyroscope.len() as f64;
    for (k, reading) in gyroscope.readings_mut().iter_mut().enumerate() {
        reading.y += 0.01 * (k as f64 / count - 0.5);
    }
    let named = said(&simulated, "sensor-drifts").expect("twelve usual drifts");
    assert!(named.starts_with("the gyroscope drifts") && named.contains("its bias changes"), "{named}");
}
