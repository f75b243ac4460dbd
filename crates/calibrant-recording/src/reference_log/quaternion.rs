//! The unit quaternion of four numbers that a file gives for one.

use nalgebra::{Quaternion, UnitQuaternion};

/// Largest difference of the norm from 1 that two decimals make: half a unit of the last one in each of four values.
pub(super) const ROUNDED: f64 = 0.01;
/// The same of one decimal: more is no quaternion.
const OFF: f64 = 0.1;

/// The orientation, and how far the norm is from 1. The error is what is wrong with the norm.
pub(super) fn of_quaternion([w, x, y, z]: [f64; 4]) -> Result<(UnitQuaternion<f64>, f64), String> {
    let quaternion = Quaternion::new(w, x, y, z);
    let norm = quaternion.norm();
    let off = (norm - 1.0).abs();
    if off > OFF {
        return Err(format!("the norm of the quaternion is {norm:.4}, not 1"));
    }
    Ok((UnitQuaternion::from_quaternion(quaternion), off))
}

#[cfg(test)]
mod tests {
    use super::super::options::ReferenceLogOptions;
    use super::super::read::parse_reference_log;

    #[test]
    fn a_norm_that_is_two_per_cent_off_is_said_and_mended() {
        let text = "t_s,qw,qx,qy,qz\n0,1.02,0,0,0\n1,0.6,0.8,0,0\n";
        let file = parse_reference_log(text.as_bytes(), &ReferenceLogOptions::default()).expect("a log");
        let poses = file.poses().expect("of poses");
        assert_eq!(poses.world_from_body[0].map(|of| of.w), Some(1.0));
        assert_eq!(file.findings[0].code().name(), "quaternion-norm");
        let broken = text.replace("1.02", "1.2");
        assert!(parse_reference_log(broken.as_bytes(), &ReferenceLogOptions::default()).is_err());
    }
}
