//! The motion of a recording: commanded, or logged by the machine.

use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::motion::JerkControlledMotion;
use calibrant_io::{HashedFile, ReferenceLogFile, ReferenceLogOptions, read_motion, read_reference_log};
use calibrant_machine::log::ReferenceLog;
use std::path::{Path, PathBuf};

/// The motion of a recording: in a file, or in memory.
#[derive(Debug, Clone, PartialEq)]
pub enum MotionSource {
    /// A file: nodes of a commanded motion, or a log of joints or poses, as the experiment needs.
    File(PathBuf),
    /// A commanded motion.
    Commanded(JerkControlledMotion),
    /// A log of a machine's motion.
    Logged(ReferenceLog),
    /// A log of a machine that moved on cubic splines with knots at this distance, s.
    OnKnots(ReferenceLog, f64),
}

impl MotionSource {
    /// The path of the file, or what errors and results call it.
    #[must_use]
    pub fn path(&self) -> &Path {
        match self {
            Self::File(path) => path,
            Self::Commanded(_) => Path::new("motion"),
            Self::Logged(_) | Self::OnKnots(..) => Path::new("log"),
        }
    }

    /// The commanded motion.
    pub(crate) fn commanded(&self, axes: usize) -> Result<JerkControlledMotion> {
        match self {
            Self::File(path) => read_motion(path, axes),
            Self::Commanded(motion) => Ok(motion.clone()),
            Self::Logged(_) | Self::OnKnots(..) => Err(Error::experiment(InputError::new(
                Refusal::ExperimentUnsuited,
                "a log of a machine is given as the commanded motion of a [motion] experiment",
                "give the nodes of the commanded motion, or describe the machine in [machine]",
            ))),
        }
    }

    /// The log of a machine.
    pub(crate) fn logged(&self, options: &ReferenceLogOptions) -> Result<ReferenceLogFile> {
        match self {
            Self::File(path) => read_reference_log(path, options),
            Self::Logged(log) => ReferenceLogFile::of_log(log.clone()),
            Self::OnKnots(log, knot_step_s) => ReferenceLogFile::on_knots(log.clone(), *knot_step_s),
            Self::Commanded(_) => Err(Error::experiment(InputError::new(
                Refusal::ExperimentUnsuited,
                "a commanded motion is given in place of the log of a machine",
                "give joints or poses, as the machine logged them",
            ))),
        }
    }

    /// What it is, by its content.
    pub(crate) fn hashed(&self) -> Option<HashedFile> {
        match self {
            Self::File(path) => HashedFile::of(path),
            Self::Commanded(motion) => {
                let nodes = motion.acceleration_mps2().iter().flat_map(|node| [node.x, node.y, node.z]);
                let lists = [("t_s", motion.times_s().to_vec()), ("a_mps2", nodes.collect())];
                Some(HashedFile::of_numbers("motion", &lists))
            }
            Self::Logged(log) | Self::OnKnots(log, _) => {
                let log = ReferenceLogFile::of_log(log.clone()).ok()?;
                Some(HashedFile { file: "log".into(), sha256: log.sha256 })
            }
        }
    }
}

impl<P: Into<PathBuf>> From<P> for MotionSource {
    fn from(path: P) -> Self {
        Self::File(path.into())
    }
}
