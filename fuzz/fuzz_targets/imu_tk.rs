//! Fuzz target: imu_tk's .calib; see `convention`.
#![no_main]

#[path = "convention.rs"]
mod convention;

use calibrant::io::ImuFormat;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| convention::check(bytes, ImuFormat::ImuTk));
