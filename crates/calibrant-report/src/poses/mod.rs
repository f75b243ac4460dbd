//! The sheet of poses: verdict, a checklist with pictures, predicted standard deviations, directions.

mod attitude;

pub use attitude::pose_in_words;

use super::design::{criterion_explained, criterion_in_words, gap_in_words};
use super::figure::{DisplayUnit, device, pose_directions};
use super::gravity::{advice, known_to};
use super::html::escape;
use super::report_context::{About, READINGS};
use crate::number_format::{capitalised, counted, signed, significant};
use crate::sheet::{Cell, Column, Grade, Section, Sheet, SheetVerdict, Shown, Table};
use attitude::Attitude;
use calibrant_core::motion::Gravity;
use calibrant_core::sensor::ReadingUnit;
use calibrant_design::poses::{PoseBound, PoseDesign, PoseEvaluation, PoseProblem, UsualPoses};
use nalgebra::{DMatrix, Vector3};

/// Efficiency from which on nothing is left to gain.
const AS_GOOD_AS_ANY: f64 = 0.99;
/// Efficiency below which another set of poses is worth its while.
const WORTH_CHANGING: f64 = 0.7;

/// The best poses as a sheet, whose page can be printed and ticked off.
#[must_use]
pub fn pose_sheet<'a>(
    design: &'a PoseDesign,
    problem: &'a PoseProblem,
    unit: ReadingUnit,
    about: &'a About,
) -> Sheet<'a> {
    let criterion = &problem.criterion;
    let efficiency = design.efficiency(criterion);
    let word = if efficiency >= AS_GOOD_AS_ANY { "✓ As good as any, to 1 %." } else { "✓ Found." };
    let sentence = design_in_words(design, efficiency);
    let verdict =
        SheetVerdict::new(Grade::Good, word, sentence.clone()).with("Findings", about.findings.clone());
    let mut predicted = predicted_section(&design.covariance, problem, unit, design.value, &design.bound);
    predicted.line(format!(
        "{} of {} ended at this value (gap {}).",
        design.starts_at_best,
        counted(design.starts, "start"),
        gap_in_words(criterion, criterion.gap(design.value, design.bound.value))
    ));
    let mut poses = Section::new("The poses").lead(
        "Hold the device still in each pose, in this order. The room is drawn with its vertical upwards. Turns are right-handed, about \
         the device's own axes as they lie then.",
    );
    poses.explanation(if problem.nuisance.has_gyroscope {
        "The order is chosen so that the turns between the poses determine the gyroscope, and a drift of the biases looks least like a \
         parameter. Turn from each pose to the next by the shortest way, and without a pause on it."
    } else {
        "In this order a drift of the biases looks least like a parameter, and little turning is needed."
    });
    poses.table(pose_table(&design.directions));
    poses.drawn(|| checklist(&design.directions));
    let sections = vec![predicted, poses, direction_section(&design.directions, &design.bound)];
    about.sheet("Poses", verdict, sections, READINGS)
}

fn design_in_words(design: &PoseDesign, efficiency: f64) -> String {
    let poses = design.directions.len();
    let (have, any) = if poses == 1 {
        ("The pose has".to_owned(), "any allowed pose".to_owned())
    } else {
        (format!("The {poses} poses have"), format!("any {poses} allowed poses"))
    };
    let mut sentence = format!(
        "{have} at least {} % of the information that {any} can have.",
        significant(100.0 * efficiency, 4)
    );
    for UsualPoses { name, information_over } in &design.usual {
        sentence.push_str(&match information_over {
            Some(times) => {
                format!(" The designed ones have {} times the information of {name}.", significant(*times, 3))
            }
            None => format!(" {} leave parameters undetermined.", capitalised(name)),
        });
    }
    sentence
}

/// The evaluation of holds as a sheet: how efficient they were. `directions`: that of each hold.
#[must_use]
pub fn pose_evaluation_sheet<'a>(
    evaluation: &'a PoseEvaluation,
    directions: &'a [Vector3<f64>],
    problem: &'a PoseProblem,
    unit: ReadingUnit,
    about: &'a About,
) -> Sheet<'a> {
    let (grade, word) = match evaluation.efficiency {
        efficiency if efficiency >= AS_GOOD_AS_ANY => (Grade::Good, "✓ As good as any, to 1 %."),
        efficiency if efficiency >= WORTH_CHANGING => (Grade::Good, "✓ Good poses."),
        _ => (Grade::Caution, "! Better poses may exist."),
    };
    let predicted =
        predicted_section(&evaluation.covariance, problem, unit, evaluation.value, &evaluation.bound);
    let verdict = SheetVerdict::new(grade, word, evaluation_in_words(evaluation, directions.len()));
    let sections = vec![predicted, direction_section(directions, &evaluation.bound)];
    about.sheet("Evaluation of poses", verdict, sections, READINGS)
}

/// The efficiency of holds in a sentence or two.
fn evaluation_in_words(evaluation: &PoseEvaluation, holds: usize) -> String {
    let efficiency = evaluation.efficiency;
    let more = if efficiency < AS_GOOD_AS_ANY {
        format!(
            " At most {} recordings in these directions tell as much as one in the best.",
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
            let number = |value: f64| signed(value, 3);
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

/// Each pose in words, with the direction that is up, for terminals.
fn pose_table(directions: &[Vector3<f64>]) -> Table {
    let mut table = Table::new(["pose", "how", "up x", "up y", "up z"]).shown(Shown::OnTerminal);
    for (k, up) in directions.iter().enumerate() {
        // no component is −0.0000
        let component = |value: f64| Cell::fixed(if value.abs() < 5e-5 { 0.0 } else { value }, 4);
        let mut row = vec![Cell::name((k + 1).to_string()), Cell::text(pose_in_words(up))];
        row.extend(up.iter().map(|value| component(*value)));
        table.row(row);
    }
    table
}

/// The standard deviations from this covariance, and what they are compared by. The criterion has this value.
fn predicted_section<'a>(
    covariance: &DMatrix<f64>,
    problem: &PoseProblem,
    unit: ReadingUnit,
    value: f64,
    bound: &PoseBound,
) -> Section<'a> {
    let criterion = &problem.criterion;
    let mut section = Section::new("Predicted standard deviations").lead(
        "Standard deviations that a calibration from these poses will state, if the noise is as assumed. They include the uncertainty of \
         gravity, and of a drift of the biases while the poses are taken in this order.",
    );
    section.line(format!(
        "{}: {}, at least {}",
        criterion_in_words(criterion),
        significant(value, 5),
        significant(bound.value, 5)
    ));
    section.table(predicted(problem, covariance, unit));
    if !problem.gravity_is_given() {
        let gravity =
            Gravity { magnitude_mps2: problem.gravity_mps2, sd_mps2: problem.nuisance.gravity_sd_mps2 };
        section.line(format!(
            "gravity is not given: all scale factors share its error of {}, which no pose changes; {}",
            known_to(&gravity),
            advice(&gravity)
        ));
    }
    section.explanation(format!("The poses are compared by {}.", criterion_explained(criterion)));
    section
}

/// The directions, and how the bound is meant.
fn direction_section<'a>(directions: &'a [Vector3<f64>], bound: &'a PoseBound) -> Section<'a> {
    let mut section = Section::on_page("The directions");
    section.figure(|| Some(pose_directions(directions, &bound.directions)));
    section.heading_on_page("The lower bound");
    section.explanation(
        "The bound is that of the approximate design, in which any share of the recording may be spent in each direction. By the \
         equivalence theorem of Kiefer and Wolfowitz no set of poses can be better. Where directions are not a list, they are examined on \
         a grid, and the bound is 0.07 % low.",
    );
    section
}

fn predicted(problem: &PoseProblem, covariance: &DMatrix<f64>, reading: ReadingUnit) -> Table {
    let before = problem.covariance_before();
    let beside = (!problem.gravity_is_given()).then(|| problem.sd_beside_gravity(covariance));
    let mut columns: Vec<Column> = vec!["parameter".into(), "unit".into()];
    match before {
        Some(_) => columns.extend(["sd before".into(), "sd then".into()]),
        None => columns.push("predicted sd".into()),
    }
    columns.extend(beside.as_ref().map(|_| "beside gravity".into()));
    let mut table = Table::new(columns);
    for (k, quantity) in problem.list.quantities().iter().enumerate() {
        let sd = covariance[(k, k)].sqrt();
        let unit = DisplayUnit::suited_to(quantity.unit(reading), [sd]);
        let mut row = vec![Cell::name(quantity.name()), unit.cell(quantity.unit(reading))];
        row.extend(before.as_ref().map(|before| Cell::sd(before[(k, k)].sqrt(), unit.factor)));
        row.push(Cell::sd(sd, unit.factor));
        row.extend(beside.as_ref().map(|beside| Cell::sd(beside[k], unit.factor)));
        table.row(row);
    }
    table
}
