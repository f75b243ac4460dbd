//! A series of designs that may be interrupted.

use crate::work::Run;
use calibrant::Result;
use calibrant::diagnostic::Diagnostic;
use calibrant::diagnostic::design::SeriesInterrupted;

/// Says that a series was interrupted, which is an error before its first value.
pub(crate) fn series(given: &Run, finished: usize, all: usize) -> Result<Option<Diagnostic>> {
    if finished == 0 {
        given.interruption.check()?;
    }
    let interrupted = SeriesInterrupted { series: "sweep", items: "values", finished, all };
    Ok((finished < all).then(|| interrupted.into()))
}
