//! Errors that opposite faces share: a box off square, a frame that is turned.
//!
//! With directions `u` met as `f = g (1 + E) u`, the readings are those of the sensor `S (1 + E)` in directions without errors. So the six terms of `E` beside
//! its diagonal are cross-axis terms that no scatter of faces shows: three turn the frame, three are the angles of the box. They are unknown, with the standard
//! deviation `q` of the shared errors. Along a face only `1 − θ²/2` acts: `q²` in the mean for two axes, and as much in standard deviation. Where directions
//! other than faces determine more, the fit follows `E` less.

use crate::error::Result;
use crate::estimate::imu::model::{Fit, ImuModel, singular};
use nalgebra::{DVector, Vector3};

/// One standard deviation of one term of `E`.
#[derive(Debug, Clone, Copy)]
struct SharedError {
    row: usize,
    column: usize,
    size: f64,
}

impl SharedError {
    /// All terms, for shared errors of this standard deviation, rad about each axis.
    fn all(shared_rad: f64) -> impl Iterator<Item = Self> {
        let across = shared_rad;
        let along = std::f64::consts::SQRT_2 * shared_rad * shared_rad;
        (0..9).map(move |k| {
            let (row, column) = (k / 3, k % 3);
            Self { row, column, size: if row == column { along } else { across } }
        })
    }

    /// By how much it moves a vector along a direction that was met.
    fn of(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        let by = Vector3::ith(self.row, self.size * vector[self.column]);
        if self.row == self.column {
            return by;
        }
        by - vector * (vector.dot(&by) / vector.norm_squared().max(f64::MIN_POSITIVE))
    }
}

/// By how much the estimates change with one standard deviation of each term: a step with other directions of faces and turns.
pub(crate) fn shared_face_errors(
    model: &ImuModel<'_>,
    fit: &Fit,
    shared_rad: f64,
) -> Result<Vec<DVector<f64>>> {
    let rest = model.step(&fit.state, &fit.residuals).ok_or_else(singular)?;
    let of = |error: SharedError| {
        let (mut moved, mut state) = (model.clone(), fit.state.clone());
        for (hold, force) in moved.holds.iter_mut().zip(&mut state.forces) {
            *force += error.of(force);
            hold.known = hold.known.map(|_| *force);
        }
        for turn in &mut moved.turns {
            turn.angle += error.of(&turn.angle);
        }
        let residuals = moved.gravity_residuals(&state).ok_or_else(singular)?;
        Ok(moved.step(&state, &residuals).ok_or_else(singular)? - &rest)
    };
    SharedError::all(shared_rad).map(of).collect()
}
