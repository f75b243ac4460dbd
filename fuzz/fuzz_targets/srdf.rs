//! Fuzz target: an SRDF file is refused with an error that points at it, or gives pairs of links.
#![no_main]

use calibrant::io::parse_srdf;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| match parse_srdf(bytes) {
    Ok(pairs) => assert!(pairs.iter().flatten().all(|link| !link.is_empty())),
    Err(error) => {
        let input_error = error.input_error().expect("an input error");
        assert!(error.is_invalid_experiment() && !input_error.message.is_empty());
        if let Some((excerpt, range)) = &input_error.excerpt {
            assert!(excerpt.get(range.clone()).is_some(), "the range is within the excerpt");
        }
    }
});
