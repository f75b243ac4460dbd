//! The report page on studies: the thesis's chapters 3 and 4, figure by figure.

mod calibration;
mod design;
mod settings;

use super::About;
use super::figure::trace_map;
use super::html::{Page, list, verdict_box};
use calibrant_study::Studies;

/// Studies as one HTML file: for each study its settings, a summary, and the figures of the thesis. Figures 4 to 6
/// show calibrations, 7 the surface of the trace, and 8 to 11 initial against optimal motion. Figures 13 and
/// 14 show the latter with process noise.
///
/// The file is self-contained, as [`Sheet::html`](crate::Sheet::html) is. Figures of single sensors show
/// an evenly spread part of a large population, and state that.
#[must_use]
pub fn study_report(studies: &Studies, about: &About) -> String {
    let mut judged = Vec::new();
    if let Some(study) = &studies.calibration {
        judged.push(calibration::judge(study));
    }
    judged.extend(studies.design.iter().map(|study| design::judge("Optimal motions", study)));
    judged.extend(studies.noisy.iter().map(|study| design::judge("With process noise", study)));
    let mut page = headed(about, &judged, &studies.remarks);

    if let Some(study) = &studies.calibration {
        calibration::chapter(&mut page, study);
    }
    if let Some(surface) = &studies.surface {
        page.section(
            "The criterion",
            "How the trace of the covariance depends on the motion, in the simplest case.",
        );
        page.push(trace_map(surface));
    }
    if let Some(study) = &studies.design {
        design::chapter(&mut page, study, &design::OPTIMAL);
    }
    if let Some(study) = &studies.noisy {
        design::chapter(&mut page, study, &design::NOISY);
    }
    page.finish(title(about), &about.facts, &about.footer())
}

fn title(about: &About) -> &str {
    if about.title.is_empty() { "Study" } else { &about.title }
}

/// A page with title and verdict.
fn headed(about: &About, judged: &[(bool, String)], remarks: &[String]) -> Page {
    let good = !judged.is_empty() && judged.iter().all(|(good, _)| *good);
    let (class, word) = if good { ("good", "✓ As predicted.") } else { ("caution", "! Look closer.") };
    let lists = [("Not run", remarks.to_vec()), ("Findings", about.findings.clone())];
    let verdict = match judged {
        [(_, sentence)] => verdict_box(class, word, sentence, &lists),
        _ => {
            let sentences: Vec<String> = judged.iter().map(|(_, sentence)| sentence.clone()).collect();
            let what = if judged.is_empty() { "No study was run." } else { "" };
            let sentences = format!("</p>{}", list(&sentences));
            verdict_box(class, word, what, &lists).replacen("</p>", &sentences, 1)
        }
    };
    Page::opened(title(about), verdict)
}
