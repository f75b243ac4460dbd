//! Fuzz target: a mesh is refused with an error that says why, or gives the finite vertices of whole triangles, and a capsule around them.
#![no_main]

use calibrant::io::parse_stl;
use calibrant::machine_design::world::{Shape, capsule_around};
use libfuzzer_sys::fuzz_target;
use nalgebra::Isometry3;

fuzz_target!(|bytes: &[u8]| match parse_stl(bytes) {
    Ok(vertices) => {
        assert!(!vertices.is_empty() && vertices.len() % 3 == 0);
        assert!(vertices.iter().all(|vertex| vertex.iter().all(|number| number.is_finite())));
        if vertices.iter().all(|vertex| vertex.amax() < 1e3) {
            let capsule = capsule_around(&Shape::Points(vertices), &Isometry3::identity()).expect("it has points");
            assert!(capsule.radius_m.is_finite());
        }
    }
    Err(error) => {
        let input_error = error.input_error().expect("an input error");
        assert!(error.is_invalid_experiment() && !input_error.message.is_empty());
    }
});
