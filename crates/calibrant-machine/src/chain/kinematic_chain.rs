//! Joints one after the other.

use super::joint_motion::JointMotion;
use super::{ChainCorrections, FrameMotion, Joint, JointCorrection, JointState};
use crate::spline::right_jacobian;
use nalgebra::{Isometry3, Matrix3, Translation3, Unit, UnitQuaternion, Vector3};

/// The joints that move between a base and a tip. Fixed joints are part of the transform of the next joint, or of the tip.
///
/// # Examples
/// A rate table turns at 2 rad/s. A frame 0.5 m from its axis feels gravity, and 2 m/s² towards the axis.
/// ```
/// use calibrant_machine::chain::*;
/// use nalgebra::{Isometry3, Vector3};
/// let table = KinematicChain {
///     base: "base".into(),
///     tip: "plate".into(),
///     joints: vec![Joint {
///         name: "table".into(),
///         kind: JointKind::Continuous,
///         axis: Vector3::z_axis(),
///         origin: Isometry3::identity(),
///         limits: JointLimits::default(),
///     }],
///     tip_transform: Isometry3::translation(0.5, 0.0, 0.0),
/// };
/// let state = JointState { positions: &[0.3], velocities: &[2.0], accelerations: &[0.0] };
/// let base = FrameMotion::at_rest(&Vector3::new(0.0, 0.0, -9.8));
/// let tip = table.nominal().tip_motion(state, &base);
/// assert!((tip.specific_force - Vector3::new(-2.0, 0.0, 9.8)).norm() < 1e-12);
/// assert_eq!(tip.rate, Vector3::new(0.0, 0.0, 2.0));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct KinematicChain {
    /// Name of the link that does not move.
    pub base: String,
    /// Name of the link that carries the sensor.
    pub tip: String,
    /// The joints that move, from base to tip.
    pub joints: Vec<Joint>,
    /// Pose of the tip in the frame of the last joint, or in the base if no joint moves; m.
    pub tip_transform: Isometry3<f64>,
}

impl KinematicChain {
    /// The chain as its file says.
    #[must_use]
    pub fn nominal(&self) -> CorrectedChain {
        self.corrected(&ChainCorrections::none(self.joints.len()))
    }

    /// The same chain with the corrections in its joints' poses, as a file with the right numbers would describe it.
    ///
    /// # Panics
    /// If the corrections are for another number of joints.
    #[must_use]
    pub fn with(&self, corrections: &ChainCorrections) -> Self {
        assert_eq!(corrections.joints.len(), self.joints.len(), "one correction for each joint");
        let corrected = |(joint, of): (&Joint, &JointCorrection)| {
            let turned = UnitQuaternion::from_scaled_axis(of.rotation_rad);
            let at_zero = match joint.kind.turns() {
                true => Isometry3::rotation(joint.axis.into_inner() * of.zero),
                false => Isometry3::from(Translation3::from(joint.axis.into_inner() * of.zero)),
            };
            let correction = Isometry3::from_parts(Translation3::from(of.translation_m), turned);
            Joint { origin: joint.origin * correction * at_zero, ..joint.clone() }
        };
        Self { joints: self.joints.iter().zip(&corrections.joints).map(corrected).collect(), ..self.clone() }
    }

    /// The chain with corrections of its geometry.
    ///
    /// # Panics
    /// If the corrections are for another number of joints.
    #[must_use]
    pub fn corrected(&self, corrections: &ChainCorrections) -> CorrectedChain {
        CorrectedChain::new(&self.joints, &self.tip_transform, corrections)
    }
}

/// A fixed transform: translation, and the frame before from the frame behind.
#[derive(Debug, Clone, Copy)]
pub(super) struct FixedStep {
    pub rho: Vector3<f64>,
    pub c: Matrix3<f64>,
}

impl FixedStep {
    fn of(pose: &Isometry3<f64>) -> Self {
        Self { rho: pose.translation.vector, c: pose.rotation.to_rotation_matrix().into_inner() }
    }

    pub(super) fn pass(&self, before: &FrameMotion) -> FrameMotion {
        before.shifted(&self.rho).turned(&self.c)
    }
}

/// One joint and what comes before it.
#[derive(Debug, Clone)]
pub(super) struct Link {
    /// From the joint before to this joint, corrections included.
    pub fixed: FixedStep,
    /// Rotation of the correction, and its right Jacobian.
    pub turn: Matrix3<f64>,
    pub jacobian: Matrix3<f64>,
    turns: bool,
    axis: Unit<Vector3<f64>>,
    zero: f64,
    pose: Isometry3<f64>,
}

impl Link {
    pub(super) fn joint(&self, state: JointState, i: usize) -> JointMotion {
        let [q, qd, qdd] = [state.positions, state.velocities, state.accelerations].map(|of| of[i]);
        JointMotion::new(self.turns, &self.axis, [q + self.zero, qd, qdd])
    }
}

/// A chain with its corrections: see [`KinematicChain::corrected`](super::KinematicChain::corrected).
///
/// Its functions panic if a state is for another number of joints.
#[derive(Debug, Clone)]
pub struct CorrectedChain {
    pub(super) links: Vec<Link>,
    pub(super) tip: FixedStep,
    tip_pose: Isometry3<f64>,
}

/// Velocity of the tip, in the axes of the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipVelocity {
    /// Of its origin, m/s.
    pub linear_mps: Vector3<f64>,
    /// Angular rate, rad/s.
    pub rate_radps: Vector3<f64>,
}

impl CorrectedChain {
    pub(super) fn new(joints: &[Joint], tip_pose: &Isometry3<f64>, corrections: &ChainCorrections) -> Self {
        assert_eq!(joints.len(), corrections.joints.len(), "one correction for each joint");
        let link = |(joint, correction): (&Joint, &JointCorrection)| {
            let turn = UnitQuaternion::from_scaled_axis(correction.rotation_rad);
            let moved = Isometry3::from_parts(Translation3::from(correction.translation_m), turn);
            let pose = joint.origin * moved;
            Link {
                fixed: FixedStep::of(&pose),
                turn: turn.to_rotation_matrix().into_inner(),
                jacobian: right_jacobian(&correction.rotation_rad),
                turns: joint.kind.turns(),
                axis: joint.axis,
                zero: correction.zero,
                pose,
            }
        };
        let links = joints.iter().zip(&corrections.joints).map(link).collect();
        Self { links, tip: FixedStep::of(tip_pose), tip_pose: *tip_pose }
    }

    /// Number of joints that move.
    #[must_use]
    pub fn joints(&self) -> usize {
        self.links.len()
    }

    /// Motion of the tip, from that of the base.
    ///
    /// A base that does not move is [`FrameMotion::at_rest`]. A base with the Earth's rate gives the rate that a gyroscope reads.
    #[must_use]
    pub fn tip_motion(&self, state: JointState, base: &FrameMotion) -> FrameMotion {
        self.check(state.positions);
        let steps = self.links.iter().enumerate();
        let last =
            steps.fold(*base, |before, (i, link)| link.joint(state, i).pass(&link.fixed.pass(&before)));
        self.tip.pass(&last)
    }

    /// Poses of the frames behind each joint, in the base, then that of the tip; m.
    ///
    /// # Examples
    /// ```
    /// use calibrant_machine::chain::*;
    /// use nalgebra::{Isometry3, Vector3};
    /// let arm = KinematicChain {
    ///     base: "base".into(),
    ///     tip: "tip".into(),
    ///     joints: vec![Joint {
    ///         name: "elbow".into(),
    ///         kind: JointKind::Revolute,
    ///         axis: Vector3::z_axis(),
    ///         origin: Isometry3::translation(1.0, 0.0, 0.0),
    ///         limits: JointLimits::default(),
    ///     }],
    ///     tip_transform: Isometry3::translation(0.5, 0.0, 0.0),
    /// };
    /// let frames = arm.nominal().frames(&[std::f64::consts::FRAC_PI_2]);
    /// assert!((frames[1].translation.vector - Vector3::new(1.0, 0.5, 0.0)).norm() < 1e-15);
    /// ```
    #[must_use]
    pub fn frames(&self, positions: &[f64]) -> Vec<Isometry3<f64>> {
        self.check(positions);
        let mut frame = Isometry3::identity();
        let mut frames = Vec::with_capacity(self.links.len() + 1);
        for (link, q) in self.links.iter().zip(positions) {
            let moved = link.axis.into_inner() * (q + link.zero);
            frame = frame
                * link.pose
                * if link.turns { Isometry3::rotation(moved) } else { Translation3::from(moved).into() };
            frames.push(frame);
        }
        frames.push(frame * self.tip_pose);
        frames
    }

    /// Pose of the tip in the base, m.
    #[must_use]
    pub fn tip_pose(&self, positions: &[f64]) -> Isometry3<f64> {
        self.frames(positions)[self.links.len()]
    }

    /// Velocity of the tip.
    #[must_use]
    pub fn tip_velocity(&self, positions: &[f64], velocities: &[f64]) -> TipVelocity {
        let frames = self.frames(positions);
        let tip = frames[self.links.len()].translation.vector;
        let mut velocity = TipVelocity { linear_mps: Vector3::zeros(), rate_radps: Vector3::zeros() };
        for ((link, frame), qd) in self.links.iter().zip(&frames).zip(velocities) {
            let along = frame.rotation * link.axis.into_inner() * *qd;
            if link.turns {
                velocity.rate_radps += along;
                velocity.linear_mps += along.cross(&(tip - frame.translation.vector));
            } else {
                velocity.linear_mps += along;
            }
        }
        velocity
    }

    pub(super) fn check(&self, positions: &[f64]) {
        assert_eq!(positions.len(), self.links.len(), "one position for each joint");
    }
}

#[cfg(test)]
mod tests {
    use super::super::chains_for_tests::{Numbers, corrections_of, mixed_chain};
    use super::super::{JointKind, JointLimits, KinematicChain};
    use super::*;

    fn joint(kind: JointKind, axis: Unit<Vector3<f64>>, origin: Isometry3<f64>) -> Joint {
        Joint { name: "joint".into(), kind, axis, origin, limits: JointLimits::default() }
    }

    fn chain(joints: Vec<Joint>, tip_transform: Isometry3<f64>) -> CorrectedChain {
        KinematicChain { base: "base".into(), tip: "tip".into(), joints, tip_transform }.nominal()
    }

    fn near(one: Vector3<f64>, x: f64, y: f64, z: f64) {
        assert!((one - Vector3::new(x, y, z)).norm() < 1e-13, "{one}");
    }

    #[test]
    fn a_chain_with_its_corrections_is_the_corrected_chain() {
        let mut numbers = Numbers(1);
        let chain = mixed_chain(5, &mut numbers);
        let corrections = corrections_of(chain.joints.len(), 0.1, &mut numbers);
        let positions: Vec<f64> = (0..chain.joints.len()).map(|j| 0.4 - 0.3 * j as f64).collect();
        let one = chain.corrected(&corrections).tip_pose(&positions);
        let other = chain.with(&corrections).nominal().tip_pose(&positions);
        assert!((one.to_homogeneous() - other.to_homogeneous()).norm() < 1e-13);
        assert!((one.to_homogeneous() - chain.nominal().tip_pose(&positions).to_homogeneous()).norm() > 1e-3);
    }

    #[test]
    fn a_rate_table_gives_centripetal_and_tangential_acceleration() {
        let table = chain(
            vec![joint(JointKind::Continuous, Vector3::z_axis(), Isometry3::identity())],
            Isometry3::translation(0.2, 0.0, 0.0),
        );
        let state = JointState { positions: &[0.7], velocities: &[3.0], accelerations: &[5.0] };
        let tip = table.tip_motion(state, &FrameMotion::at_rest(&Vector3::new(0.0, 0.0, -9.81)));
        near(tip.specific_force, -0.2 * 9.0, 0.2 * 5.0, 9.81);
        near(tip.rate, 0.0, 0.0, 3.0);
        near(tip.angular_acceleration, 0.0, 0.0, 5.0);
    }

    #[test]
    fn a_free_pendulum_feels_no_force_across_its_arm() {
        let (length, gravity, angle, speed) = (0.8, 9.81, 0.6_f64, 1.3);
        let pendulum = chain(
            vec![joint(JointKind::Continuous, Vector3::y_axis(), Isometry3::identity())],
            Isometry3::translation(0.0, 0.0, -length),
        );
        let acceleration = -gravity / length * angle.sin();
        let state = JointState { positions: &[angle], velocities: &[speed], accelerations: &[acceleration] };
        let tip = pendulum.tip_motion(state, &FrameMotion::at_rest(&Vector3::new(0.0, 0.0, -gravity)));
        near(tip.specific_force, 0.0, 0.0, gravity * angle.cos() + length * speed * speed);
    }

    #[test]
    fn a_gantry_feels_its_accelerations_and_gravity() {
        let axes = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()];
        let joints =
            axes.map(|axis| joint(JointKind::Prismatic, axis, Isometry3::translation(0.1, 0.2, 0.3)));
        let gantry = chain(joints.to_vec(), Isometry3::identity());
        let state = JointState {
            positions: &[0.3, -0.2, 0.5],
            velocities: &[1.0, 2.0, 3.0],
            accelerations: &[4.0, -5.0, 6.0],
        };
        let tip = gantry.tip_motion(state, &FrameMotion::at_rest(&Vector3::new(0.0, 0.0, -9.81)));
        near(tip.specific_force, 4.0, -5.0, 15.81);
        near(tip.rate, 0.0, 0.0, 0.0);
        near(gantry.tip_pose(state.positions).translation.vector, 0.6, 0.4, 1.4);
        near(gantry.tip_velocity(state.positions, state.velocities).linear_mps, 1.0, 2.0, 3.0);
    }

    #[test]
    fn a_slide_on_a_rate_table_feels_the_coriolis_acceleration() {
        let machine = chain(
            vec![
                joint(JointKind::Continuous, Vector3::z_axis(), Isometry3::identity()),
                joint(JointKind::Prismatic, Vector3::x_axis(), Isometry3::identity()),
            ],
            Isometry3::identity(),
        );
        let state =
            JointState { positions: &[1.0, 0.5], velocities: &[2.0, 0.3], accelerations: &[0.0, 0.7] };
        let tip = machine.tip_motion(state, &FrameMotion::at_rest(&Vector3::zeros()));
        near(tip.specific_force, 0.7 - 4.0 * 0.5, 2.0 * 2.0 * 0.3, 0.0);
    }

    /// The pose is computed without the recursion: its derivatives in time are another way to the same motion.
    #[test]
    fn the_motion_is_the_second_derivative_of_the_pose() {
        for seed in 1..20 {
            let mut numbers = Numbers(seed);
            let joints = 1 + seed as usize % 7;
            let chain =
                mixed_chain(joints, &mut numbers).corrected(&corrections_of(joints, 0.2, &mut numbers));
            let [q, qd, qdd] =
                [2.0, 1.5, 2.0].map(|size| (0..joints).map(|_| numbers.next(size)).collect::<Vec<_>>());
            let gravity = numbers.vector(10.0);
            let at = |t: f64| {
                let moved = |i: usize| q[i] + qd[i] * t + 0.5 * qdd[i] * t * t;
                chain.tip_pose(&(0..joints).map(moved).collect::<Vec<_>>())
            };
            let h = 1e-3;
            let [a, b, pose, d, e] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| at(k * h));
            let of = |pose: &Isometry3<f64>| pose.translation.vector;
            let second =
                (-of(&a) + of(&b) * 16.0 - of(&pose) * 30.0 + of(&d) * 16.0 - of(&e)) / (12.0 * h * h);
            let first = (of(&a) - of(&b) * 8.0 + of(&d) * 8.0 - of(&e)) / (12.0 * h);
            let turn = |other: &Isometry3<f64>| (pose.rotation.inverse() * other.rotation).scaled_axis();
            let rate = (turn(&a) - turn(&b) * 8.0 + turn(&d) * 8.0 - turn(&e)) / (12.0 * h);
            // the second derivative of a rotation vector at zero is the angular acceleration
            let turning = (-turn(&a) + turn(&b) * 16.0 + turn(&d) * 16.0 - turn(&e)) / (12.0 * h * h);

            let state = JointState { positions: &q, velocities: &qd, accelerations: &qdd };
            let tip = chain.tip_motion(state, &FrameMotion::at_rest(&gravity));
            let force = pose.rotation.inverse() * (second - gravity);
            let velocity = chain.tip_velocity(&q, &qd);
            for (found, wanted) in [
                (tip.specific_force, force),
                (tip.rate, rate),
                (tip.angular_acceleration, turning),
                (velocity.linear_mps, first),
                (velocity.rate_radps, pose.rotation * rate),
            ] {
                assert!((found - wanted).norm() < 1e-6 * (1.0 + wanted.norm()), "{seed}: {found} {wanted}");
            }
        }
    }
}
