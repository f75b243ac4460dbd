//! Motions and poses as CSV.

pub(crate) mod commanded;
pub(crate) mod dense;
pub(crate) mod poses;
