//! The best trajectory of a kinematic chain for calibrating the inertial sensor that it carries.

pub mod world;
