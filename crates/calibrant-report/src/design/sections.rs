//! The sections of a design, in their order.

use super::criterion::{criterion_explained, criterion_in_words, gap_in_words};
use super::limits::{axes, uses};
use super::motions::{confidence_section, motion_section};
use super::predicted_sd::{criterion_table, promised_table};
use super::starts;
use super::verdict::verdict;
use crate::figure::{Drawn, start_values};
use crate::number_format::{counted, short, significant};
use crate::report_context::{About, READINGS};
use crate::sheet::{Section, Sheet};
use calibrant_core::information::Criterion;
use calibrant_design::{AT_BEST, Design, LimitUse};

/// A design as a sheet: the certificate in words, the predicted standard deviations of a shuttle and of the optimal motion,
/// the motions with their limits, confidence ellipses, correlations, and the starts of the search.
#[must_use]
pub fn design_sheet<'a>(design: &'a Design, about: &'a About) -> Sheet<'a> {
    let axes = axes(&design.parameters);
    let (before, optimal) = (design.baseline(), ("optimal", &design.optimal));
    let motion = motion_section(
        "The motion of the arm on each axis, with the limits that it keeps at all times.",
        "Jerk (a) and acceleration (b), as in Figure 8 of the thesis",
        vec![Drawn::before(before.0, &before.1.motion), Drawn::after("optimal", &design.optimal.motion)],
        axes,
        design.limits.clone(),
        (&uses(&design.limits, &design.parameters, &design.optimal.motion), "optimal motion"),
    );
    let confidence = confidence_section(&design.parameters, before, Some(optimal), &design.optimal);
    let sections = vec![predicted(design), motion, confidence, search(design)];
    about.sheet("Design", verdict(design, about), sections, READINGS)
}

fn predicted(design: &Design) -> Section<'_> {
    let before = design.baseline();
    let what = match before.0 {
        "shuttle" => {
            "The shuttle is what an engineer would write: to and fro at full acceleration, with the ramps and the stroke that are best \
             within the limits."
        }
        _ => {
            "The random motion is within a tenth of the limits. These limits and intervals leave no room for a shuttle."
        }
    };
    let mut section = Section::new("Predicted standard deviations").lead(format!(
        "Standard deviations that a calibration from a recording of the motion will state. {what}"
    ));
    section.line(values(design));
    section.table(promised_table(
        &design.parameters,
        before,
        Some(("optimal", &design.optimal)),
        design.certificate.as_ref().map(|certificate| certificate.sd_lower_bound.as_slice()),
    ));
    section.explanation(format!("The design minimises {}.", criterion_explained(&design.criterion)));
    section.table(criterion_table(design).on_page());
    if let Some(certificate) = &design.certificate {
        section.heading_on_page("The lower bound");
        section.explanation(certificate.explanation.clone());
        section
            .explanation("Each standard deviation has its own bound. One motion need not reach all of them.");
    }
    starts_in_short(design).into_iter().for_each(|line| section.line(line));
    reached_limits(design).into_iter().for_each(|line| section.line(line));
    bound_in_short(design).into_iter().for_each(|line| section.line(line));
    section
}

fn search(design: &Design) -> Section<'_> {
    let mut section = Section::on_page("The search");
    section.paragraph(
        "The problem has many local optima. The search starts at many random motions and at the initial one, and keeps the best result.",
    );
    if design.starts.is_empty() {
        section.paragraph("There is no record of the starts.");
        return section;
    }
    section.list(starts::sentences(&design.starts, &design.criterion));
    section.figure(|| start_values(&design.starts, &design.criterion));
    starts::add_start_table(&mut section, &design.starts, &design.criterion);
    section
}

/// The values of the criterion for both motions.
fn values(design: &Design) -> String {
    let above = if design.floor > 0.0 {
        format!(", above {} of the tilt, which no motion changes", significant(design.floor, 4))
    } else {
        String::new()
    };
    let (name, before) = design.baseline();
    format!(
        "{}: {} {name}, {} optimal{above}",
        criterion_in_words(&design.criterion),
        significant(before.value - design.floor, 5),
        significant(design.optimal.value - design.floor, 5)
    )
}

/// The value that no motion can beat; `None` without a certificate.
fn bound_in_short(design: &Design) -> Option<String> {
    let certificate = design.certificate.as_ref()?;
    let least = significant(certificate.lower_bound - design.floor, 4);
    let gap = gap_in_words(&design.criterion, certificate.gap);
    Some(format!("no admissible motion is below {least}, {gap} less"))
}

/// The starts of the search; `None` where none is recorded.
fn starts_in_short(design: &Design) -> Option<String> {
    let all = design.starts.len();
    let at_best = match &design.criterion {
        _ if !design.optimal.value.is_finite() => String::new(),
        Criterion::D(_) => format!(", {} within {AT_BEST} nats of the best", design.starts_at_best()),
        _ => format!(", {} within {} % of the best", design.starts_at_best(), short(100.0 * AT_BEST)),
    };
    (all > 0).then(|| {
        format!(
            "{}, {} converged{at_best}; {}",
            counted(all, "start"),
            design.starts_converged(),
            counted(design.iterations, "iteration")
        )
    })
}

/// The limits that the optimal motion reaches to within a thousandth.
fn reached_limits(design: &Design) -> Option<String> {
    let uses = uses(&design.limits, &design.parameters, &design.optimal.motion);
    let is_reached = |found: &&LimitUse| found.limit > 0.0 && found.value.abs() >= 0.999 * found.limit;
    let mut names: Vec<&str> = uses.iter().filter(is_reached).map(|found| found.kind.name()).collect();
    names.sort_unstable();
    names.dedup();
    (!names.is_empty()).then(|| format!("the motion reaches its limits of {}", names.join(", ")))
}
