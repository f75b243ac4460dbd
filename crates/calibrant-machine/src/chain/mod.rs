//! A chain of joints, and what a sensor on its last link feels: specific force and angular rate, with derivatives with respect to everything.
//!
//! # Formula
//! The motion of a frame, in its own axes, is its specific force `a = Rᵀ(p̈ − γ)`, its angular rate `ω` and its angular acceleration `ω̇`.
//! It passes from link to link (`luh1980`). A fixed transform with translation `ρ` and rotation `C` gives
//!
//! ```text
//! a' = Cᵀ(a + ω̇×ρ + ω×(ω×ρ))        ω' = Cᵀω               ω̇' = Cᵀω̇
//! ```
//!
//! a revolute joint about `u`, whose rotation is `C = exp(u q)`,
//!
//! ```text
//! a' = Cᵀa                          ω' = Cᵀω + u q̇         ω̇' = Cᵀω̇ + (Cᵀω)×u q̇ + u q̈
//! ```
//!
//! and a prismatic joint along `u`
//!
//! ```text
//! a' = a + ω̇×uq + ω×(ω×uq) + 2ω×uq̇ + u q̈        ω' = ω        ω̇' = ω̇
//! ```
//!
//! The sensor is one more fixed transform behind the tip. Its reading depends on the motion of any frame before it through the 6×9 matrix
//! `M = ∂(f, w)/∂(a, ω, ω̇)`. `M` starts at the sensor and goes back to the base, step by step; a parameter moves the motion of one frame by a
//! 9-vector, and `M` times that vector is its column. So the cost of all derivatives is a small multiple of that of the reading itself.

#[cfg(test)]
pub(crate) mod chains_for_tests;
mod frame_motion;
mod joint;
mod joint_motion;
mod kinematic_chain;
mod reach;
mod sensitivity;
mod sensor_mount;

pub use frame_motion::{FrameMotion, SensorGain};
pub use joint::{ChainCorrections, Joint, JointCorrection, JointKind, JointLimits, SpeedNearEnds};
pub use joint_motion::JointState;
pub use kinematic_chain::{CorrectedChain, KinematicChain, TipVelocity};
pub use reach::reach_m;
pub use sensitivity::ChainSensitivity;
pub use sensor_mount::{MountSensitivity, SensorMount};
