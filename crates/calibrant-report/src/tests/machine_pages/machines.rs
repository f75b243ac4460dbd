//! A small arm that carries an IMU,: simulated readings, really calibrated against joints or against poses.

use super::sensor;
use calibrant_machine::chain::{
    ChainCorrections, FrameMotion, Joint, JointKind, JointLimits, JointState, KinematicChain, SensorMount,
};
use calibrant_machine::estimate::{
    MachineCalibration, MachineProblem, MachineSettings, MachineSetup, MountingPrior, calibrate_on_machine,
};
use calibrant_machine::log::{JointLog, PoseLog, ReferenceLog};
use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use sensor::{
    ImuParameters, ImuQuantity, ImuRecording, ParameterList, ReadingUnit, Recording, SensorKind, SensorModel,
};

/// Sample rate of both clocks, Hz.
const RATE_HZ: f64 = 200.0;
/// Motion time less IMU time, s.
const DELAY_S: f64 = 4e-3;
/// Names of the joints.
pub(crate) const JOINTS: [&str; 3] = ["shoulder", "elbow", "wrist"];

/// The recording, what was known beforehand, and the calibration.
pub(crate) struct MachineCase {
    pub(crate) recording: ImuRecording,
    pub(crate) setup: MachineSetup,
    pub(crate) calibration: MachineCalibration,
}

fn chain() -> KinematicChain {
    let joint = |name: &str, axis, origin| Joint {
        name: name.into(),
        kind: JointKind::Revolute,
        axis,
        origin,
        limits: JointLimits::default(),
    };
    let [z, y, x] = [Vector3::z_axis(), Vector3::y_axis(), Vector3::x_axis()];
    let [shoulder, elbow, wrist] = JOINTS;
    KinematicChain {
        base: "base".into(),
        tip: "tool".into(),
        joints: vec![
            joint(shoulder, z, Isometry3::translation(0.0, 0.0, 0.2)),
            joint(elbow, y, Isometry3::translation(0.0, 0.1, 0.3)),
            joint(wrist, x, Isometry3::translation(0.4, 0.0, 0.0)),
        ],
        tip_transform: Isometry3::translation(0.1, 0.0, 0.05),
    }
}

/// Position of a joint and its two derivatives.
fn joint_at(joint: usize, time_s: f64) -> [f64; 3] {
    let waves = [[0.9, 1.3, 0.2], [0.5, 2.9 + 0.4 * joint as f64, 1.1 * joint as f64]];
    waves.iter().fold([0.0; 3], |[q, qd, qdd], [size, rate, phase]| {
        let (sin, cos) = (rate * time_s + phase).sin_cos();
        [q + size * sin, qd + size * rate * cos, qdd - size * rate * rate * sin]
    })
}

/// For this long. With `poses`, cameras saw the tool in place of the encoders.
pub(crate) fn machine_case(poses: bool, duration_s: f64, seed: u64) -> MachineCase {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut noise = |sd: f64| {
        Vector3::from_fn(|_, _| {
            let z: f64 = StandardNormal.sample(&mut random);
            sd * z
        })
    };
    let chain = chain();
    let mut corrections = ChainCorrections::none(JOINTS.len());
    if !poses {
        corrections.joints[1].rotation_rad.x = 6e-4;
        corrections.joints[2].translation_m.y = -4e-4;
    }
    let arm = chain.corrected(&corrections);
    let lever_m = Vector3::new(0.021, -0.012, 0.034);
    let mount = SensorMount { lever_m, tip_from_sensor: UnitQuaternion::identity() };
    let base = FrameMotion::at_rest(&Vector3::new(0.0, 0.0, -9.81));
    let count = (duration_s * RATE_HZ) as usize;
    let time = |k: usize| k as f64 / RATE_HZ;
    let state = |time_s: f64| [0, 1, 2].map(|joint| joint_at(joint, time_s));
    let (mut forces, mut rates) = (Vec::new(), Vec::new());
    for k in 10..count - 10 {
        let at = state(time(k) + DELAY_S);
        let [positions, velocities, accelerations] = [0, 1, 2].map(|d| at.map(|joint| joint[d]));
        let joints =
            JointState { positions: &positions, velocities: &velocities, accelerations: &accelerations };
        let felt = mount.motion(&arm.tip_motion(joints, &base));
        forces.push(felt.specific_force + Vector3::new(0.05, -0.02, 0.1) + noise(5e-3));
        rates.push(felt.rate * 1.002 + Vector3::repeat(3e-3) + noise(1e-3));
    }
    let times_s: Vec<f64> = (10..count - 10).map(time).collect();
    let of = |readings, unit| Recording::new(times_s.clone(), readings, 3, unit).expect("samples in order");
    let recording = ImuRecording {
        sensors: [
            Some(of(forces, ReadingUnit::MetrePerSecondSquared)),
            Some(of(rates, ReadingUnit::RadianPerSecond)),
        ]
        .into(),
        temperature_c: None,
    };
    let times_s: Vec<f64> = (0..count).map(time).collect();
    let positions: Vec<[f64; 3]> = times_s.iter().map(|time| state(*time).map(|joint| joint[0])).collect();
    let log = if poses {
        let tips: Vec<Isometry3<f64>> = positions.iter().map(|q| arm.tip_pose(q)).collect();
        ReferenceLog::Poses(PoseLog {
            positions_m: tips.iter().map(|tip| Some(tip.translation.vector + noise(1e-4))).collect(),
            world_from_body: (tips.iter())
                .map(|tip| Some(tip.rotation * UnitQuaternion::from_scaled_axis(noise(3e-4))))
                .collect(),
            times_s,
        })
    } else {
        ReferenceLog::Joints(JointLog {
            times_s,
            names: JOINTS.map(str::to_string).into(),
            positions: positions.iter().flat_map(|q| *q).map(|q| q + noise(2e-5).x).collect(),
            velocities: None,
        })
    };
    let setup = MachineSetup {
        gravity_mps2: 9.81,
        lever_m: Vector3::new(0.02, -0.01, 0.035),
        mounting: if poses { MountingPrior::Exact } else { MachineSetup::default().mounting },
        ..MachineSetup::default()
    };
    let parameters = ParameterList::new(3, SensorModel::Full);
    let quantities: Vec<ImuQuantity> = (SensorKind::ALL.iter())
        .flat_map(|kind| parameters.quantities().iter().map(|of| ImuQuantity::Of(*kind, *of)))
        .collect();
    let problem = MachineProblem {
        recording: &recording,
        log: &log,
        chain: (!poses).then_some(&chain),
        setup: &setup,
        nominal: &ImuParameters::identity(),
        quantities: &quantities,
    };
    let calibration =
        calibrate_on_machine(&problem, &MachineSettings::default()).expect("the motion determines it");
    MachineCase { recording, setup, calibration }
}
