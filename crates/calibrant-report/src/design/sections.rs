//! The sections of a design, in their order.

use super::axes;
use super::in_short;
use super::motions::{confidence_section, motion_section};
use super::predicted_sd::{criterion_table, promised_table};
use super::starts;
use super::verdict::verdict;
use crate::About;
use crate::figure::{Drawn, start_values};
use crate::sheet::{Section, Sheet};
use calibrant_design::{Design, limit_use};

/// A design as a sheet: the certificate in words, the predicted standard deviations of initial and optimal motion,
/// the motions with their limits, confidence ellipses, correlations, and the starts of the search.
#[must_use]
pub fn design_sheet<'a>(design: &'a Design, about: &'a About) -> Sheet<'a> {
    let axes = axes(&design.parameters);
    let (initial, optimal) = (("initial", &design.initial), ("optimal", &design.optimal));
    let motion = motion_section(
        "The motion of the arm on each axis, with the limits that it keeps at all times.",
        "Figure 8 of the thesis: initial against optimal jerk (a) and acceleration (b)",
        vec![
            Drawn::before("initial", &design.initial.motion),
            Drawn::after("optimal", &design.optimal.motion),
        ],
        axes,
        design.limits.clone(),
        (&limit_use(&design.limits, axes.len(), &design.optimal.motion), "optimal motion"),
    );
    let confidence = confidence_section(&design.parameters, initial, Some(optimal), &design.optimal);
    Sheet {
        title: if about.title.is_empty() { "Design".into() } else { about.title.clone() },
        verdict: Some(verdict(design, about)),
        sections: vec![predicted(design), motion, confidence, search(design)],
        inputs: about.facts.clone(),
        footer: about.footer(),
    }
}

fn predicted(design: &Design) -> Section<'_> {
    let mut section = Section::new("Predicted standard deviations").lead(
        "Standard deviations that a calibration from a recording of the motion will state. The initial motion is what experience would \
         choose: random, within a tenth of the limits.",
    );
    section.line(in_short::values(design));
    section.table(promised_table(
        &design.parameters,
        ("initial", &design.initial),
        Some(("optimal", &design.optimal)),
        design.certificate.as_ref().map(|certificate| certificate.sd_lower_bound.as_slice()),
    ));
    section.explanation(format!(
        "The design minimises criterion {}, {} (C is the covariance of the parameters{}).",
        design.criterion.letter(),
        design.criterion.formula(),
        design.criterion.scaling()
    ));
    section.table(criterion_table(design).on_page());
    if let Some(certificate) = &design.certificate {
        section.heading_on_page("The lower bound");
        section.explanation(certificate.explanation.clone());
        section
            .explanation("Each standard deviation has its own bound. One motion need not reach all of them.");
    }
    in_short::starts(design).into_iter().for_each(|line| section.line(line));
    in_short::reached_limits(design).into_iter().for_each(|line| section.line(line));
    in_short::bound(design).into_iter().for_each(|line| section.line(line));
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
