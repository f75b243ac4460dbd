//! The motion of a recording: commanded, or logged by a machine; in a file or in arrays.

use crate::arrays::{Numbers, as_array, as_table, list, vectors};
use crate::failure::{invalid, raised};
use crate::work::at_once;
use calibrant::io::{write_dense_motion, write_motion};
use calibrant::machine::log::{JointLog, PoseLog, ReferenceLog};
use calibrant::motion::JerkControlledMotion;
use calibrant::session::MotionSource;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use pyo3::prelude::*;
use std::path::PathBuf;

/// A motion.
#[pyclass(frozen)]
#[derive(Clone)]
pub(crate) struct Motion(pub(crate) MotionSource);

/// Times and values of a commanded motion.
pub(crate) type Nodes<'py> = (Numbers<'py>, Numbers<'py>);

/// The nodes of a commanded motion.
pub(crate) fn nodes<'py>(py: Python<'py>, motion: &JerkControlledMotion) -> Nodes<'py> {
    (as_array(py, motion.times_s()), as_table(py, motion.acceleration_mps2()))
}

/// The log of a machine: its kind, names of joints, times, and tables.
pub(crate) type Log<'py> = (&'static str, Vec<String>, Numbers<'py>, Numbers<'py>, Option<Numbers<'py>>);

/// The log of a machine as arrays.
pub(crate) fn log<'py>(py: Python<'py>, log: &ReferenceLog) -> Log<'py> {
    match log {
        ReferenceLog::Joints(JointLog { names, times_s, positions, velocities }) => {
            let velocities = velocities.as_ref().map(|of| as_array(py, of));
            ("joints", names.clone(), as_array(py, times_s), as_array(py, positions), velocities)
        }
        ReferenceLog::Poses(PoseLog { times_s, positions_m, world_from_body }) => {
            let unseen = Vector3::repeat(f64::NAN);
            let places: Vec<_> = positions_m.iter().map(|at| at.unwrap_or(unseen)).collect();
            let turns = world_from_body.iter();
            let turns = turns.flat_map(|of| of.as_ref().map_or([f64::NAN; 4], |of| [of.w, of.i, of.j, of.k]));
            let turns = as_array(py, &turns.collect::<Vec<_>>());
            ("poses", Vec::new(), as_array(py, times_s), as_table(py, &places), Some(turns))
        }
    }
}

#[pymethods]
impl Motion {
    #[staticmethod]
    fn file(path: PathBuf) -> Self {
        Self(MotionSource::File(path))
    }

    #[staticmethod]
    fn commanded(py: Python<'_>, times_s: &[u8], acceleration_mps2: &[u8]) -> PyResult<Self> {
        let motion = at_once(py, || JerkControlledMotion::new(list(times_s), vectors(acceleration_mps2)))?;
        Ok(Self(MotionSource::Commanded(motion)))
    }

    #[staticmethod]
    #[pyo3(signature = (names, times_s, positions, velocities=None, knot_step_s=None))]
    fn joints(
        names: Vec<String>,
        times_s: &[u8],
        positions: &[u8],
        velocities: Option<&[u8]>,
        knot_step_s: Option<f64>,
    ) -> Self {
        let log = ReferenceLog::Joints(JointLog {
            names,
            times_s: list(times_s),
            positions: list(positions),
            velocities: velocities.map(list),
        });
        Self(match knot_step_s {
            Some(step_s) => MotionSource::OnKnots(log, step_s),
            None => MotionSource::Logged(log),
        })
    }

    /// What is not a number was not seen.
    #[staticmethod]
    fn poses(times_s: &[u8], positions_m: &[u8], quaternions_wxyz: &[u8]) -> Self {
        let is_seen = |at: &Vector3<f64>| at.iter().all(|value| value.is_finite());
        let turn = |[w, x, y, z]: &[f64; 4]| {
            UnitQuaternion::try_new(Quaternion::new(*w, *x, *y, *z), 1e-9)
                .filter(|turn| turn.coords.iter().all(|value| value.is_finite()))
        };
        let turns = list(quaternions_wxyz);
        Self(MotionSource::Logged(ReferenceLog::Poses(PoseLog {
            times_s: list(times_s),
            positions_m: vectors(positions_m).into_iter().map(|at| is_seen(&at).then_some(at)).collect(),
            world_from_body: turns.as_chunks::<4>().0.iter().map(turn).collect(),
        })))
    }

    /// Writes a commanded motion: its nodes, or samples at a rate.
    #[pyo3(signature = (path, axes, rate_hz=None))]
    fn write(&self, py: Python<'_>, path: PathBuf, axes: usize, rate_hz: Option<f64>) -> PyResult<()> {
        let motion = self.nodes(py)?;
        let written = match rate_hz {
            Some(rate_hz) if rate_hz.is_finite() && rate_hz > 0.0 => {
                write_dense_motion(&path, motion, axes, rate_hz)
            }
            Some(rate_hz) => Err(invalid(format!("`rate_hz` is {rate_hz}"), "give a number above 0")),
            None => write_motion(&path, motion, axes),
        };
        written.map_err(|error| raised(py, &error))
    }

    /// Velocity in m/s and displacement in m at each node, from rest.
    fn states<'py>(&self, py: Python<'py>) -> PyResult<Nodes<'py>> {
        let motion = self.nodes(py)?;
        let states = || Ok((motion.velocity_mps(), motion.displacement_m()));
        let (velocity_mps, displacement_m) = at_once(py, states)?;
        Ok((as_table(py, &velocity_mps), as_table(py, &displacement_m)))
    }
}

impl Motion {
    fn nodes(&self, py: Python<'_>) -> PyResult<&JerkControlledMotion> {
        match &self.0 {
            MotionSource::Commanded(motion) => Ok(motion),
            _ => Err(raised(py, &invalid("this is no commanded motion", "give its nodes"))),
        }
    }
}
