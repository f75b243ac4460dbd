//! What the library promises, checked from outside: one binary, so that it is linked once.

mod architecture;
mod change;
mod clocks;
mod common;
mod derivatives;
mod design;
mod earth;
mod estimate;
mod faces;
mod files;
mod given;
mod holds;
mod imu;
mod imu_recordings;
mod invariants;
mod noise;
mod resolution;
mod saturation;
mod sparks;
mod statistics;
mod study;
mod thermal;
mod tilted;
mod upside_down;
mod validation;
