//! Fuzz target: a log of joints or poses in any text format is refused with an error, or its times do not
//! decrease and nothing in it is infinite.
#![no_main]

use calibrant::io::{ReferenceLogOptions, TimeUnit, parse_reference_log};
use calibrant::machine::log::ReferenceLog;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for time_unit in [None, Some(TimeUnit::Millisecond), Some(TimeUnit::Nanosecond)] {
        match parse_reference_log(bytes, &ReferenceLogOptions { time_unit, ..ReferenceLogOptions::default() }) {
            Ok(file) => {
                let times_s = file.log.times_s();
                assert!(times_s.len() >= 2 && times_s.iter().all(|t| t.is_finite()));
                assert!(times_s.windows(2).all(|pair| pair[0] <= pair[1]));
                match &file.log {
                    ReferenceLog::Joints(log) => {
                        let values = log.positions.iter().chain(log.velocities.iter().flatten());
                        assert!(values.clone().all(|value| !value.is_infinite()));
                        assert_eq!(log.positions.len(), times_s.len() * log.names.len());
                        let reversed: Vec<&str> = log.names.iter().rev().map(String::as_str).collect();
                        assert!(file.joints_in_order(&reversed).is_ok());
                    }
                    ReferenceLog::Poses(log) => {
                        assert!(log.positions_m.iter().flatten().all(|p| p.iter().all(|value| value.is_finite())));
                        assert!(log.world_from_body.iter().flatten().all(|q| (q.norm() - 1.0).abs() < 1e-9));
                        assert!(log.positions_m.len() == times_s.len() && log.world_from_body.len() == times_s.len());
                    }
                }
            }
            Err(error) => assert!(error.is_invalid_recording() && !error.to_string().is_empty()),
        }
    }
});
