//! Fuzz target: a joint_limits.yaml is refused with an error that says why, or gives limits that are finite and in order.
#![no_main]

use calibrant::io::parse_joint_limits;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| match parse_joint_limits(bytes) {
    Ok(joints) => {
        for limits in joints.values() {
            assert!(limits.position.is_none_or(|[lower, upper]| lower.is_finite() && upper.is_finite() && lower < upper));
            for limit in [limits.velocity, limits.acceleration, limits.jerk].into_iter().flatten() {
                assert!(limit.is_finite() && limit > 0.0);
            }
        }
    }
    Err(error) => {
        let input_error = error.input_error().expect("an input error");
        assert!(error.is_invalid_experiment() && !input_error.message.is_empty());
    }
});
