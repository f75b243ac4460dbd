//! The tables of a design of poses on the console.

use super::table::gap;
use crate::console;
use calibrant::design::poses::{PoseDesign, PoseEvaluation, PoseProblem};
use calibrant::report::design_in_words;
use calibrant::report::number_format::{counted, significant};
use calibrant::sensor::ReadingUnit;
use nalgebra::DMatrix;

/// Poses, parameters and the efficiency.
pub(super) fn design(
    design: &PoseDesign,
    problem: &PoseProblem,
    unit: ReadingUnit,
    words: &[String],
) -> String {
    let rows: Vec<_> = design
        .directions
        .iter()
        .zip(words)
        .enumerate()
        .map(|(k, (u, words))| {
            let component = |value: f64| format!("{:.4}", value + 0.0).replace("-0.0000", "0.0000");
            vec![(k + 1).to_string(), words.clone(), component(u.x), component(u.y), component(u.z)]
        })
        .collect();
    let criterion = &problem.criterion;
    let sentence = format!(
        "{} {} of {} ended at this value.",
        design_in_words(design, design.efficiency(criterion)),
        design.starts_at_best,
        counted(design.starts, "start")
    );
    format!(
        "{} (gap {})\n{}\n{}{}",
        reached(problem, design.value, design.bound.value),
        gap(criterion, criterion.gap(design.value, design.bound.value)),
        console::table(&["pose", "how", "up x", "up y", "up z"], &rows),
        parameters(problem, unit, &design.covariance),
        console::paragraph(&sentence)
    )
}

/// The standard deviations to expect.
fn parameters(problem: &PoseProblem, unit: ReadingUnit, covariance: &DMatrix<f64>) -> String {
    let before = problem.covariance_before();
    let rows: Vec<_> = problem
        .list
        .quantities()
        .iter()
        .enumerate()
        .map(|(k, quantity)| {
            let sd = |covariance: &DMatrix<f64>| significant(covariance[(k, k)].sqrt(), 4);
            let mut row = vec![quantity.name(), quantity.unit(unit).to_owned()];
            row.extend(before.as_ref().map(sd));
            row.push(sd(covariance));
            row
        })
        .collect();
    let header: &[&str] = if before.is_some() {
        &["parameter", "unit", "sd before", "sd then"]
    } else {
        &["parameter", "unit", "sd"]
    };
    console::table(header, &rows)
}

/// Parameters and criterion of recorded holds.
pub(super) fn evaluation(evaluation: &PoseEvaluation, problem: &PoseProblem, unit: ReadingUnit) -> String {
    format!(
        "{}\n{}",
        reached(problem, evaluation.value, evaluation.bound.value),
        parameters(problem, unit, &evaluation.covariance)
    )
}

/// The criterion, its value, and the value that no poses can beat.
fn reached(problem: &PoseProblem, value: f64, bound: f64) -> String {
    let criterion = &problem.criterion;
    format!(
        "criterion {} ({}{}): {}, at least {}",
        criterion.letter(),
        criterion.formula(),
        criterion.scaling(),
        significant(value, 5),
        significant(bound, 5)
    )
}
