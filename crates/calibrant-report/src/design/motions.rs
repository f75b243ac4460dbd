//! Sections on motions: their curves with the limits, and the confidence that they give.

use super::limits::limit_table;
use crate::figure::{
    Drawn, confidence_ellipses, correlation_map, drawn, jerk_and_acceleration, states,
    velocity_and_displacement,
};
use crate::sheet::Section;
use calibrant_core::motion::Limits;
use calibrant_core::sensor::{Axis, Parameter};
use calibrant_design::{Evaluation, LimitUse};

/// A motion with its name: the one before, and the best.
pub(crate) type Named<'a> = (&'static str, &'a Evaluation);

/// The motions of the arm on each axis, with the limits and how far the motion of this name uses them.
pub(crate) fn motion_section<'a>(
    lead: &str,
    title: &'static str,
    motions: Vec<Drawn<'a>>,
    axes: &'static [Axis],
    limits: Limits,
    (uses, name): (&[LimitUse], &str),
) -> Section<'a> {
    let mut section = Section::on_page("The motion").lead(lead);
    section.drawn(move || motion_figures(title, &motions, axes, &limits));
    section.heading_on_page("Use of the limits");
    if uses.is_empty() {
        section.paragraph("There are no limits.");
    }
    section.table(limit_table(uses, name));
    section
}

/// The figures of motions with their limits.
pub(crate) fn motion_figures(title: &str, motions: &[Drawn<'_>], axes: &[Axis], limits: &Limits) -> String {
    drawn([
        &|| Some(jerk_and_acceleration(title, motions, axes, limits)),
        &|| Some(velocity_and_displacement(motions, axes, limits)),
        &|| states(motions, axes, limits),
    ])
    .concat()
}

/// The ellipses of both motions, and the correlations of one.
pub(crate) fn confidence_section<'a>(
    parameters: &'a [Parameter],
    before: Named<'a>,
    after: Option<Named<'a>>,
    correlated: &'a Evaluation,
) -> Section<'a> {
    let mut section = Section::on_page("Confidence")
        .lead("The uncertainty of the parameters, and which errors are correlated.");
    section.figure(move || confidence_ellipses(parameters, before, after));
    match &correlated.covariance {
        Some(covariance) => section.drawn(move || {
            correlation_map(parameters.iter().map(|parameter| parameter.name.as_str()), covariance)
        }),
        None => {
            section.paragraph("The motion does not determine the parameters, so they have no covariance.")
        }
    }
    section
}
