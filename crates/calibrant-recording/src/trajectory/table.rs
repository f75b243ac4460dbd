//! `trajectory.csv`: positions, velocities and accelerations of the joints at the knots.

use super::knots::{between_knots, spline_through_velocities};
use crate::reference_log::{ReferenceLogFile, ReferenceLogOptions, read_reference_log};
use crate::text::numbers::write_numbers;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_machine::chain::KinematicChain;
use calibrant_machine::log::{JointLog, ReferenceLog};
use calibrant_machine::spline::VectorSpline;
use std::iter::once;
use std::path::Path;

/// A cubic spline of the joints of a chain.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// Names of the joints.
    pub names: Vec<String>,
    /// Which of them turn.
    pub turns: Vec<bool>,
    /// Their positions, rad or m, by time.
    pub spline: VectorSpline,
}

impl Trajectory {
    /// A spline of the joints of this chain, in their order.
    #[must_use]
    pub fn of(chain: &KinematicChain, spline: VectorSpline) -> Self {
        Self {
            names: chain.joints.iter().map(|joint| joint.name.clone()).collect(),
            turns: chain.joints.iter().map(|joint| joint.kind.turns()).collect(),
            spline,
        }
    }

    /// The trajectory of the joints of this chain that has these positions and velocities at its knots.
    ///
    /// # Errors
    /// As [`read_trajectory`].
    pub fn at_knots(log: &JointLog, chain: &KinematicChain) -> Result<Self> {
        ReferenceLogFile::of_log(ReferenceLog::Joints(log.clone()))?;
        through(log, None, chain)
    }

    /// Its positions at and between the knots, as the log of a machine that follows it.
    #[must_use]
    pub fn log(&self) -> ReferenceLog {
        ReferenceLog::Joints(between_knots(&self.spline, self.names.clone()))
    }

    /// Times of the knots, s.
    pub(super) fn times_s(&self) -> impl Iterator<Item = f64> {
        let knots = self.spline.knots;
        (0..=knots.intervals).map(move |k| knots.knot_s(k))
    }
}

/// Writes the knots of a trajectory: `t_s`, then `NAME_rad`, `NAME_radps` and `NAME_radps2` of all joints (or `_m`, `_mps`, `_mps2`).
///
/// Numbers are written with the fewest digits that read back to the same bits.
///
/// # Errors
/// [`Error::Output`] where it cannot be written.
pub fn write_trajectory(path: &Path, trajectory: &Trajectory) -> Result<()> {
    let units = [["rad", "radps", "radps2"], ["m", "mps", "mps2"]];
    let of = |derivative: usize| {
        let joints = trajectory.names.iter().zip(&trajectory.turns);
        joints.map(move |(name, turns)| format!(",{name}_{}", units[usize::from(!turns)][derivative]))
    };
    let header: String = (0..3).flat_map(of).collect();
    let rows = trajectory
        .times_s()
        .map(|t| once(t).chain((0..3).flat_map(move |derivative| trajectory.spline.at(t, derivative))));
    write_numbers(path, &format!("t_s{header}"), rows)
}

/// Reads a trajectory of the joints of a chain: rows at even times, positions and velocities, accelerations if they are there.
///
/// # Errors
/// [`Error::Recording`] as [`read_reference_log`]; a joint of the chain is missing; or the rows are not of one cubic spline whose knots are at these times.
///
/// # Examples
/// ```
/// use calibrant_machine::chain::{Joint, JointKind, JointLimits, KinematicChain};
/// use calibrant_machine::spline::{Degree, UniformKnots, VectorSpline};
/// use calibrant_recording::{Trajectory, read_trajectory, write_trajectory};
/// use nalgebra::{Isometry3, Vector3};
/// let (origin, limits) = (Isometry3::identity(), JointLimits::default());
/// let joint = Joint { name: "table".into(), kind: JointKind::Continuous, axis: Vector3::z_axis(), origin, limits };
/// let table = KinematicChain { base: "base".into(), tip: "tip".into(), joints: vec![joint], tip_transform: origin };
/// let knots = UniformKnots { start_s: 0.0, step_s: 0.5, intervals: 4, degree: Degree::Cubic };
/// let spline = VectorSpline { knots, dimension: 1, controls: vec![0.0, 0.0, 0.0, 0.3, 1.0, 1.0, 1.0] };
/// let directory = tempfile::tempdir().expect("a temporary directory");
/// let path = directory.path().join("trajectory.csv");
/// write_trajectory(&path, &Trajectory::of(&table, spline.clone()))?;
/// let read = read_trajectory(&path, &table)?.spline;
/// assert!((read.at(1.3, 1)[0] - spline.at(1.3, 1)[0]).abs() < 1e-12);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn read_trajectory(path: &Path, chain: &KinematicChain) -> Result<Trajectory> {
    let file = read_reference_log(path, &ReferenceLogOptions::default())?;
    let placed = |error: Error| error.in_recording(path);
    let Some(log) = file.joints() else {
        let message = "these are poses, no joints";
        return Err(placed(Error::recording(InputError::new(Refusal::FormatUnknown, message, HELP))));
    };
    file.check_units(chain).and_then(|()| through(log, file.trajectory.clone(), chain)).map_err(placed)
}

/// The trajectory of a chain's joints through these rows. `spline`: what accelerations beside them say.
fn through(log: &JointLog, spline: Option<VectorSpline>, chain: &KinematicChain) -> Result<Trajectory> {
    let refused =
        |code: Refusal, message: String| Err(Error::recording(InputError::new(code, message, HELP)));
    let mut places = Vec::with_capacity(chain.joints.len());
    for joint in &chain.joints {
        match log.names.iter().position(|name| *name == joint.name) {
            Some(place) => places.push(place),
            None => {
                let unit = joint.kind.unit();
                let message = format!("the joint `{}` has no column {}_{unit}", joint.name, joint.name);
                return refused(Refusal::ColumnMissing, message);
            }
        }
    }
    let width = log.names.len();
    let found = spline.or_else(|| {
        let velocities = log.velocities.as_ref()?;
        spline_through_velocities(&log.times_s, &log.positions, velocities, width)
    });
    let Some(spline) = found else {
        let message = "its rows are not of one cubic spline with knots at these times";
        return refused(Refusal::MotionInvalid, message.into());
    };
    let controls = spline.controls.chunks_exact(width);
    let controls = controls.flat_map(|row| places.iter().map(|place| row[*place])).collect();
    Ok(Trajectory::of(chain, VectorSpline { dimension: places.len(), controls, ..spline }))
}

/// The remedy for another file.
const HELP: &str = "a trajectory has even times t_s, and elbow_rad, elbow_radps and elbow_radps2 of each joint at the knots of cubic splines, as `calibrant design` writes it";

#[cfg(test)]
mod tests {
    use super::super::knots::tests::wild;
    use super::*;
    use calibrant_machine::chain::{Joint, JointKind, JointLimits};
    use nalgebra::{Isometry3, Vector3};
    use std::fmt::Write as _;

    /// A chain of two joints, `one` that turns and `two` that slides.
    fn chain() -> KinematicChain {
        let joint = |name: &str, kind| Joint {
            name: name.into(),
            kind,
            axis: Vector3::x_axis(),
            origin: Isometry3::identity(),
            limits: JointLimits::default(),
        };
        KinematicChain {
            base: "a".into(),
            tip: "c".into(),
            joints: vec![joint("one", JointKind::Revolute), joint("two", JointKind::Prismatic)],
            tip_transform: Isometry3::identity(),
        }
    }

    #[test]
    fn whoever_reads_a_trajectory_as_a_log_gets_its_knots() {
        let directory = tempfile::tempdir().expect("a temporary directory");
        let path = directory.path().join("trajectory.csv");
        let spline = wild();
        write_trajectory(&path, &Trajectory::of(&chain(), spline.clone())).expect("written");
        let header = std::fs::read_to_string(&path).expect("written");
        assert!(header.starts_with("t_s,one_rad,two_m,one_radps,two_mps,one_radps2,two_mps2\n"), "{header}");
        let file = read_reference_log(&path, &ReferenceLogOptions::default()).expect("a log");
        assert!((file.knot_step_s.expect("stated") - 0.2).abs() < 1e-12);
        assert!(file.findings.is_empty(), "{:?}", file.findings);
        let log = file.joints().expect("of joints");
        assert_eq!(log.times_s.len(), 25 * 20 + 1);
        for (k, t) in log.times_s.iter().enumerate() {
            let difference = log.row(k)[1] - spline.at(*t, 0)[1];
            assert!(difference.abs() < 1e-12, "{t}: {difference}");
        }
    }

    #[test]
    fn what_is_no_trajectory_says_why() {
        let directory = tempfile::tempdir().expect("a temporary directory");
        let path = directory.path().join("trajectory.csv");
        write_trajectory(&path, &Trajectory::of(&chain(), wild())).expect("written");
        let good = std::fs::read_to_string(&path).expect("written");
        let rows: Vec<&str> = good.lines().collect();
        let mut wrong = String::new();
        for (text, wanted) in [
            (good.replace("two_", "three_"), "the joint `two` has no column two_m"),
            (good.replace("_rad", "_m"), "the joint `one` turns, and its column is not in rad or deg"),
            (good.replace("_m", "_rad"), "the joint `two` slides, and its column is not in m or mm"),
            (rows[..2].join("\n"), "there is only one row"),
            (
                good.replace("\n0.4,", "\n0.41,"),
                "its rows are not of one cubic spline with knots at these times",
            ),
            (good.replace("\n0.4,-", "\n0.4,"), "its rows are not of one cubic spline"),
            (good.replace("one_rad,two_m,", "one_x,two_x,"), "no column"),
            ([rows[0], rows[2], rows[1]].join("\n"), "0.2"),
        ] {
            std::fs::write(&path, &text).expect("written");
            let found = read_trajectory(&path, &chain()).expect_err("broken").to_string();
            if !found.contains(wanted) {
                let _ = writeln!(wrong, "wanted {wanted}\nfound  {found}");
            }
        }
        assert!(wrong.is_empty(), "{wrong}");
    }
}
