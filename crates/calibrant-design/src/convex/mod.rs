//! Convex programs and what solves them; no file here knows what a motion is good for.

mod active_set;
mod chain_factor;
mod chain_program;
mod conic_program;
mod eigenvalue_cone;

pub(crate) use active_set::{Active, ActiveSet, LinearRow, Side};
pub(crate) use chain_factor::{ChainFactor, Stage, StageWeight, Transition};
pub(crate) use chain_program::{Chain, ChainProgram, Form, StageRow, Stages};
pub(crate) use conic_program::{ConicProgram, Row, conditions};
pub(crate) use eigenvalue_cone::{AffineMatrix, Cone, ConeStep, Scaling, triangle};
