//! Fuzz target: a trajectory, without a header or with a comment in place of one, is refused with an error, or
//! its poses are whole.
#![no_main]

use calibrant::io::{ReferenceFormat, ReferenceLogOptions, parse_reference_log};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let options = ReferenceLogOptions::default();
    // most of what follows a right row is read as rows
    let with_row = [b"# timestamp tx ty tz qx qy qz qw\n0.5 1 2 3 0 0 0 1\n", bytes].concat();
    for text in [bytes, &with_row] {
        match parse_reference_log(text, &options) {
            Ok(file) => {
                let Some(log) = file.poses() else { continue };
                assert!(file.format != ReferenceFormat::Joints && log.times_s.len() >= 2);
                assert!(log.times_s.windows(2).all(|pair| pair[0] <= pair[1]));
                assert!(log.positions_m.iter().flatten().all(|p| p.iter().all(|value| value.is_finite())));
                assert!(log.world_from_body.iter().flatten().all(|q| (q.norm() - 1.0).abs() < 1e-9));
            }
            Err(error) => assert!(error.is_invalid_recording() && !error.to_string().is_empty()),
        }
    }
});
