//! Errors that are as large as predicted, and confirm nothing.
//!
//! A sensor that changes within a recording scatters more, which is predicted; clocks of different rates give gains that are wrong by the same share in all rotations; errors that do not count are not among those that are as predicted.

use super::caveat::Caveat;
use super::unused_error::{ErrorKind, UnusedError};
use crate::estimate::change::longest_run;
use crate::estimate::{Calibration, Change, Changed, ClockRate};
use crate::sensor::SensorKind;

/// Fewest errors that are several.
const FEWEST_UNUSED: usize = 3;
/// Least share of all errors that they are.
const LEAST_UNUSED_SHARE: f64 = 0.05;

/// What a calibration itself gives reason to doubt.
#[derive(Debug, Clone, Default)]
pub(super) struct Caveats {
    changes: Vec<Change>,
    clocks: Option<ClockRate>,
    holds: Option<Caveat>,
    rotations: Option<Caveat>,
}

impl Caveats {
    pub(super) fn of(calibration: &Calibration) -> Self {
        let holds: Vec<(bool, f64, f64)> = calibration
            .hold_results()
            .iter()
            .filter(|result| result.reason.is_none())
            .map(|result| (!result.used, result.hold.start_s, result.hold.end_s))
            .collect();
        let rotations: Vec<(bool, f64, f64)> = calibration
            .rotations()
            .iter()
            .filter(|rotation| rotation.is_integrated())
            .map(|rotation| (!rotation.used, rotation.start_s, rotation.end_s))
            .collect();
        Self {
            changes: calibration.changes.clone(),
            clocks: calibration.gyroscope.as_ref().and_then(|gyroscope| gyroscope.clocks),
            holds: left_out(&holds),
            rotations: left_out(&rotations),
        }
    }

    /// The reason to doubt errors of a kind, in order of time.
    pub(super) fn about(&self, kind: ErrorKind, errors: &[UnusedError]) -> Option<Caveat> {
        let concerns = |change: &&Change| match (change.sensor_kind, change.of) {
            (SensorKind::Accelerometer, _) => matches!(kind, ErrorKind::Magnitude | ErrorKind::Rotation),
            // rotations follow the bias of the holds beside them
            (SensorKind::Gyroscope, Changed::Bias) => kind == ErrorKind::Rate,
            (SensorKind::Gyroscope, _) => kind == ErrorKind::Rotation,
        };
        let change = || self.changes.iter().find(concerns).map(|change| Caveat::Change(*change));
        let clocks = || self.clocks.filter(|_| kind == ErrorKind::Rotation).map(Caveat::Clocks);
        let left_out = || match kind {
            ErrorKind::Magnitude => self.holds,
            ErrorKind::Rate => None,
            ErrorKind::Rotation => self.holds.or(self.rotations),
        };
        let in_a_row = || {
            let run = longest_run(errors.iter().map(|error| !error.counts))?;
            let (first, last) = (errors.get(run.start)?, errors.get(run.end - 1)?);
            Some(Caveat::InARow { count: run.len(), start_s: first.start_s, end_s: last.end_s })
        };
        let several = || {
            let count = errors.iter().filter(|error| !error.counts).count();
            (count >= FEWEST_UNUSED && count as f64 > LEAST_UNUSED_SHARE * errors.len() as f64)
                .then_some(Caveat::Several { count })
        };
        change().or_else(clocks).or_else(left_out).or_else(in_a_row).or_else(several)
    }
}

/// A run of those that were left out, of their begins and ends.
fn left_out(times: &[(bool, f64, f64)]) -> Option<Caveat> {
    let run = longest_run(times.iter().map(|(left_out, ..)| *left_out))?;
    let (_, start_s, _) = times.get(run.start)?;
    let (_, _, end_s) = times.get(run.end - 1)?;
    Some(Caveat::LeftOut { count: run.len(), start_s: *start_s, end_s: *end_s })
}
