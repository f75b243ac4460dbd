//! The report page on poses: verdict, a checklist with pictures, predicted standard deviations, directions.

mod attitude;

pub use attitude::pose_in_words;

use super::About;
use super::figure::{DisplayUnit, device, pose_directions};
use super::html::{Page, escape, verdict_box};
use super::number_format::{self, significant};
use crate::sheet::{Cell, Table};
use attitude::Attitude;
use calibrant_core::sensor::ReadingUnit;
use calibrant_design::poses::{PoseBound, PoseDesign, PoseEvaluation, PoseProblem};
use nalgebra::{DVector, Vector3};

/// Efficiency from which on nothing is left to gain.
const AS_GOOD_AS_ANY: f64 = 0.99;
/// Efficiency below which another set of poses is worth its while.
const WORTH_CHANGING: f64 = 0.7;

/// The best poses as one HTML file that can be printed and ticked off. Self-contained.
#[must_use]
pub fn pose_report(design: &PoseDesign, problem: &PoseProblem, unit: ReadingUnit, about: &About) -> String {
    let efficiency = design.efficiency(&problem.criterion);
    let word = if efficiency >= AS_GOOD_AS_ANY { "✓ As good as any." } else { "✓ Found." };
    let sentence = design_in_words(design, efficiency);
    let verdict = verdict_box("good", word, &sentence, &[("Findings", about.findings.clone())]);
    let mut page = Page::opened(&about.title, verdict);
    predicted_section(&mut page, &design.sd(), problem, unit);
    page.section(
        "The poses",
        "Hold the device still in each pose, in this order. The room is drawn with its vertical upwards. Turns are right-handed, about \
         the device's own axes as they lie then.",
    );
    page.paragraph(if problem.nuisance.has_gyroscope {
        "The order is chosen so that the turns between the poses determine the gyroscope, and a drift of the biases looks least like a \
         parameter. Turn from each pose to the next by the shortest way, and without a pause on it."
    } else {
        "In this order a drift of the biases looks least like a parameter, and little turning is needed."
    });
    page.push(checklist(&design.directions));
    direction_section(&mut page, &design.directions, &design.bound);
    page.finish(&about.title, &about.facts, &about.footer())
}

/// The efficiency of designed poses in a sentence.
#[must_use]
pub fn design_in_words(design: &PoseDesign, efficiency: f64) -> String {
    let poses = design.directions.len();
    let (have, any) = if poses == 1 {
        ("The pose has".to_owned(), "any allowed pose".to_owned())
    } else {
        (format!("The {poses} poses have"), format!("any {poses} allowed poses"))
    };
    format!(
        "{have} at least {} % of the information that {any} can have.",
        significant(100.0 * efficiency, 4)
    )
}

/// The evaluation of holds as one HTML file: how efficient they were. `directions`: that of each hold.
#[must_use]
pub fn pose_evaluation_report(
    evaluation: &PoseEvaluation,
    directions: &[Vector3<f64>],
    problem: &PoseProblem,
    unit: ReadingUnit,
    about: &About,
) -> String {
    let efficiency = evaluation.efficiency;
    let (class, word) = match efficiency {
        _ if efficiency >= AS_GOOD_AS_ANY => ("good", "✓ As good as any."),
        _ if efficiency >= WORTH_CHANGING => ("good", "✓ Good poses."),
        _ => ("caution", "! Better poses exist."),
    };
    let verdict = verdict_box(class, word, &evaluation_in_words(evaluation, directions.len()), &[]);
    let mut page = Page::opened(&about.title, verdict);
    predicted_section(&mut page, &evaluation.sd(), problem, unit);
    direction_section(&mut page, directions, &evaluation.bound);
    page.finish(&about.title, &about.facts, &about.footer())
}

/// The efficiency of holds in a sentence or two.
#[must_use]
pub fn evaluation_in_words(evaluation: &PoseEvaluation, holds: usize) -> String {
    let efficiency = evaluation.efficiency;
    let more = if efficiency < AS_GOOD_AS_ANY {
        format!(
            " {} recordings in these directions tell as much as one in the best.",
            significant(1.0 / efficiency, 3)
        )
    } else {
        String::new()
    };
    format!(
        "Efficiency {} %: the {holds} holds have at least this share of the information that any {holds} directions can have.{more}",
        significant(100.0 * efficiency, 3)
    )
}

/// A card for each pose: a box to tick, the picture, the words, the unit vector.
fn checklist(directions: &[Vector3<f64>]) -> String {
    let cards: String = directions
        .iter()
        .enumerate()
        .map(|(k, u)| {
            let attitude = Attitude::of(u);
            let number = |value: f64| number_format::signed(value, 3);
            format!(
                "<li><p><span class=\"box\"></span> <strong>{}</strong></p>{}<p>{}</p><p class=\"up\">up: ({}, {}, {})</p></li>",
                k + 1,
                device(attitude.room_from_sensor(), &attitude.words()),
                escape(&attitude.words()),
                number(u.x),
                number(u.y),
                number(u.z)
            )
        })
        .collect();
    format!("<ol class=\"poses\">{cards}</ol>")
}

/// The standard deviations, and what they are compared by.
fn predicted_section(page: &mut Page, sd: &DVector<f64>, problem: &PoseProblem, unit: ReadingUnit) {
    page.section(
        "Predicted standard deviations",
        "Standard deviations that a calibration from these poses will state, if the noise is as assumed. They include the uncertainty of \
         gravity, and of a drift of the biases while the poses are taken in this order.",
    );
    page.push(predicted(problem, sd, unit));
    let criterion = &problem.criterion;
    page.paragraph(&format!(
        "The poses are compared by criterion {}, {} (C is the covariance of the parameters{}).",
        criterion.letter(),
        criterion.formula(),
        criterion.scaling()
    ));
}

/// The directions, and how the bound is meant.
fn direction_section(page: &mut Page, directions: &[Vector3<f64>], bound: &PoseBound) {
    page.section("The directions", "");
    page.push(pose_directions(directions, &bound.directions));
    page.subsection("The lower bound");
    page.paragraph(
        "The bound is that of the approximate design, in which any share of the recording may be spent in each direction. By the \
         equivalence theorem of Kiefer and Wolfowitz no set of poses can be better. Where directions are not a list, they are examined on \
         a grid, and the bound is 0.07 % low.",
    );
}

fn predicted(problem: &PoseProblem, sd: &DVector<f64>, reading: ReadingUnit) -> String {
    let before = problem.covariance_before();
    let header: &[&str] = if before.is_some() {
        &["parameter", "unit", "sd before", "sd then"]
    } else {
        &["parameter", "unit", "predicted sd"]
    };
    let mut table = Table::new(header.iter().copied());
    for (k, (quantity, sd)) in problem.list.quantities().iter().zip(sd.iter()).enumerate() {
        let unit = DisplayUnit::suited_to(quantity.unit(reading), [*sd]);
        let symbol = if unit.symbol.is_empty() { number_format::UNKNOWN } else { unit.symbol };
        let number = |sd: f64| Cell::Number(significant(sd * unit.factor, 4));
        let mut row = vec![Cell::Name(quantity.name()), Cell::Text(symbol.into())];
        row.extend(before.as_ref().map(|before| number(before[(k, k)].sqrt())));
        row.push(number(*sd));
        table.row(row);
    }
    table.html()
}
