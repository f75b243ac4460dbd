//! The unit quaternion of four numbers that a file gives for one.

use nalgebra::{Quaternion, UnitQuaternion};

/// Largest difference of the norm from 1: more is not the rounding of a unit quaternion.
const OFF: f64 = 0.01;

/// The orientation; `None` where a value is missing. The error is what is wrong with the norm.
pub(super) fn orientation([w, x, y, z]: [f64; 4]) -> Result<Option<UnitQuaternion<f64>>, String> {
    if [w, x, y, z].iter().any(|value| value.is_nan()) {
        return Ok(None);
    }
    let quaternion = Quaternion::new(w, x, y, z);
    let norm = quaternion.norm();
    if norm == 0.0 {
        return Err("0, 0, 0, 0 is no orientation: the norm of a quaternion is 1".into());
    }
    if (norm - 1.0).abs() > OFF {
        return Err(format!("the norm of the quaternion is {norm:.4}, not 1"));
    }
    Ok(Some(UnitQuaternion::from_quaternion(quaternion)))
}
