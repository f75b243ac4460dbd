//! Fuzz target: an experiment file is refused with an error that points at it, or gives finite numbers.
#![no_main]

use calibrant::io::{Experiment, Plan};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    match Experiment::parse(text, None) {
        Ok(experiment) => {
            let sensor = &experiment.sensor;
            let numbers = [sensor.gain, sensor.offset, sensor.noise_mps2, sensor.bias_sd_mps2, sensor.scale_sd];
            assert!(numbers.iter().flatten().all(|vector| vector.iter().all(|number| number.is_finite())));
            match experiment.plan {
                Plan::Motion(plan) => assert!(plan.interval_s > 0.0 && plan.rate_hz.is_finite() && plan.intervals > 0),
                Plan::Holds(plan) => {
                    let gravity = plan.gravity().expect("checked");
                    assert!(gravity.magnitude_mps2 > 0.0 && gravity.sd_mps2 >= 0.0);
                }
                Plan::Machine(plan) => {
                    let setup = plan.setup(sensor, experiment.imu.as_ref(), 2).expect("checked");
                    assert!(setup.gravity_mps2 > 0.0 && setup.lever_sd_m >= 0.0 && setup.up.norm() > 0.9);
                }
            }
        }
        Err(error) => {
            assert!(error.is_invalid_experiment());
            let input_error = error.input_error().expect("a complaint");
            assert!(!input_error.message.is_empty() && input_error.line >= Some(1) && input_error.column >= Some(1));
            if let Some((excerpt, range)) = &input_error.excerpt {
                assert!(excerpt.get(range.clone()).is_some(), "the range is within the excerpt");
            }
        }
    }
});
