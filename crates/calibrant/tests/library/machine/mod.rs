//! Tests of machines that carry a sensor.

mod urdf;
mod urdf_broken;
