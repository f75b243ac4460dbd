//! Tests of the library from outside: one binary, so that it is linked once.

mod accelerometer_on_faces;
mod architecture;
mod batch;
mod best_poses;
mod bias_drift;
mod campaign;
mod clock_skew;
mod common;
mod comparison;
mod contradicted_inputs;
mod derivatives;
mod design;
mod diagnostics;
mod earth_rate;
mod estimate;
mod files;
#[cfg(feature = "study")]
mod gravity;
mod holds;
mod imu;
mod imu_recordings;
mod interpolated_log;
mod invariants;
mod json_files;
mod knocks;
mod known_faces;
mod large_rotation_errors;
mod machine;
mod mounting;
mod noise;
mod nominal_rate;
mod priors;
mod propagated;
mod quantisation;
mod rotation_scatter;
mod saturation;
mod sensor_change;
mod session;
mod session_in_memory;
mod spikes;
#[cfg(feature = "study")]
mod statistics;
#[cfg(feature = "study")]
mod study;
mod temperature_terms;
mod validation;
