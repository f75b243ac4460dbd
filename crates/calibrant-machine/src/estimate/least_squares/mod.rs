//! The least-squares problem, its normal equations, and the steps that solve it.

mod block;
#[cfg(test)]
mod derivative_tests;
mod equations;
mod front;
mod gauss_newton;
mod log_equations;
mod model;
mod moments;
mod sample_rows;

pub(crate) use block::{Block, block_s};
pub(crate) use equations::{Equations, Places};
pub(crate) use front::{Front, Scaled, Solved};
pub(crate) use gauss_newton::{Minimum, equations_at, minimise, stepped};
pub(crate) use log_equations::WeighedLog;
pub(crate) use model::{Model, Pass, Residual, State, Stream, white_noise};
pub(crate) use moments::{Moments, huber};
pub(crate) use sample_rows::{RowWriter, Sample, predicted};
