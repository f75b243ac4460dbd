//! What a sensor on the machine feels at one time, with its derivatives.

use crate::chain::ChainSensitivity;
use nalgebra::{Matrix3, Vector3, Vector6};

/// Specific force and rate at the sensor, in the sensor's frame, their change in time, and their derivatives.
///
/// A derivative has six entries: specific force, then rate.
#[derive(Debug, Clone)]
pub struct Felt {
    /// Specific force `f`, m/s².
    pub force: Vector3<f64>,
    /// Angular rate `w`, rad/s.
    pub rate: Vector3<f64>,
    /// `ḟ` and `ẇ`: the derivative with respect to a delay.
    pub change: Vector6<f64>,
    /// Derivatives with respect to the control points of the interval, then to the parameters of the machine: see [`MotionColumns`].
    pub columns: Vec<Vector6<f64>>,
    /// Derivatives along a chain: working memory.
    pub(super) chain: ChainSensitivity,
    /// Positions of the joints and three derivatives: working memory.
    pub(super) joints: [Vec<f64>; 4],
}

/// Where the derivatives stand in [`Felt::columns`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MotionColumns {
    /// Number of columns of the control points of an interval.
    pub controls: usize,
    /// Number of joints; none for poses.
    pub joints: usize,
}

impl MotionColumns {
    /// Lever arm, 3 columns, 1/m.
    #[must_use]
    pub fn lever(self) -> usize {
        self.controls
    }

    /// Mounting, 3 columns: `tip_from_sensor · exp(δ)`.
    #[must_use]
    pub fn mounting(self) -> usize {
        self.controls + 3
    }

    /// Gravity in the base frame, 3 columns.
    #[must_use]
    pub fn gravity(self) -> usize {
        self.controls + 6
    }

    /// Zero offsets of the joints, one column each.
    #[must_use]
    pub fn zeros(self) -> usize {
        self.controls + 9
    }

    /// Geometry of the joints, 6 columns each: translation, rotation.
    #[must_use]
    pub fn geometry(self) -> usize {
        self.zeros() + self.joints
    }

    /// Number of columns.
    #[must_use]
    pub fn number(self) -> usize {
        self.geometry() + 6 * self.joints
    }
}

impl Felt {
    /// Nothing felt yet.
    #[must_use]
    pub fn zeros(columns: MotionColumns) -> Self {
        Self {
            force: Vector3::zeros(),
            rate: Vector3::zeros(),
            change: Vector6::zeros(),
            columns: vec![Vector6::zeros(); columns.number()],
            chain: ChainSensitivity::new(columns.joints),
            joints: std::array::from_fn(|_| vec![0.0; columns.joints]),
        }
    }
}

/// Sets three columns: the force's part and the rate's.
pub(super) fn set(columns: &mut [Vector6<f64>], force: &Matrix3<f64>, rate: &Matrix3<f64>) {
    for (axis, column) in columns.iter_mut().take(3).enumerate() {
        column.fixed_rows_mut::<3>(0).copy_from(&force.column(axis));
        column.fixed_rows_mut::<3>(3).copy_from(&rate.column(axis));
    }
}
