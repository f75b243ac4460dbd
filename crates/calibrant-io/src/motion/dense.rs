//! Writes `motion_dense.csv`: a motion at a constant rate, for the arm's controller.

use crate::files::atomic_output::write_atomically;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::motion::{JerkControlledMotion, sample_times};
use nalgebra::Vector3;
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
    write_atomically(path, |out| {
        write!(out, "t_s")?;
        for letter in letters {
            write!(out, ",p{letter}_m,v{letter}_mps,a{letter}_mps2,j{letter}_mps3")?;
        }
        writeln!(out)?;
        for batch in times.chunks(BATCH) {
            for (t, state) in batch.iter().zip(motion.states_at(batch)) {
                write!(out, "{t:?}")?;
                for axis in 0..letters.len() {
                    let of = |v: &Vector3<f64>| v[axis];
                    let (p, v) = (of(&state.displacement_m), of(&state.velocity_mps));
                    let (a, u) = (of(&state.acceleration_mps2), of(&state.jerk_mps3));
                    write!(out, ",{p:?},{v:?},{a:?},{u:?}")?;
                }
                writeln!(out)?;
            }
        }
        Ok(())
    })
}
