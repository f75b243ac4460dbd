//! The counts of the verdicts, and the yield.

use super::sensors::Batch;
use crate::number_format::{counted, percent};
use crate::report_context::About;
use crate::sheet::{Grade, SheetVerdict};
use calibrant_core::diagnostic::Usability;

/// How many sensors have each verdict.
struct Counts {
    all: usize,
    ok: usize,
    doubtful: usize,
    bad: usize,
    without_result: usize,
    over_limits: usize,
}

impl Counts {
    fn of(batch: &Batch) -> Self {
        let count = |usability| batch.sensors.iter().filter(|of| of.usability() == usability).count();
        Self {
            all: batch.sensors.len(),
            ok: count(Some(Usability::Ok)),
            doubtful: count(Some(Usability::Doubtful)),
            bad: count(Some(Usability::Bad)),
            without_result: count(None),
            over_limits: batch.sensors.iter().filter(|of| !of.limits_failed.is_empty()).count(),
        }
    }
}

/// The yield, with the other verdicts.
pub(super) fn yield_of(batch: &Batch, about: &About) -> SheetVerdict {
    let counts = Counts::of(batch);
    let (grade, sign) = match counts {
        _ if counts.bad + counts.without_result > 0 || counts.all == 0 => (Grade::Bad, "✗"),
        _ if counts.doubtful > 0 => (Grade::Caution, "!"),
        _ => (Grade::Good, "✓"),
    };
    let word = match counts.all {
        0 => format!("{sign} There is no sensor."),
        all => format!(
            "{sign} Yield {}: {} of {} ok.",
            percent(counts.ok as f64 / all as f64),
            counts.ok,
            counted(all, "sensor")
        ),
    };
    let limits = match (counts.over_limits, batch.parameters.iter().any(|of| of.accepted.is_some())) {
        (0, false) => String::new(),
        (0, true) => " None breaks a limit of [accept].".to_owned(),
        (1, _) => " 1 breaks a limit of [accept].".to_owned(),
        (several, _) => format!(" {several} break a limit of [accept]."),
    };
    let sentence = format!(
        "{} bad, {} doubtful, {} without a result.{limits}",
        counts.bad, counts.doubtful, counts.without_result
    );
    SheetVerdict::new(grade, word, sentence).with("Findings", about.findings.clone())
}
