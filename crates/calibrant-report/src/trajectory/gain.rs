//! What a motion can improve and what it cannot, in words.

use super::predicted::{mean_ratio, smaller};
use crate::number_format::{counted, significant};
use calibrant_core::estimate::{BudgetRow, VarianceSource};
use calibrant_machine::estimate::MountingPrior;
use calibrant_machine_design::{TrajectoryEvaluation, TrajectoryProblem};

/// From this part of a variance on, a source alone decides it.
const ALONE: f64 = 0.9;

/// The standard deviation that a known mount leaves.
fn with_known_mount(row: &BudgetRow) -> f64 {
    let others = VarianceSource::ALL.into_iter().filter(|of| *of != VarianceSource::Mounting);
    others.map(|of| row.part(of)).sum::<f64>().sqrt()
}

/// The places of parameters that this source alone limits.
fn limited_by(of: &TrajectoryEvaluation, source: VarianceSource) -> Vec<usize> {
    (0..of.budget.len()).filter(|k| of.budget[*k].share(source) >= ALONE).collect()
}

/// How much smaller standard deviations are than those of other trajectories: of those that the motion decides, then what limits the others, then by the criterion.
pub(super) fn gains(
    others: &[(&TrajectoryEvaluation, &str)],
    best: &TrajectoryEvaluation,
    problem: &TrajectoryProblem<'_>,
) -> String {
    let elsewhere =
        [VarianceSource::Mounting, VarianceSource::Gravity].map(|source| limited_by(best, source)).concat();
    let decided = |other: &TrajectoryEvaluation| -> Vec<f64> {
        let pairs = other.sd().into_iter().zip(best.sd()).enumerate();
        pairs.filter(|(k, _)| !elsewhere.contains(k)).map(|(_, (before, after))| before / after).collect()
    };
    let than = |of: &dyn Fn(&TrajectoryEvaluation) -> Option<f64>| {
        let each = others.iter().filter_map(|(other, name)| Some((of(other)?, name)));
        let each: Vec<String> =
            each.map(|(times, name)| format!("{} than with {name}", smaller(times))).collect();
        (!each.is_empty()).then(|| each.join(", and "))
    };
    let number = best.budget.len() - elsewhere.len();
    let which = match elsewhere.is_empty() {
        true => "Its standard deviations are".to_owned(),
        false if number == 1 => "The one standard deviation that the motion decides is".to_owned(),
        false => format!("The {number} standard deviations that the motion decides are"),
    };
    let in_the_mean = than(&|other| mean_ratio(&decided(other)))
        .map_or_else(String::new, |than| format!(" {which} in the mean {than}."));
    let by_mount =
        limited_by_mount(others.first(), best, problem).map_or_else(String::new, |text| format!(" {text}"));
    let by_criterion = than(&|other| Some(best.times_better_than(other))).map_or_else(String::new, |than| {
        let letter = problem.criterion.letter();
        format!(
            " By criterion {letter}, which counts all combinations of the parameters of a nominal sensor, all are {than}."
        )
    });
    format!("{in_the_mean}{by_mount}{by_criterion}")
}

/// Which parameters the mount alone limits, and what would change that; `None` where it limits none.
fn limited_by_mount(
    other: Option<&(&TrajectoryEvaluation, &str)>,
    best: &TrajectoryEvaluation,
    problem: &TrajectoryProblem<'_>,
) -> Option<String> {
    let MountingPrior::Within(sd_rad) = problem.setup.mounting else { return None };
    let places = limited_by(best, VarianceSource::Mounting);
    let left = |k: &usize| best.budget[*k].variance.sqrt() / with_known_mount(&best.budget[*k]);
    let times = mean_ratio(&places.iter().map(left).collect::<Vec<_>>())?;
    // `gyroscope.matrix` of its six entries
    let mut kinds: Vec<String> = Vec::new();
    for k in &places {
        let name = best.budget[*k].quantity.name();
        let kind = name.rsplit_once('.').map_or(name.as_str(), |(kind, _)| kind);
        if !kinds.iter().any(|of| of == kind) {
            kinds.push(kind.to_owned());
        }
    }
    let compared = other.and_then(|(other, name)| {
        let pairs = other.budget.iter().zip(&best.budget);
        let ratios: Vec<f64> =
            pairs.map(|(before, after)| with_known_mount(before) / with_known_mount(after)).collect();
        Some(format!(", and all of them {} than with {name}", smaller(mean_ratio(&ratios)?)))
    });
    Some(format!(
        "The mount, known to {}°, limits {} of {}, whatever the motion: of {}. Known exactly, as by a fixture with pins (`rotation_sd_deg = 0`), it would leave these about {} \
         times smaller{}. With `rotation = \"unknown\"`, and no `rotation_sd_deg`, the axes of the accelerometer are the frame, and do not depend on the mount.",
        significant(sd_rad.to_degrees(), 2),
        counted(places.len(), "standard deviation"),
        best.budget.len(),
        kinds.join(", "),
        significant(times, 2),
        compared.unwrap_or_default()
    ))
}
