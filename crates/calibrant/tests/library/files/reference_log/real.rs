//! Tests on logs that nobody here made.

use crate::common::shared_data;
use calibrant::io::{ReferenceFormat, ReferenceLogOptions, read_reference_log};

#[test]
fn both_references_of_broad_are_read() {
    for (trial, samples, unseen_s) in [
        ("broad_21_undisturbed_fast_combined", 53_612, 4.8),
        ("broad_03_undisturbed_slow_rotation_C", 58_412, 10.86),
    ] {
        let Some(path) = shared_data(&format!("broad-mocap/{trial}/ref_285hz_as_published.csv")) else {
            return;
        };
        let file = read_reference_log(&path, &ReferenceLogOptions::default()).expect("read");
        assert_eq!((file.format, file.rows), (ReferenceFormat::Poses, samples));
        let log = file.poses().expect("poses");
        let first = log.world_from_body.iter().position(Option::is_some).expect("seen");
        assert!((log.times_s[first] - unseen_s).abs() < 0.01, "{}", log.times_s[first]);
        assert!(log.positions_m[0].is_some(), "the position was seen before");
    }
}
