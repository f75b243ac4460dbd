//! Fuzz target: a URDF file is refused with an error that points at it, or gives chains that move finitely.
#![no_main]

use calibrant::io::{MachineFile, Urdf, missing_limits, to_json};
use calibrant::machine::chain::{FrameMotion, JointState};
use libfuzzer_sys::fuzz_target;
use nalgebra::Vector3;

fuzz_target!(|bytes: &[u8]| {
    let machine = match Urdf::parse(bytes) {
        Ok(machine) => machine,
        Err(error) => {
            let input_error = error.input_error().expect("an input error");
            assert!(error.is_invalid_experiment() && !input_error.message.is_empty());
            if let Some((excerpt, range)) = &input_error.excerpt {
                assert!(excerpt.get(range.clone()).is_some(), "the range is within the excerpt");
            }
            return;
        }
    };
    let links: Vec<&str> = machine.links().take(4).collect();
    let mut chains = vec![machine.chain(None, None)];
    chains.extend(links.iter().map(|tip| machine.chain(None, Some(tip))));
    chains.extend(links.iter().map(|base| machine.chain(Some(base), links.last().copied())));
    for chain in chains.into_iter().flatten() {
        let n = chain.joints.len();
        let (q, qd) = (vec![0.3; n], vec![1.0; n]);
        let state = JointState { positions: &q, velocities: &qd, accelerations: &qd };
        let tip = chain.nominal().tip_motion(state, &FrameMotion::at_rest(&Vector3::new(0.0, 0.0, -9.8)));
        let numbers = [tip.specific_force, tip.rate, tip.angular_acceleration];
        assert!(numbers.iter().all(|vector| vector.iter().all(|number| number.is_finite())));
        assert!(chain.joints.iter().all(|joint| missing_limits(joint).len() < 5));
        assert!(to_json(&MachineFile { machine: &machine, chain: &chain, meshes: &machine.missing_meshes(&[]) }).ends_with("}\n"));
    }
});
