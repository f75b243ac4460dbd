//! The sheet of studies: the thesis's chapters 3 and 4, figure by figure.

mod calibration;
mod design;
mod rehearsal;
mod settings;

use super::figure::trace_map;
use super::report_context::{About, READINGS};
use crate::sheet::{Grade, Section, Sheet, SheetVerdict};
use calibrant_study::Studies;

/// Studies as a sheet: for each study its settings, a summary, and the figures of the thesis. Figures 4 to 6
/// show calibrations, 7 the surface of the trace, and 8 to 11 initial against optimal motion. Figures 13 and
/// 14 show the latter with process noise.
///
/// Figures of single sensors show an evenly spread part of a large population, and state that.
#[must_use]
pub fn study_sheet<'a>(studies: &'a Studies, about: &'a About) -> Sheet<'a> {
    let mut sections: Vec<Section<'a>> = Vec::new();
    sections.extend(studies.calibration.as_ref().map(calibration::chapter));
    sections.extend(studies.surface.as_ref().map(|surface| {
        let mut section = Section::on_page("The criterion")
            .lead("How the trace of the covariance depends on the motion, in the simplest case.");
        section.figure(move || Some(trace_map(surface)));
        section
    }));
    sections.extend(studies.design.as_ref().map(|study| design::chapter(study, &design::OPTIMAL)));
    sections.extend(studies.noisy.as_ref().map(|study| design::chapter(study, &design::NOISY)));
    sections.extend(studies.rehearsal.as_ref().map(rehearsal::chapter));
    about.sheet("Study", verdict(studies, about), sections, READINGS)
}

/// Is each study as predicted, and why?
fn verdict(studies: &Studies, about: &About) -> SheetVerdict {
    let mut judged = Vec::new();
    judged.extend(studies.calibration.as_ref().map(calibration::judge));
    judged.extend(studies.design.iter().map(|study| design::judge("Optimal motions", study)));
    judged.extend(studies.noisy.iter().map(|study| design::judge("With process noise", study)));
    judged.extend(studies.rehearsal.as_ref().map(rehearsal::judge));
    let good = !judged.is_empty() && judged.iter().all(|(good, _)| *good);
    let (grade, word) =
        if good { (Grade::Good, "✓ As predicted.") } else { (Grade::Caution, "! Look closer.") };
    let sentences: Vec<String> = judged.into_iter().map(|(_, sentence)| sentence).collect();
    let sentence = if sentences.is_empty() { "No study was run.".to_owned() } else { sentences.join(" ") };
    SheetVerdict::new(grade, word, sentence)
        .with("Not run", studies.notes.iter().map(|found| found.message().to_owned()).collect())
        .with("Findings", about.findings.clone())
}
