//! What was left out of a calibration, or replaced, where it is too little to matter: it does not count for the verdict.
//!
//! Spikes are single samples, and the line between their neighbours is in their place. A hold or a rotation that is left out has no influence; that there is one
//! among many says little of the others, whose scatter the standard deviations contain. A hold that was found and turns tells nothing of the gyroscope's bias,
//! and more than half of the holds tell it. What looks still but was too short for a hold was never used.

use calibrant_core::diagnostic::gyroscope::RotationLeftOut;
use calibrant_core::diagnostic::holds::{HoldLeftOut, HoldMoved, HoldsLostToFilter};
use calibrant_core::diagnostic::noise::NoiseOutliers;
use calibrant_core::diagnostic::samples::{LeftOutNegligible, Spikes};
use calibrant_core::diagnostic::{Check, Code, Diagnostic, Phrase, RotationReason};
use calibrant_core::estimate::Calibration;
use calibrant_core::sensor::{ImuRecording, Recording, SensorKind};

/// Share of the samples up to which spikes do not matter.
const SAMPLES: f64 = 1e-3;
/// Share of the holds, or of the rotations.
const OTHERS: f64 = 0.05;
/// One of as many does not matter.
const FEWEST: usize = 12;
/// So many holds tell the gyroscope's bias and its scatter.
const FEWEST_OF_BIAS: usize = 6;

/// The codes among these warnings that do not count, and the note that says so. `held`: a calibration from holds.
pub(crate) fn negligible(
    warnings: &[Diagnostic],
    recording: &ImuRecording,
    held: Option<&Calibration>,
) -> Option<(Diagnostic, Vec<Code>)> {
    let mut found: Vec<(Code, String)> = Vec::new();
    for code in [Spikes::CODE, NoiseOutliers::CODE] {
        let of_code: Vec<[usize; 2]> = (warnings.iter())
            .filter(|warning| warning.code() == code)
            .map(|warning| [taken_out(warning), samples(warning, recording)])
            .collect();
        let is_little = |[taken, of]: &[usize; 2]| *taken as f64 <= SAMPLES * *of as f64;
        if !of_code.is_empty() && of_code.iter().all(is_little) {
            let words = of_code.iter().map(|[taken, of]| format!("{taken} of {of} samples"));
            found.push((code, words.collect::<Vec<_>>().join(", ")));
        }
    }
    let others = held.map(|held| others(held, warnings)).unwrap_or_default();
    for (code, what, count, of, is_little) in others {
        if is_little && warnings.iter().any(|warning| warning.code() == code) {
            found.push((code, format!("{count} of {of} {what}")));
        }
    }
    let (codes, words): (Vec<Code>, Vec<String>) = found.into_iter().unzip();
    let names = codes.iter().map(ToString::to_string).collect();
    let note = LeftOutNegligible { codes: names, what: Phrase(words.join("; ")) };
    (!codes.is_empty()).then(|| (note.into(), codes))
}

/// Number of samples that were replaced or removed.
fn taken_out(warning: &Diagnostic) -> usize {
    ["replaced", "cut", "outliers"].iter().filter_map(|name| warning.number(name)).sum::<f64>() as usize
}

/// Number of samples that were examined.
fn samples(warning: &Diagnostic, recording: &ImuRecording) -> usize {
    let is_about = |sensor_kind: &SensorKind| {
        warning.subject().is_some_and(|subject| subject.starts_with(sensor_kind.name()))
    };
    let recorded = SensorKind::ALL.into_iter().find(is_about).and_then(|of| recording.sensor(of));
    let examined = warning.number("samples").map(|samples| samples as usize);
    examined.or(recorded.map(Recording::len)).unwrap_or(0)
}

/// Holds and rotations that are not used: code, what they are, how many, of how many, and are these few? None where a sensor saturates: that needs a larger range.
fn others(
    calibration: &Calibration,
    warnings: &[Diagnostic],
) -> Vec<(Code, &'static str, usize, usize, bool)> {
    let is_little = |count: usize, of: usize| of >= FEWEST && count as f64 <= (OTHERS * of as f64).max(1.0);
    let mut all = Vec::new();
    let Some(holds) = calibration.holds() else { return all };
    let count = holds.holds.len();
    if holds.holds.iter().all(|hold| hold.reason.is_none()) {
        let left_out = holds.holds.iter().filter(|hold| !hold.used).count();
        all.push((HoldLeftOut::CODE, "holds", left_out, count, is_little(left_out, count)));
    }
    let lost = warnings.iter().find(|warning| warning.code() == HoldsLostToFilter::CODE);
    if let Some(stretches) = lost.and_then(|lost| lost.number("stretches")).map(|of| of as usize) {
        let are_few = count >= FEWEST && 2 * stretches <= count;
        all.push((HoldsLostToFilter::CODE, "stretches at rest", stretches, count + stretches, are_few));
    }
    if let Some(gyroscope) = &calibration.gyroscope {
        let turning = gyroscope.still.turning_holds.len();
        let are_few = match holds.detected {
            true => count >= turning + FEWEST_OF_BIAS,
            false => is_little(turning, count),
        };
        all.push((HoldMoved::CODE, "holds", turning, count, are_few));
        let unused: Vec<_> = gyroscope.rotations.iter().filter(|rotation| !rotation.used).collect();
        if unused.iter().all(|of| !matches!(of.reason, Some(RotationReason::Saturated(..)))) {
            let (unused, count) = (unused.len(), gyroscope.rotations.len());
            all.push((RotationLeftOut::CODE, "rotations", unused, count, is_little(unused, count)));
        }
    }
    all
}
