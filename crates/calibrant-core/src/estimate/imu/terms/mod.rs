//! The terms of the least squares: one file each, and their sums. Each file has the formula of its residual.
//!
//! A further term is a file that implements [`Term`](term::Term), and a line of the [list](list::TERMS).

mod hold_force;
mod hold_rate;
mod known;
pub(crate) mod list;
pub(crate) mod rotation;
pub(crate) mod sums;
pub(crate) mod term;
#[cfg(test)]
mod tests;
pub(crate) mod turn;
