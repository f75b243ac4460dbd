//! Chains for the tests.

use crate::{Dwells, JointLimit, TrajectoryCriterion, TrajectoryNoise, TrajectoryProblem};
use calibrant_core::sensor::{Axis, ImuQuantity, Quantity, SensorKind};
use calibrant_machine::chain::{Joint, JointKind, JointLimits, KinematicChain};
use calibrant_machine::estimate::{MachineSetup, MountingPrior};
use nalgebra::{Isometry3, Unit, UnitQuaternion, Vector3};
use std::sync::OnceLock;

/// Numbers without a pattern (splitmix64).
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    /// A number from `-size` to `size`.
    pub(crate) fn next(&mut self, size: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        size * (2.0 * ((z ^ (z >> 31)) as f64 / u64::MAX as f64) - 1.0)
    }

    /// A vector with such components.
    pub(crate) fn vector(&mut self, size: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.next(size))
    }
}

fn joint(name: String, kind: JointKind, axis: Vector3<f64>, origin: Isometry3<f64>) -> Joint {
    Joint { name, kind, axis: Unit::new_normalize(axis), origin, limits: JointLimits::default() }
}

/// Joints that turn and slide, with axes and transforms in all directions.
pub(crate) fn arm_of_all_kinds(joints: usize, numbers: &mut Numbers) -> KinematicChain {
    let kinds = [JointKind::Revolute, JointKind::Prismatic, JointKind::Continuous];
    let one = |k: usize, numbers: &mut Numbers| {
        let origin = Isometry3::new(numbers.vector(0.4), numbers.vector(2.0));
        joint(format!("joint_{k}"), kinds[k % 3], numbers.vector(1.0), origin)
    };
    let joints = (0..joints).map(|k| one(k, numbers)).collect();
    let tip_transform = Isometry3::new(numbers.vector(0.1), numbers.vector(1.0));
    KinematicChain { base: "base".into(), tip: "tip".into(), joints, tip_transform }
}

/// All 24 parameters of two full sensors.
pub(crate) fn full_quantities() -> Vec<ImuQuantity> {
    let mut all = Vec::new();
    for kind in SensorKind::ALL {
        for row in Axis::ALL {
            all.push(ImuQuantity::Of(kind, Quantity::Bias(row)));
            all.extend(Axis::ALL.map(|column| {
                let of_matrix =
                    if row == column { Quantity::Scale(row) } else { Quantity::CrossAxis(row, column) };
                ImuQuantity::Of(kind, of_matrix)
            }));
        }
    }
    all
}

fn setup() -> MachineSetup {
    MachineSetup {
        lever_m: Vector3::new(0.01, -0.02, 0.03),
        tip_from_sensor: UnitQuaternion::from_scaled_axis(Vector3::new(0.3, -0.2, 0.5)),
        gravity_sd_mps2: 1e-3,
        mounting: MountingPrior::Within(0.01),
        ..MachineSetup::default()
    }
}

/// A problem on a chain, with priors on everything.
pub(crate) fn problem_of(chain: &KinematicChain) -> TrajectoryProblem<'_> {
    static KNOWN: OnceLock<(MachineSetup, Vec<ImuQuantity>)> = OnceLock::new();
    let (setup, quantities) = KNOWN.get_or_init(|| (setup(), full_quantities()));
    let limit =
        JointLimit { lower: -3.0, upper: 3.0, velocity: 3.0, acceleration: 5.0, jerk: 50.0, near_ends: None };
    TrajectoryProblem {
        chain,
        setup,
        quantities,
        noise: TrajectoryNoise { force_density: Some(1.7e-3), rate_density: Some(2.4e-4), moving: 2.0 },
        cross_axis_sd: [0.0; 2],
        joints: vec![limit; chain.joints.len()],
        force_range_mps2: Vector3::repeat(39.0),
        rate_range_radps: Vector3::repeat(17.0),
        tip_speed_mps: None,
        sensor_body: None,
        surroundings: None,
        clearance_m: 0.005,
        duration_s: 6.0,
        knot_s: 0.5,
        home: None,
        criterion: TrajectoryCriterion::D,
        dwells: Dwells::None,
    }
}
