//! Logs of a motion that are in memory already.

use super::file::ReferenceLogFile;
use super::format::ReferenceFormat;
use crate::files::checksum::hex_of_lists;
use crate::trajectory::{between_knots, spline_through_velocities};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_machine::log::{JointLog, ReferenceLog};
use calibrant_machine::spline::VectorSpline;

impl ReferenceLogFile {
    /// A log that was made, or read, elsewhere.
    ///
    /// # Errors
    /// [`Error::Recording`] where the lists of the log do not have a value for each time (and joint), or where the times go back.
    ///
    /// # Examples
    /// ```
    /// use calibrant_recording::ReferenceLogFile;
    /// use calibrant_machine::log::{JointLog, ReferenceLog};
    ///
    /// let log = |positions| {
    ///     ReferenceLog::Joints(JointLog { names: vec!["elbow".into()], times_s: vec![0.0, 0.01], positions, velocities: None })
    /// };
    /// assert_eq!(ReferenceLogFile::of_log(log(vec![0.1, 0.2]))?.rows, 2);
    /// assert!(ReferenceLogFile::of_log(log(vec![0.1])).is_err());
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    pub fn of_log(log: ReferenceLog) -> Result<Self> {
        let refused =
            |code, message: String, help: &str| Err(Error::recording(InputError::new(code, message, help)));
        let rows = log.times_s().len();
        if rows < 2 {
            let message = format!("the log has {rows} times");
            return refused(Refusal::RecordingShort, message, "give the motion of the whole recording");
        }
        let (format, lists): (_, Vec<(&str, Vec<f64>, usize)>) = match &log {
            ReferenceLog::Joints(joints) => {
                let width = joints.names.len();
                let mut lists = vec![("positions", joints.positions.clone(), width)];
                lists.extend(joints.velocities.iter().map(|of| ("velocities", of.clone(), width)));
                (ReferenceFormat::Joints, lists)
            }
            ReferenceLog::Poses(poses) => {
                let [place, turn] = [[f64::NAN; 3], [f64::NAN; 3]];
                let places = poses.positions_m.iter().flat_map(|at| at.map_or(place, |at| at.into()));
                let turns = poses.world_from_body.iter();
                let turns = turns.flat_map(|of| of.map_or(turn, |of| of.scaled_axis().into()));
                let lists =
                    vec![("positions_m", places.collect(), 3), ("world_from_body", turns.collect(), 3)];
                (ReferenceFormat::Poses, lists)
            }
        };
        for (name, values, width) in &lists {
            if values.len() != rows * width {
                let message =
                    format!("`{name}` has {} values for {rows} times", values.len() / width.max(&1));
                return refused(Refusal::RecordingsUnlike, message, "give a value for each time");
            }
        }
        if let Some(pair) =
            log.times_s().windows(2).find(|pair| pair.iter().any(|time| time.is_nan()) || pair[0] > pair[1])
        {
            let message = format!("the times go from {} s to {} s", pair[0], pair[1]);
            return refused(Refusal::TimesNotIncreasing, message, "sort the log by time");
        }
        let times = ("t_s", log.times_s().to_vec(), 1);
        let all = std::iter::once(&times).chain(&lists);
        let sha256 = hex_of_lists(all.map(|(name, values, _)| (*name, values.iter().copied())));
        let mut file = Self {
            log,
            turns: Vec::new(),
            format,
            findings: Vec::new(),
            rows,
            sha256,
            counted_from_ns: None,
            knot_step_s: None,
            trajectory: None,
        };
        file.turns = vec![None; file.joints().map_or(0, |log| log.names.len())];
        Ok(file)
    }

    /// The log of a machine that moved on cubic splines with knots at this distance, s. Positions and velocities at just these knots are the splines themselves: the log
    /// has its positions at and between the knots then.
    ///
    /// # Errors
    /// As [`of_log`](Self::of_log).
    pub fn on_knots(log: ReferenceLog, knot_step_s: f64) -> Result<Self> {
        let file = Self { knot_step_s: Some(knot_step_s), ..Self::of_log(log)? };
        let spline = |log: &JointLog| {
            spline_through_velocities(&log.times_s, &log.positions, log.velocities.as_ref()?, log.names.len())
        };
        let is_at_them = |spline: &VectorSpline| (spline.knots.step_s / knot_step_s - 1.0).abs() < 1e-5;
        let spline_of = |log: &JointLog| Some((spline(log).filter(is_at_them)?, log.names.clone()));
        Ok(match file.joints().and_then(spline_of) {
            Some((spline, names)) => Self {
                log: ReferenceLog::Joints(between_knots(&spline, names)),
                trajectory: Some(spline),
                ..file
            },
            None => file,
        })
    }
}
