//! Tests of machines that carry a sensor.

mod estimator;
mod urdf;
mod urdf_broken;
