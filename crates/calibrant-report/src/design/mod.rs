//! The report page on a design: verdict, predicted standard deviations, motion, search.

mod axes;
mod limits;
mod predicted_sd;
pub(super) mod starts;
mod verdict;

pub(super) use axes::axes;
pub(super) use limits::limit_table;
pub(super) use predicted_sd::{above, promised_table, times};
pub(super) use starts::status;
pub(super) use verdict::{undetermined_items, violation};

use super::About;
use super::figure::{
    Drawn, confidence_ellipses, correlation_map, jerk_and_acceleration, start_values, states,
    velocity_and_displacement,
};
use super::html::Page;
use calibrant_design::{Design, limit_use};
use predicted_sd::criterion_table;
use verdict::verdict;

/// A design as one HTML file: the certificate in words, the predicted standard deviations of initial and optimal motion,
/// the motions with their limits, confidence ellipses, correlations, and the starts of the search.
///
/// Self-contained as [`Sheet::html`](crate::Sheet::html) is.
#[must_use]
pub fn design_report(design: &Design, about: &About) -> String {
    let title = if about.title.is_empty() { "Design" } else { &about.title };
    let mut page = Page::opened(title, verdict(design, about));

    page.section(
        "Predicted standard deviations",
        "Standard deviations that a calibration from a recording of the motion will state. The initial motion is what experience would \
         choose: random, within a tenth of the limits.",
    );
    page.push(promised_table(
        &design.parameters,
        ("initial motion", &design.initial),
        ("optimal motion", &design.optimal),
        design.certificate.as_ref().map(|certificate| certificate.sd_lower_bound.as_slice()),
    ));
    page.paragraph(&format!(
        "The design minimises criterion {}, {} (C is the covariance of the parameters{}).",
        design.criterion.letter(),
        design.criterion.formula(),
        design.criterion.scaling()
    ));
    page.push(criterion_table(design));
    if let Some(certificate) = &design.certificate {
        page.subsection("The lower bound");
        page.paragraph(&certificate.explanation);
        page.paragraph("Each standard deviation has its own bound. One motion need not reach all of them.");
    }

    let axes = axes(&design.parameters);
    page.section(
        "The motion",
        "The motion of the arm on each axis, with the limits that it keeps at all times.",
    );
    let motions =
        [Drawn::before("initial", &design.initial.motion), Drawn::after("optimal", &design.optimal.motion)];
    let title8 = "Figure 8 of the thesis: initial against optimal jerk (a) and acceleration (b)";
    page.push(jerk_and_acceleration(title8, &motions, axes, &design.limits).html());
    page.push(velocity_and_displacement(&motions, axes, &design.limits).html());
    if let Some(figure) = states(&motions, axes, &design.limits) {
        page.push(figure.html());
    }
    page.subsection("Use of the limits");
    page.push(limit_table(&limit_use(&design.limits, axes.len(), &design.optimal.motion), "optimal motion"));

    page.section("Confidence", "The uncertainty of the parameters, and which errors are correlated.");
    if let Some(figure) = confidence_ellipses(
        &design.parameters,
        ("initial", &design.initial),
        Some(("optimal", &design.optimal)),
    ) {
        page.push(figure.html());
    }
    match &design.optimal.covariance {
        Some(covariance) => page.push(correlation_map(&design.parameters, covariance)),
        None => page.paragraph("The motion does not determine the parameters, so they have no covariance."),
    }

    page.section("The search", "");
    search(&mut page, design);
    page.finish(title, &about.facts, &about.footer())
}

fn search(page: &mut Page, design: &Design) {
    page.paragraph(
        "The problem has many local optima. The search starts at many random motions and at the initial one, and keeps the best result.",
    );
    if design.starts.is_empty() {
        page.paragraph("There is no record of the starts.");
        return;
    }
    page.push(super::html::list(&starts::sentences(&design.starts, &design.criterion)));
    if let Some(figure) = start_values(&design.starts, &design.criterion) {
        page.push(figure.html());
    }
    page.push(starts::start_table(&design.starts, &design.criterion));
}
