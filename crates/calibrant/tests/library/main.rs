//! What the library promises, checked from outside: one binary, so that it is linked once.

mod architecture;
mod clock_skew;
mod common;
mod contradicted_inputs;
mod derivatives;
mod design;
mod earth_rate;
mod estimate;
mod files;
mod holds;
mod imu;
mod imu_recordings;
mod invariants;
mod known_faces;
mod large_rotation_errors;
mod mounting;
mod noise;
mod pipeline;
mod quantisation;
mod saturation;
mod sensor_change;
mod spikes;
mod statistics;
mod study;
mod temperature_terms;
mod validation;
