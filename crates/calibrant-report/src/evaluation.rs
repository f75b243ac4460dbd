//! The report page on a user's motion, compared with the best motion and the limits.

use super::About;
use super::design::{axes, limit_table, promised_table, times, undetermined_items, violation};
use super::figure::{
    DisplayUnit, Drawn, confidence_ellipses, correlation_map, jerk_and_acceleration, states,
    velocity_and_displacement,
};
use super::html::{Page, verdict_box};
use super::number_format;
use crate::sheet::{Cell, Table};
use calibrant_core::motion::Limits;
use calibrant_core::sensor::Parameter;
use calibrant_design::{Assessment, Design, LimitKind, LimitUse, OtherSetting};
use nalgebra::Vector3;

/// A motion is as good as the best if all its standard deviations are within this factor.
const AS_GOOD: f64 = 1.05;
/// An efficiency above this may hide large improvements of single parameters.
const BLIND: f64 = 0.8;
/// A better motion is worth the effort beyond this factor.
const WORTH_IT: f64 = 1.5;

/// A user's motion as one HTML file: a verdict, and its predicted standard deviations beside those of the best motion
/// found. It lists broken limits and undetermined parameters.
///
/// Self-contained as [`Sheet::html`](crate::Sheet::html) is.
#[must_use]
pub fn evaluation_report(assessment: &Assessment, about: &About) -> String {
    let title = if about.title.is_empty() { "Evaluation of a motion" } else { &about.title };
    let mut page = Page::opened(title, verdict(assessment, about));

    let (own, parameters) = (&assessment.evaluation, &assessment.parameters);
    let optimum = assessment.optimum.as_ref().ok();
    page.section(
        "Predicted standard deviations",
        "A calibration from a recording of the motion has these standard deviations.",
    );
    match optimum {
        Some(design) => {
            let bound = design.certificate.as_ref().map(|certificate| certificate.sd_lower_bound.as_slice());
            page.push(promised_table(
                parameters,
                ("your motion", own),
                ("optimal motion", &design.optimal),
                bound,
            ));
        }
        None => page.push(own_table(parameters, &own.sd())),
    }
    page.push(criterion_table(assessment));

    let (axes, limits) = (axes(parameters), drawn_limits(&assessment.limits));
    page.section("The motion", "The motion of the arm on each axis, with the limits.");
    let mut motions = vec![Drawn::before("your motion", &own.motion)];
    motions.extend(optimum.map(|design| Drawn::after("optimal", &design.optimal.motion)));
    page.push(jerk_and_acceleration("Jerk (a) and acceleration (b)", &motions, axes, &limits).html());
    page.push(velocity_and_displacement(&motions, axes, &limits).html());
    if let Some(figure) = states(&motions, axes, &limits) {
        page.push(figure.html());
    }
    page.subsection("Use of the limits");
    page.push(limit_table(&assessment.limits, "motion"));

    page.section("Confidence", "The uncertainty of the parameters, and which errors are correlated.");
    let best = optimum.map(|design| ("optimal", &design.optimal));
    let ellipses = confidence_ellipses(parameters, ("your motion", own), best);
    if let Some(figure) = ellipses {
        page.push(figure.html());
    }
    match &own.covariance {
        Some(covariance) => page.push(correlation_map(parameters, covariance)),
        None => page.paragraph("The motion does not determine the parameters, so they have no covariance."),
    }
    page.finish(title, &about.facts, &about.footer())
}

fn verdict(assessment: &Assessment, about: &About) -> String {
    let broken: Vec<String> = assessment.violations().iter().map(violation).collect();
    let mut sentences = Vec::new();
    let determined = assessment.evaluation.covariance.is_some();
    let factor = match &assessment.optimum {
        Ok(design) if determined => compared(assessment, design, &mut sentences),
        Ok(_) => None,
        Err(why) => {
            sentences.push(format!("No best motion is available for a comparison: {why}."));
            None
        }
    };
    if let Some(other) = &assessment.other_setting {
        sentences.push(not_alike(other));
    }
    let (class, word) = match factor {
        _ if !determined => {
            sentences.insert(
                0,
                "No recording of this motion can calibrate the sensor: it leaves parameters undetermined."
                    .into(),
            );
            ("bad", "✗ Useless for calibration.")
        }
        _ if !broken.is_empty() => ("bad", "✗ Breaks limits."),
        Some(factor) if factor <= AS_GOOD => ("good", "✓ As good as the best motion found."),
        Some(factor) if factor <= WORTH_IT => ("good", "✓ Usable, a little better is possible."),
        Some(_) => ("caution", "! Usable, but a better motion is worth the effort."),
        None => ("good", "✓ Usable."),
    };
    let remarks = [
        ("Broken limits", broken),
        ("Undetermined", undetermined_items(&assessment.evaluation)),
        ("Findings", about.findings.clone()),
    ];
    verdict_box(class, word, &sentences.join(" "), &remarks)
}

/// Adds the comparison with the best motion. Returns the largest factor of improvement.
fn compared(assessment: &Assessment, design: &Design, sentences: &mut Vec<String>) -> Option<f64> {
    let factors =
        assessment.evaluation.sd().into_iter().zip(design.optimal.sd()).map(|(own, best)| own / best);
    let (parameter, most) = assessment
        .parameters
        .iter()
        .zip(factors)
        .filter(|(_, factor)| factor.is_finite())
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    sentences.push(if most <= AS_GOOD {
        "The best motion found improves no parameter by more than a few per cent.".to_string()
    } else {
        format!(
            "The best motion found makes the standard deviation of {} {} times smaller. Other parameters improve at most as much.",
            parameter.name,
            times(most).trim_end_matches(" ×")
        )
    });
    if let Some(efficiency) = assessment.efficiency() {
        let mut sentence = format!(
            "By criterion {}, its efficiency is {}: 100 recordings of it give as much information as {} of the best motion",
            assessment.criterion.letter(),
            number_format::percent(efficiency),
            number_format::significant(100.0 * efficiency, 2)
        );
        if let Some(certain) = assessment.certain_efficiency() {
            sentence.push_str(&format!(
                ". Against the lower bound, the efficiency is {}",
                number_format::percent(certain)
            ));
        }
        sentences.push(sentence + ".");
        if efficiency > BLIND && most > WORTH_IT {
            sentences.push(
                "The criterion hardly shows the difference, since parameters that no motion improves dominate it. Judge by the standard \
                 deviations."
                    .to_string(),
            );
        }
    }
    Some(most)
}

fn not_alike(other: &OtherSetting) -> String {
    format!(
        "The motion takes {} s in {}, but the best motion is for the experiment's {} s in {}.",
        number_format::short(other.duration_s),
        number_format::counted(other.intervals, "interval"),
        number_format::short(other.experiment_duration_s),
        number_format::counted(other.experiment_intervals, "interval")
    )
}

fn own_table(parameters: &[Parameter], sd: &[f64]) -> String {
    let mut table = Table::new(["parameter", "unit", "sd"]);
    for (parameter, &sd) in parameters.iter().zip(sd) {
        let unit = DisplayUnit::suited_to(parameter.unit, [sd]);
        let symbol = if unit.symbol.is_empty() { number_format::UNKNOWN } else { unit.symbol };
        let shown = if sd.is_finite() {
            number_format::significant(sd * unit.factor, 4)
        } else {
            "undetermined".into()
        };
        table.row(vec![
            Cell::Name(parameter.name.clone()),
            Cell::Text(symbol.to_string()),
            Cell::Number(shown),
        ]);
    }
    table.html()
}

fn criterion_table(assessment: &Assessment) -> String {
    let name = format!(
        "criterion {}, {}{}",
        assessment.criterion.letter(),
        assessment.criterion.formula(),
        assessment.criterion.scaling()
    );
    let mut table = Table::new([name.as_str(), "value", "efficiency of your motion"]);
    let mut row = |name: &str, value: f64, efficiency: Option<f64>| {
        table.row(vec![
            Cell::Name(name.to_string()),
            Cell::Number(number_format::significant(value, 6)),
            Cell::Number(
                efficiency.map_or_else(|| number_format::UNKNOWN.to_string(), number_format::percent),
            ),
        ]);
    };
    row("your motion", assessment.evaluation.value, None);
    if let Ok(design) = &assessment.optimum {
        row("optimal motion", design.optimal.value, assessment.efficiency());
        if let Some(certificate) = &design.certificate {
            row("lower bound", certificate.lower_bound, assessment.certain_efficiency());
        }
    }
    table.html()
}

/// The limits to draw, from how far they are used.
fn drawn_limits(uses: &[LimitUse]) -> Limits {
    let mut limits = Limits::default();
    for found in uses {
        let slot = match found.kind {
            LimitKind::Acceleration => &mut limits.acceleration_mps2,
            LimitKind::Jerk => &mut limits.jerk_mps3,
            LimitKind::Intercept => &mut limits.intercept_mps2,
            LimitKind::Velocity => &mut limits.velocity_mps,
            LimitKind::Displacement => &mut limits.displacement_m,
            LimitKind::RestAtEnd | LimitKind::StartAcceleration | LimitKind::EndAcceleration => continue,
        };
        slot.get_or_insert_with(Vector3::zeros)[found.axis.index()] = found.limit;
    }
    limits
}
