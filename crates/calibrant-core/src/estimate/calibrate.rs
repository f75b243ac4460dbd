//! Calibrates a sensor, whatever its stimulus.

use super::{Calibration, CalibrationProblem, CalibrationSettings, Change, Stimulus, holds, motion};
use crate::diagnostic::change::SensorChanged;
use crate::diagnostic::{Diagnostic, samples};
use crate::error::Result;
use crate::sensor::SensorKind;
use std::borrow::Cow;

/// Calibrates a sensor.
///
/// With holds, spikes and invalid samples are removed first ([`Recording::without_spikes`](crate::sensor::Recording::without_spikes)), with a warning.
/// This is not done if the holds are given ([`HoldsSetup::found`](super::HoldsSetup::found)).
///
/// # Errors
/// - [`Error::Recording`](crate::Error::Recording): the recording is unusable, or does not overlap the motion.
/// - [`Error::NotIdentifiable`](crate::Error::NotIdentifiable) names the parameters that the data cannot determine, and a remedy.
/// - [`Error::Experiment`](crate::Error::Experiment): the problem lacks a value, such as the noise.
///
/// An iteration that does not converge is a [`CalibrationStatus`](super::CalibrationStatus) in the result.
///
/// # References
/// `vamvaka2021`, `burger2017`
///
/// # Examples
/// Three samples of an exactly known motion determine bias and scale factor of one axis:
/// ```
/// use calibrant_core::estimate::{CalibrationProblem, CalibrationSettings, Stimulus, calibrate};
/// use calibrant_core::motion::{CommandedMotion, JerkControlledMotion, KnownEnds, MotionClock, Trust};
/// use calibrant_core::sensor::{ReadingUnit, Recording, Sensor};
/// use nalgebra::Vector3;
///
/// let sensor = Sensor { axes: 1, ..Sensor::memsic_mxd2020u() };
/// let nodes = vec![Vector3::new(-9.0, 0.0, 0.0), Vector3::new(9.0, 0.0, 0.0)];
/// let motion = JerkControlledMotion::uniform(1.0, nodes)?;
/// let command = CommandedMotion { motion, trust: Trust::Known, known_ends: KnownEnds::Start, gravity: None, clock: MotionClock::default() };
/// let readings = [-8.91, 0.09, 9.09].map(|y| Vector3::new(y, 0.0, 0.0)).to_vec();
/// let recording = Recording::new(vec![0.0, 0.5, 1.0], readings, 1, ReadingUnit::MetrePerSecondSquared)?;
/// let problem = CalibrationProblem { sensor: &sensor, recording: &recording, stimulus: Stimulus::Motion(&command) };
/// let calibration = calibrate(&problem, &CalibrationSettings::default())?;
/// assert!((calibration.values[0] - 0.09).abs() < 1e-12, "bias.x");
/// assert!((calibration.values[1] - 1.0).abs() < 1e-12, "scale.x");
/// assert!((calibration.sd()[1] - 2e-4 / (2.0_f64 * 81.0).sqrt()).abs() < 1e-15);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn calibrate(problem: &CalibrationProblem<'_>, settings: &CalibrationSettings) -> Result<Calibration> {
    match problem.stimulus {
        Stimulus::Motion(command) => {
            problem.validate()?;
            motion::calibrate(problem, command, settings)
        }
        Stimulus::Holds(setup) => {
            let (recording, spikes) = match setup.found {
                Some(_) => (Cow::Borrowed(problem.recording), None),
                None => problem.recording.without_spikes(SensorKind::Accelerometer),
            };
            let problem = CalibrationProblem { recording: &recording, ..*problem };
            problem.validate()?;
            let mut calibration = holds::calibrate(&problem, setup, settings, &recording)?;
            let found = spikes.map(|spikes| {
                Diagnostic::from(samples::Spikes::of(&spikes, SensorKind::Accelerometer, recording.unit))
            });
            calibration.warnings.splice(0..0, found);
            let changed = |change: &Change| {
                Diagnostic::from(SensorChanged { change: *change, coldest_c: None, hottest_c: None })
            };
            calibration.warnings.extend(calibration.changes.iter().map(changed));
            Ok(calibration)
        }
    }
}
