//! Fuzz target: a motion is refused with an error, or the quantities that follow from it are finite.
#![no_main]

use calibrant::io::parse_motion;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    for axes in [1, 3] {
        match parse_motion(bytes, axes) {
            Ok(motion) => {
                assert!(motion.times_s().windows(2).all(|pair| pair[0] < pair[1]));
                assert!(motion.displacement_m().iter().all(|place| place.iter().all(|value| value.is_finite())));
            }
            Err(error) => assert!(error.is_invalid_experiment() && !error.to_string().is_empty()),
        }
    }
});
