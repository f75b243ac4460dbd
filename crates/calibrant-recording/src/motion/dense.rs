//! Writes `motion_dense.csv`: a motion at a constant rate, for the arm's controller.

use crate::text::numbers::write_numbers;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::motion::{JerkControlledMotion, sample_times};
use std::iter::once;
use std::path::Path;

/// Number of rows that are computed at once.
const BATCH: usize = 4096;

/// Writes time, position, velocity, acceleration and jerk of a motion at `rate_hz`. They are exact
/// polynomials between the nodes, not an interpolation of samples. Position and velocity count from rest at
/// the origin.
///
/// Columns: `t_s`, then for each axis `px_m`, `vx_mps`, `ax_mps2`, `jx_mps3`. The start is the first row; the end is the last where the rate fits the duration.
///
/// # Errors
/// [`Error::Experiment`] for a rate that is not above 0. [`Error::Output`] where the file cannot be written.
pub fn write_dense_motion(
    path: &Path,
    motion: &JerkControlledMotion,
    axes: usize,
    rate_hz: f64,
) -> Result<()> {
    if !(rate_hz.is_finite() && rate_hz > 0.0) {
        let message = format!("a sample rate of {rate_hz:?} Hz makes no sense");
        return Err(Error::experiment(InputError::new(Refusal::ValueInvalid, message, "a number above 0")));
    }
    let letters = &["x", "y", "z"][..axes.clamp(1, 3)];
    let times = sample_times(motion, rate_hz);
    let header: String = letters
        .iter()
        .map(|letter| format!(",p{letter}_m,v{letter}_mps,a{letter}_mps2,j{letter}_mps3"))
        .collect();
    let states = times.chunks(BATCH).flat_map(|batch| batch.iter().zip(motion.states_at(batch)));
    let rows = states.map(|(t, state)| {
        let of_axis = move |axis: usize| {
            let (p, v) = (state.displacement_m[axis], state.velocity_mps[axis]);
            [p, v, state.acceleration_mps2[axis], state.jerk_mps3[axis]]
        };
        once(*t).chain((0..letters.len()).flat_map(of_axis))
    });
    write_numbers(path, &format!("t_s{header}"), rows)
}
