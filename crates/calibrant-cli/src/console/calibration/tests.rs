//! Tests of what is printed for a simulated IMU.

use super::of_calibration;
use calibrant::{estimate, motion, sensor};

#[path = "../../../../calibrant-report/examples/report_gallery/imus.rs"]
mod imus;

#[test]
fn it_says_what_was_used_what_was_found_and_how_good_it_is() {
    let case = imus::imu_case(14, 1);
    assert!(case.recording.gyroscope.is_some());
    let text = of_calibration(&case.calibration);
    let from = imus::DISTURBED + 1;
    for says in [
        "  14 holds, all used\n",
        &format!("  13 rotations, 12 used; not used: {from} → {}\n", from + 1),
        "  1 turn of known angle\n",
        "accelerometer.matrix.yz",
        "gyroscope.g_sensitivity.zz",
        "counts/(rad/s)",
        "(°/s)/g",
        "the rotation error is 0.0",
        "the error of the known turns is",
        "noise of a gyroscope sample ",
        " counts, from: scatter within holds",
        "converged after",
    ] {
        assert!(text.contains(says), "{says}\n{text}");
    }
    let known = text.lines().find(|line| line.contains("g_sensitivity.xx")).expect("there");
    assert!(known.ends_with(" %"), "{known}");
    assert!(text.lines().all(|line| line.chars().count() <= 120), "{text}");
}
