//! Caveats of a calibration: why errors of the predicted size may confirm nothing.
//!
//! A change of a sensor enlarges the scatter, and the prediction includes this scatter. Clocks of different rates give a common error of all gains.
//! Outliers are not among the errors that agree with the prediction.

use super::unused_error::{ErrorKind, UnusedError};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::change::SensorChanged;
use crate::diagnostic::reader::Span;
use crate::diagnostic::validation::{ErrorsLeftOut, GainsOfClock};
use crate::estimate::change::longest_run;
use crate::estimate::{Calibration, Change, Changed, ClockRate};
use crate::sensor::SensorKind;

/// Fewest outliers that are too many.
const FEWEST_UNUSED: usize = 3;
/// Least share of outliers that is too many.
const LEAST_UNUSED_SHARE: f64 = 0.05;

/// The caveats of a calibration itself.
#[derive(Debug, Clone, Default)]
pub(super) struct Caveats {
    changes: Vec<Change>,
    clocks: Option<ClockRate>,
    holds: Option<ErrorsLeftOut>,
    rotations: Option<ErrorsLeftOut>,
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
            holds: left_out("hold", &holds),
            rotations: left_out("rotation", &rotations),
        }
    }

    /// The caveat about errors of one kind, which are in order of time.
    pub(super) fn about(&self, kind: ErrorKind, errors: &[UnusedError]) -> Option<Diagnostic> {
        let concerns = |change: &&Change| match (change.sensor_kind, change.of) {
            (SensorKind::Accelerometer, _) => matches!(kind, ErrorKind::Magnitude | ErrorKind::Rotation),
            // rotations follow the bias of the holds beside them
            (SensorKind::Gyroscope, Changed::Bias) => kind == ErrorKind::Rate,
            (SensorKind::Gyroscope, _) => kind == ErrorKind::Rotation,
        };
        let change = self
            .changes
            .iter()
            .find(concerns)
            .map(|&change| Diagnostic::from(SensorChanged { change, coldest_c: None, hottest_c: None }));
        let clocks = || {
            let ClockRate { faster: skew, sd: skew_sd } =
                self.clocks.filter(|_| kind == ErrorKind::Rotation)?;
            Some(GainsOfClock { skew, skew_sd }.into())
        };
        let left_out = || match kind {
            ErrorKind::Magnitude => self.holds.clone(),
            ErrorKind::Rate => None,
            ErrorKind::Rotation => self.holds.clone().or_else(|| self.rotations.clone()),
        };
        let what = if kind == ErrorKind::Rotation { "rotation" } else { "hold" };
        let in_a_row = || {
            let times: Vec<_> =
                errors.iter().map(|error| (!error.counts, error.start_s, error.end_s)).collect();
            Some(ErrorsLeftOut { by_calibration: false, ..self::left_out(what, &times)? })
        };
        let several = || {
            let count = errors.iter().filter(|error| !error.counts).count();
            (count >= FEWEST_UNUSED && count as f64 > LEAST_UNUSED_SHARE * errors.len() as f64)
                .then_some(ErrorsLeftOut { what, count, times: None, by_calibration: false })
        };
        let of_errors = || left_out().or_else(in_a_row).or_else(several).map(Diagnostic::from);
        change.or_else(clocks).or_else(of_errors)
    }
}

/// A run of items that the calibration does not use, from the begin of the first to the end of the last.
fn left_out(what: &'static str, times: &[(bool, f64, f64)]) -> Option<ErrorsLeftOut> {
    let run = longest_run(times.iter().map(|(left_out, ..)| *left_out))?;
    let (count, first, last) = (run.len(), times.get(run.start)?, times.get(run.end - 1)?);
    let times = Some(Span { start_s: first.1, end_s: last.2 });
    Some(ErrorsLeftOut { what, count, times, by_calibration: true })
}
