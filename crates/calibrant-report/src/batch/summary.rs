//! The counts of the verdicts, and the yield.

use super::sensors::Batch;
use crate::number_format::{counted, percent};
use crate::report_context::About;
use crate::sheet::{Grade, SheetVerdict};
use calibrant_core::diagnostic::Usability;

pub(super) fn yield_of(batch: &Batch, about: &About) -> SheetVerdict {
    let count = |usability| batch.sensors.iter().filter(|of| of.usability() == usability).count();
    let [ok, doubtful, bad] =
        [Usability::Ok, Usability::Doubtful, Usability::Bad].map(|usability| count(Some(usability)));
    let (all, without_result) = (batch.sensors.len(), count(None));
    let (grade, sign) = match () {
        () if bad + without_result > 0 || all == 0 => (Grade::Bad, "✗"),
        () if doubtful > 0 => (Grade::Caution, "!"),
        () => (Grade::Good, "✓"),
    };
    let word = match all {
        0 => format!("{sign} There is no sensor."),
        _ => {
            let share = percent(ok as f64 / all as f64);
            format!("{sign} Yield {share}: {ok} of {} ok.", counted(all, "sensor"))
        }
    };
    let over_limits = batch.sensors.iter().filter(|of| !of.limits_failed.is_empty()).count();
    let limits = match (over_limits, batch.parameters.iter().any(|of| of.accepted.is_some())) {
        (0, false) => String::new(),
        (0, true) => " None breaks a limit of [accept].".to_owned(),
        (1, _) => " 1 breaks a limit of [accept].".to_owned(),
        (several, _) => format!(" {several} break a limit of [accept]."),
    };
    let sentence = format!("{bad} bad, {doubtful} doubtful, {without_result} without a result.{limits}");
    SheetVerdict::new(grade, word, sentence).with("Findings", about.findings.clone())
}
