//! The reference, whatever was logged.

use super::pose_motion::POSE_UNKNOWNS;
use super::{Felt, JointMotion, MotionColumns, PoseMotion};
use crate::chain::{ChainCorrections, CorrectedChain, FrameMotion, SensorMount};
use crate::spline::{UniformKnots, Weights};
use nalgebra::{Isometry3, Vector3};

/// The motion of the reference.
#[derive(Debug, Clone, PartialEq)]
pub enum Motion {
    /// Positions of the joints of a chain.
    Joints(JointMotion),
    /// Poses of the body.
    Poses(PoseMotion),
}

/// What turns the motion of the reference into what the sensor feels.
#[derive(Debug, Clone)]
pub struct Carrier {
    /// Gravity `γ` in the base frame (the world of poses), m/s².
    pub gravity: Vector3<f64>,
    /// The sensor on the tip.
    pub mount: SensorMount,
    /// The chain with its corrections; none for poses.
    pub chain: Option<CorrectedChain>,
}

impl Motion {
    /// The knots of its splines.
    #[must_use]
    pub fn knots(&self) -> UniformKnots {
        match self {
            Self::Joints(joints) => joints.positions.knots,
            Self::Poses(poses) => poses.position.knots,
        }
    }

    /// Unknowns of a control point.
    #[must_use]
    pub fn unknowns(&self) -> usize {
        match self {
            Self::Joints(joints) => joints.positions.dimension,
            Self::Poses(_) => POSE_UNKNOWNS,
        }
    }

    /// Number of joints; none for poses.
    #[must_use]
    pub fn joints(&self) -> usize {
        match self {
            Self::Joints(joints) => joints.positions.dimension,
            Self::Poses(_) => 0,
        }
    }

    /// Where derivatives stand, with or without those by the control points.
    #[must_use]
    pub fn columns(&self, with_controls: bool) -> MotionColumns {
        let controls = if with_controls { self.unknowns() * self.knots().degree.order() } else { 0 };
        MotionColumns { controls, joints: self.joints() }
    }

    /// What carries the sensor, with these corrections of the chain.
    #[must_use]
    pub fn carrier(
        &self,
        gravity: Vector3<f64>,
        mount: SensorMount,
        corrections: &ChainCorrections,
    ) -> Carrier {
        let chain = match self {
            Self::Joints(joints) => Some(joints.chain.corrected(corrections)),
            Self::Poses(_) => None,
        };
        Carrier { gravity, mount, chain }
    }

    /// The motion of the sensor with these weights, without derivatives. `joints` is working memory, empty at first.
    #[must_use]
    pub fn sensor(&self, weights: &Weights, carrier: &Carrier, joints: &mut [Vec<f64>; 4]) -> FrameMotion {
        let tip = match (self, &carrier.chain) {
            (Self::Joints(motion), Some(chain)) => {
                chain.tip_motion(motion.state(weights, joints), &FrameMotion::at_rest(&carrier.gravity))
            }
            (Self::Poses(poses), _) => poses.body(weights, &carrier.gravity),
            (Self::Joints(_), None) => FrameMotion::at_rest(&carrier.gravity),
        };
        carrier.mount.motion(&tip)
    }

    /// What the sensor feels with these weights.
    pub fn feel(&self, weights: &Weights, carrier: &Carrier, columns: MotionColumns, felt: &mut Felt) {
        match (self, &carrier.chain) {
            (Self::Joints(joints), Some(chain)) => {
                joints.feel(weights, &carrier.gravity, chain, &carrier.mount, columns, felt);
            }
            (Self::Poses(poses), _) => poses.feel(weights, &carrier.gravity, &carrier.mount, columns, felt),
            (Self::Joints(_), None) => {}
        }
    }

    /// Moves the control points.
    pub fn step(&mut self, steps: &[f64]) {
        match self {
            Self::Joints(joints) => {
                for (control, step) in joints.positions.controls.iter_mut().zip(steps) {
                    *control += step;
                }
            }
            Self::Poses(poses) => poses.step(steps),
        }
    }
}

/// The machine at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct Posture {
    /// Time of the motion, s.
    pub time_s: f64,
    /// Poses of the frames behind each joint and of the tip, or of the tracked body alone; m.
    pub frames: Vec<Isometry3<f64>>,
    /// Speed of the tip, m/s.
    pub speed_mps: f64,
    /// Angular rate of the tip, rad/s.
    pub rate_radps: f64,
}

impl Posture {
    /// Pose of the tip, or of the tracked body.
    #[must_use]
    pub fn tip(&self) -> Isometry3<f64> {
        self.frames.last().copied().unwrap_or_else(Isometry3::identity)
    }
}

impl Motion {
    /// The machine at these times, with these corrections of the chain.
    #[must_use]
    pub fn postures(&self, times_s: &[f64], corrections: &ChainCorrections) -> Vec<Posture> {
        match self {
            Self::Joints(joints) => {
                let chain = joints.chain.corrected(corrections);
                let at = |&time_s: &f64| {
                    let positions = joints.positions.at(time_s, 0);
                    let velocity = chain.tip_velocity(&positions, &joints.positions.at(time_s, 1));
                    Posture {
                        time_s,
                        frames: chain.frames(&positions),
                        speed_mps: velocity.linear_mps.norm(),
                        rate_radps: velocity.rate_radps.norm(),
                    }
                };
                times_s.iter().map(at).collect()
            }
            Self::Poses(poses) => {
                let at = |&time_s: &f64| {
                    let weights = poses.position.knots.weights(time_s);
                    let vector = |derivative| {
                        Vector3::from_fn(|j, _| poses.position.component(&weights, derivative, j))
                    };
                    let orientation = poses.orientation.with(&weights);
                    Posture {
                        time_s,
                        frames: vec![Isometry3::from_parts(vector(0).into(), orientation.world_from_body)],
                        speed_mps: vector(1).norm(),
                        rate_radps: orientation.rate.norm(),
                    }
                };
                times_s.iter().map(at).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::{Joint, JointKind, JointLimits, KinematicChain};
    use crate::reference::{JointMotion, PoseMotion};
    use crate::spline::{Degree, RotationSpline, UniformKnots, VectorSpline};
    use nalgebra::UnitQuaternion;

    /// A straight line at 0.5 per second is a spline whose control points lie on it.
    fn line(knots: UniformKnots) -> Vec<f64> {
        (0..knots.controls()).map(|i| 0.5 * knots.centre_s(i)).collect()
    }

    #[test]
    fn an_arm_that_turns_evenly_has_the_speed_of_its_circle() {
        let knots = UniformKnots::covering(0.0, 4.0, 0.1, Degree::Cubic);
        let joint = Joint {
            name: "table".into(),
            kind: JointKind::Continuous,
            axis: Vector3::z_axis(),
            origin: Isometry3::identity(),
            limits: JointLimits::default(),
        };
        let tip_transform = Isometry3::translation(0.4, 0.0, 0.1);
        let chain =
            KinematicChain { base: "base".into(), tip: "tip".into(), joints: vec![joint], tip_transform };
        let positions = VectorSpline { knots, dimension: 1, controls: line(knots) };
        let motion = Motion::Joints(JointMotion { chain, positions });
        let mut corrections = ChainCorrections::none(1);
        corrections.joints[0].zero = 0.25;
        for posture in motion.postures(&[0.7, 2.0], &corrections) {
            let angle = 0.5 * posture.time_s + 0.25;
            let tip = Vector3::new(0.4 * angle.cos(), 0.4 * angle.sin(), 0.1);
            assert!((posture.tip().translation.vector - tip).norm() < 1e-12);
            assert!((posture.speed_mps - 0.2).abs() < 1e-12 && (posture.rate_radps - 0.5).abs() < 1e-12);
            assert_eq!(posture.frames.len(), 2);
        }
    }

    #[test]
    fn a_body_has_its_pose_and_speed() {
        let knots = UniformKnots::covering(0.0, 4.0, 0.1, Degree::Quintic);
        let along: Vec<f64> = line(knots);
        let controls = along.iter().flat_map(|x| [*x, 0.0, 1.0]).collect();
        let turn = |angle: &f64| UnitQuaternion::from_scaled_axis(Vector3::x() * *angle);
        let motion = Motion::Poses(PoseMotion {
            position: VectorSpline { knots, dimension: 3, controls },
            orientation: RotationSpline { knots, controls: along.iter().map(turn).collect() },
        });
        let posture = &motion.postures(&[3.0], &ChainCorrections::none(0))[0];
        assert!((posture.tip().translation.vector - Vector3::new(1.5, 0.0, 1.0)).norm() < 1e-12);
        assert!(posture.tip().rotation.angle_to(&turn(&1.5)) < 1e-9);
        assert!((posture.speed_mps - 0.5).abs() < 1e-12 && (posture.rate_radps - 0.5).abs() < 1e-12);
    }
}
