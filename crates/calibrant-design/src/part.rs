//! The problem of one part of a design: the axes that are designed together.

use super::admissible_region::Region;
use calibrant_core::information::{Criterion, PartInformation};
use nalgebra::{SMatrix, SVector};

/// The problem of one part: D axes that are designed together.
pub(super) struct Part<const D: usize, const P: usize> {
    pub(super) information: PartInformation<D, P>,
    pub(super) regions: [Region; D],
    pub(super) criterion: Criterion,
    /// Information that is there already.
    pub(super) prior: SMatrix<f64, P, P>,
    /// An admissible motion, and its relative distance from every limit.
    pub(super) inside: Vec<SVector<f64, D>>,
    pub(super) slack: f64,
}

/// The nodes of a motion on D axes.
pub(super) type Nodes<const D: usize> = Vec<SVector<f64, D>>;
