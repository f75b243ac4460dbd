//! The reading of a sensor on a chain, and its derivatives.

use super::joint_motion::JointMotion;
use super::{
    ChainCorrections, CorrectedChain, FrameMotion, JointState, MountSensitivity, SensorGain, SensorMount,
};
use nalgebra::{Matrix6x3, Matrix6xX, Vector3};

/// What a sensor on a chain feels, and the derivatives of it. Rows are the specific force `f`, m/s², then the rate `w`, rad/s.
///
/// # Examples
/// A pendulum of 0.5 m: its angle turns gravity, and its acceleration gives force across the arm.
/// ```
/// use calibrant_machine::chain::*;
/// use nalgebra::{Isometry3, Vector3};
/// let pendulum = KinematicChain {
///     base: "base".into(),
///     tip: "bob".into(),
///     joints: vec![Joint {
///         name: "pivot".into(),
///         kind: JointKind::Continuous,
///         axis: Vector3::y_axis(),
///         origin: Isometry3::identity(),
///         limits: JointLimits::default(),
///     }],
///     tip_transform: Isometry3::translation(0.0, 0.0, -0.5),
/// };
/// let mut reading = ChainSensitivity::new(1);
/// let state = JointState { positions: &[0.0], velocities: &[0.0], accelerations: &[0.0] };
/// let base = FrameMotion::at_rest(&Vector3::new(0.0, 0.0, -9.8));
/// reading.evaluate(&pendulum.nominal(), state, &base, &SensorMount::identity());
/// assert_eq!(reading.sensor.specific_force, Vector3::new(0.0, 0.0, 9.8));
/// assert_eq!(reading.positions[(0, 0)], -9.8);
/// assert_eq!(reading.accelerations[(0, 0)], -0.5);
/// assert_eq!(reading.velocities[(4, 0)], 1.0); // the gyroscope's y axis
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ChainSensitivity {
    /// Motion of the sensor: its `specific_force` and `rate` are the reading.
    pub sensor: FrameMotion,
    /// With respect to the positions of the joints, and to their zeros.
    pub positions: Matrix6xX<f64>,
    /// With respect to the velocities of the joints.
    pub velocities: Matrix6xX<f64>,
    /// With respect to the accelerations of the joints.
    pub accelerations: Matrix6xX<f64>,
    /// With respect to the geometry: for each joint its translation, then its rotation vector. See [`JointCorrection`](super::JointCorrection).
    pub geometry: Matrix6xX<f64>,
    /// With respect to the motion of the tip, the lever arm and the mounting.
    pub mount: MountSensitivity,
    /// With respect to the motion of the base.
    pub base: SensorGain,
    steps: Vec<Step>,
}

/// A joint at one time, and the motions before and behind it.
#[derive(Debug, Clone, PartialEq)]
struct Step {
    joint: JointMotion,
    before: FrameMotion,
    behind: FrameMotion,
}

impl ChainSensitivity {
    /// A workspace for a chain of this many joints.
    #[must_use]
    pub fn new(joints: usize) -> Self {
        let rest = FrameMotion::at_rest(&Vector3::zeros());
        let columns = Matrix6xX::zeros(joints);
        Self {
            sensor: rest,
            positions: columns.clone(),
            velocities: columns.clone(),
            accelerations: columns,
            geometry: Matrix6xX::zeros(joints * ChainCorrections::GEOMETRY_PER_JOINT),
            mount: SensorMount::identity().sensitivity(&rest).1,
            base: SensorGain::identity(),
            steps: Vec::with_capacity(joints),
        }
    }

    /// Derivative with respect to the gravity vector in the axes of the base: `−R` and 0.
    #[must_use]
    pub fn gravity(&self) -> Matrix6x3<f64> {
        let mut of = Matrix6x3::zeros();
        of.fixed_rows_mut::<3>(0).copy_from(&-self.base.sensor_from_frame);
        of
    }

    /// What a sensor feels at one time, with its derivatives. Nothing is allocated.
    ///
    /// # Panics
    /// If the chain has another number of joints than this workspace or the state.
    pub fn evaluate(
        &mut self,
        chain: &CorrectedChain,
        state: JointState,
        base: &FrameMotion,
        mount: &SensorMount,
    ) {
        chain.check(state.positions);
        self.steps.clear();
        let mut motion = *base;
        for (i, link) in chain.links.iter().enumerate() {
            let (joint, before) = (link.joint(state, i), link.fixed.pass(&motion));
            motion = joint.pass(&before);
            self.steps.push(Step { joint, before, behind: motion });
        }
        let tip = chain.tip.pass(&motion);
        (self.sensor, self.mount) = mount.sensitivity(&tip);

        let mut gain = self.mount.gain.before_turn(&chain.tip.c).before_shift(&chain.tip.rho, &motion);
        for (i, (step, link)) in self.steps.iter().zip(&chain.links).enumerate().rev() {
            let [of_position, of_velocity, of_acceleration] = step.joint.derivatives(&gain, &step.behind);
            self.positions.set_column(i, &of_position);
            self.velocities.set_column(i, &of_velocity);
            self.accelerations.set_column(i, &of_acceleration);

            gain = step.joint.pass_back(&gain, &step.before);
            let of_translation =
                gain.sensor_from_frame * step.before.force_gradient() * link.turn.transpose();
            let [of_force, of_rate] = gain.of_turn(&step.before).map(|of| of * link.jacobian);
            let first = i * ChainCorrections::GEOMETRY_PER_JOINT;
            self.geometry.fixed_view_mut::<3, 3>(0, first).copy_from(&of_translation);
            self.geometry.fixed_view_mut::<3, 3>(0, first + 3).copy_from(&of_force);
            self.geometry.fixed_view_mut::<3, 3>(3, first + 3).copy_from(&of_rate);

            let parent = if i == 0 { base } else { &self.steps[i - 1].behind };
            gain = gain.before_turn(&link.fixed.c).before_shift(&link.fixed.rho, parent);
        }
        self.base = gain;
    }
}

#[cfg(test)]
mod tests {
    use super::super::chains_for_tests::{Numbers, corrections_of, mixed_chain};
    use super::*;
    use nalgebra::{UnitQuaternion, Vector6};

    struct Case {
        chain: super::super::KinematicChain,
        corrections: ChainCorrections,
        joints: [Vec<f64>; 3],
        base: FrameMotion,
        mount: SensorMount,
    }

    impl Case {
        fn new(joints: usize, seed: u64) -> Self {
            let mut numbers = Numbers(seed);
            let chain = mixed_chain(joints, &mut numbers);
            let corrections = corrections_of(joints, 0.3, &mut numbers);
            let state = [2.0, 3.0, 8.0].map(|size| (0..joints).map(|_| numbers.next(size)).collect());
            let base = FrameMotion {
                specific_force: numbers.vector(10.0),
                rate: numbers.vector(0.5),
                angular_acceleration: numbers.vector(0.5),
            };
            let tip_from_sensor = UnitQuaternion::from_scaled_axis(numbers.vector(2.0));
            let mount = SensorMount { lever_m: numbers.vector(0.3), tip_from_sensor };
            Self { chain, corrections, joints: state, base, mount }
        }

        fn state(&self) -> JointState<'_> {
            let [positions, velocities, accelerations] = &self.joints;
            JointState { positions, velocities, accelerations }
        }

        fn reading(&self) -> Vector6<f64> {
            let tip = self.chain.corrected(&self.corrections).tip_motion(self.state(), &self.base);
            let FrameMotion { specific_force: f, rate: w, .. } = self.mount.motion(&tip);
            Vector6::new(f.x, f.y, f.z, w.x, w.y, w.z)
        }

        /// Compares a column with the central difference for a change of the case by `±h`.
        fn check(&mut self, what: &str, column: &Vector6<f64>, change: impl Fn(&mut Self, f64)) {
            let h = 1e-4;
            let mut at = |step: f64| {
                change(self, step);
                let reading = self.reading();
                change(self, -step);
                reading
            };
            // the error of the fourth-order difference is below 1e-9 here
            let near = (at(h) - at(-h)) / (2.0 * h);
            let far = (at(2.0 * h) - at(-2.0 * h)) / (4.0 * h);
            let difference = (near * 4.0 - far) / 3.0;
            let error = (difference - column).norm();
            assert!(error < 1e-7 * (1.0 + column.norm()), "{what}: {error}\n{difference}{column}");
        }
    }

    #[test]
    fn all_derivatives_are_those_of_differences() {
        for (joints, seed) in [(0, 1), (1, 2), (1, 3), (3, 4), (6, 5), (7, 6), (7, 7)] {
            let mut case = Case::new(joints, seed);
            let mut of = ChainSensitivity::new(joints);
            of.evaluate(&case.chain.corrected(&case.corrections), case.state(), &case.base, &case.mount);
            let FrameMotion { specific_force: f, rate: w, .. } = of.sensor;
            assert!((Vector6::new(f.x, f.y, f.z, w.x, w.y, w.z) - case.reading()).norm() < 1e-12);
            for i in 0..joints {
                for (k, columns) in [&of.positions, &of.velocities, &of.accelerations].into_iter().enumerate()
                {
                    let column: Vector6<f64> = columns.column(i).into();
                    case.check(&format!("state {k} of {i}"), &column, |case, h| case.joints[k][i] += h);
                }
                let column: Vector6<f64> = of.positions.column(i).into();
                case.check(&format!("zero {i}"), &column, |case, h| case.corrections.joints[i].zero += h);
                for k in 0..3 {
                    let column: Vector6<f64> = of.geometry.column(6 * i + k).into();
                    case.check(&format!("translation {i}"), &column, |case, h| {
                        case.corrections.joints[i].translation_m[k] += h;
                    });
                    let column: Vector6<f64> = of.geometry.column(6 * i + 3 + k).into();
                    case.check(&format!("rotation {i}"), &column, |case, h| {
                        case.corrections.joints[i].rotation_rad[k] += h;
                    });
                }
            }
            let base = of.base.matrix();
            for k in 0..3 {
                let column = of.gravity().column(k).into();
                case.check("gravity", &column, |case, h| case.base.specific_force[k] -= h);
                let column = base.column(3 + k).into();
                case.check("rate of the base", &column, |case, h| case.base.rate[k] += h);
                let column = base.column(6 + k).into();
                case.check("acceleration of the base", &column, |case, h| {
                    case.base.angular_acceleration[k] += h;
                });
                let column = of.mount.lever.column(k).into();
                case.check("lever", &column, |case, h| case.mount.lever_m[k] += h);
                let column = of.mount.mounting.column(k).into();
                case.check("mounting", &column, |case, h| {
                    let mut turn = Vector3::zeros();
                    turn[k] = h;
                    case.mount.tip_from_sensor *= UnitQuaternion::from_scaled_axis(turn);
                });
            }
        }
    }
}
