//! What the machine logs of its motion.

use crate::log::{JointLog, PoseLog, ReferenceLog};
use crate::reference::Motion;
use calibrant_core::simulate::Rng;
use nalgebra::{UnitQuaternion, Vector3};
use rand_distr::{Distribution, StandardNormal};

/// Rate and errors of a log.
#[derive(Debug, Clone, PartialEq)]
pub struct LogErrors {
    /// Sample rate, Hz. It is rounded so that the steps fit into the motion.
    pub rate_hz: f64,
    /// Standard deviation of one sample: of each joint, rad or m, or of three axes of position, m, and three of orientation, rad.
    pub noise: Vec<f64>,
    /// Step of the encoders, rad or m; 0 for none.
    pub resolution: f64,
}

/// The log of a whole motion.
#[must_use]
pub fn record_log(motion: &Motion, errors: &LogErrors, rng: &mut Rng) -> ReferenceLog {
    let (knots, LogErrors { rate_hz, noise, resolution }) = (motion.knots(), errors);
    let duration_s = knots.end_s() - knots.start_s;
    let steps = (duration_s * rate_hz).round().max(1.0);
    let times_s: Vec<f64> =
        (0..=steps as usize).map(|k| knots.start_s + duration_s * (k as f64 / steps)).collect();
    let mut normal = |k: usize| -> f64 {
        let z: f64 = StandardNormal.sample(rng);
        z * noise[k]
    };
    match motion {
        Motion::Joints(joints) => {
            let n = joints.positions.dimension;
            let names = joints.chain.joints.iter().map(|joint| joint.name.clone()).collect();
            let mut positions = Vec::with_capacity(n * times_s.len());
            for time_s in &times_s {
                let read = |(j, position): (usize, f64)| {
                    let position = position + normal(j);
                    let step = *resolution;
                    // a zero without a sign
                    if step > 0.0 { (position / step).round() * step + 0.0 } else { position }
                };
                positions.extend(joints.positions.at(*time_s, 0).into_iter().enumerate().map(read));
            }
            ReferenceLog::Joints(JointLog { names, times_s, positions, velocities: None })
        }
        Motion::Poses(poses) => {
            let mut log = PoseLog {
                positions_m: Vec::with_capacity(times_s.len()),
                world_from_body: Vec::with_capacity(times_s.len()),
                times_s: Vec::new(),
            };
            for time_s in &times_s {
                let position = Vector3::from_vec(poses.position.at(*time_s, 0));
                let orientation = poses.orientation.at(*time_s).world_from_body;
                log.positions_m.push(Some(position + Vector3::from_fn(|k, _| normal(k))));
                let turn = UnitQuaternion::from_scaled_axis(Vector3::from_fn(|k, _| normal(3 + k)));
                log.world_from_body.push(Some(orientation * turn));
            }
            ReferenceLog::Poses(PoseLog { times_s, ..log })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{MotionToDraw, draw_body_motion, draw_joint_motion};
    use super::*;
    use crate::chain::chains_for_tests::{Numbers, mixed_chain};
    use calibrant_core::simulate::{Purpose, stream};

    const WANTED: MotionToDraw =
        MotionToDraw { duration_s: 20.0, rest_s: 1.0, acceleration: 5.0, knot_step_s: None };

    #[test]
    fn joints_are_logged_with_noise_and_in_steps() {
        let chain = mixed_chain(3, &mut Numbers(2));
        let mut rng = stream(1, Purpose::Motion, 0);
        let motion = draw_joint_motion(&chain, &WANTED, &mut rng);
        let Motion::Joints(truth) = &motion else { panic!("of joints") };
        let errors = |noise: f64, resolution| LogErrors { rate_hz: 250.0, noise: vec![noise; 3], resolution };
        for (errors, sd) in [(errors(1e-3, 0.0), 1e-3), (errors(0.0, 1e-3), 1e-3 / 12.0_f64.sqrt())] {
            let ReferenceLog::Joints(log) = record_log(&motion, &errors, &mut rng) else { panic!("joints") };
            assert_eq!(log.times_s.len(), 5001);
            let moving = 400..4600;
            let mut squares = 0.0;
            for k in moving.clone() {
                let positions = truth.positions.at(log.times_s[k], 0);
                for (read, position) in log.row(k).iter().zip(positions) {
                    squares += (read - position).powi(2);
                    let steps = read / 1e-3;
                    assert!(errors.resolution == 0.0 || (steps - steps.round()).abs() < 1e-6);
                }
            }
            let found = (squares / (3 * moving.len()) as f64).sqrt();
            assert!((found / sd - 1.0).abs() < 0.1, "{found} {sd}");
        }
    }

    #[test]
    fn a_body_is_turned_to_all_sides_and_its_poses_scatter() {
        let mut rng = stream(4, Purpose::Motion, 0);
        let motion = draw_body_motion(&MotionToDraw { duration_s: 60.0, ..WANTED }, &mut rng);
        let errors =
            LogErrors { rate_hz: 100.0, noise: vec![1e-3, 1e-3, 1e-3, 5e-3, 5e-3, 5e-3], resolution: 0.0 };
        let ReferenceLog::Poses(log) = record_log(&motion, &errors, &mut rng) else { panic!("poses") };
        let (mut squares, mut up) = ([0.0; 2], [[false; 2]; 3]);
        let postures = motion.postures(&log.times_s, &crate::chain::ChainCorrections::none(0));
        for (k, posture) in postures.iter().enumerate() {
            let tip = posture.tip();
            let position = log.positions_m[k].expect("seen");
            let orientation = log.world_from_body[k].expect("seen");
            squares[0] += (position - tip.translation.vector).norm_squared();
            squares[1] += orientation.angle_to(&tip.rotation).powi(2);
            assert!((tip.translation.vector - Vector3::z() * 1.2).amax() < 0.55);
            let vertical = tip.rotation.inverse() * Vector3::z();
            for axis in 0..3 {
                up[axis][0] |= vertical[axis] > 0.7;
                up[axis][1] |= vertical[axis] < -0.7;
            }
        }
        assert_eq!(up, [[true; 2]; 3], "each axis points up and down");
        for (squares, sd) in squares.iter().zip([1e-3, 5e-3]) {
            let found = (squares / (3 * postures.len()) as f64).sqrt();
            assert!((found / sd - 1.0).abs() < 0.05, "{found} {sd}");
        }
    }
}
