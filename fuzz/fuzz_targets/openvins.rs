//! Fuzz target: OpenVINS' kalibr_imu_chain.yaml; see `convention`.
#![no_main]

#[path = "convention.rs"]
mod convention;

use calibrant::io::ImuFormat;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| convention::check(bytes, ImuFormat::OpenVins));
