//! What a motion can improve and what it cannot, in words.

use super::predicted::{mean_ratio, smaller, symmetric_ratios};
use crate::number_format::{counted, significant};
use calibrant_machine::estimate::{BudgetRow, MountingPrior, Source};
use calibrant_machine_design::{TrajectoryEvaluation, TrajectoryProblem};

/// From this part of a variance on, a source alone decides it.
const ALONE: f64 = 0.9;

/// The part of a variance that comes from a source.
fn part(row: &BudgetRow, source: Source) -> f64 {
    let of = Source::ALL.iter().zip(row.parts).find(|(of, _)| **of == source);
    of.map_or(0.0, |(_, part)| part / row.variance)
}

/// The places of parameters that this source alone limits.
fn limited_by(of: &TrajectoryEvaluation, source: Source) -> Vec<usize> {
    (0..of.budget.len()).filter(|k| part(&of.budget[*k], source) >= ALONE).collect()
}

/// How much smaller standard deviations are than those of another trajectory: first of those that the motion decides.
pub(super) fn gain(
    before: (&TrajectoryEvaluation, &str),
    best: &TrajectoryEvaluation,
    problem: &TrajectoryProblem<'_>,
) -> String {
    let (other, name) = before;
    let ratios: Vec<f64> = other.sd().iter().zip(best.sd()).map(|(before, after)| before / after).collect();
    let elsewhere = [Source::Mounting, Source::Gravity].map(|source| limited_by(best, source)).concat();
    let decided: Vec<f64> = (0..ratios.len()).filter(|k| !elsewhere.contains(k)).map(|k| ratios[k]).collect();
    let by_criterion =
        format!("{} by criterion {}", smaller(best.times_better_than(other)), problem.criterion.letter());
    let Some(of_decided) = mean_ratio(&decided) else {
        return format!(" Against {name}, its standard deviations are {by_criterion}.");
    };
    let mut words = match elsewhere.is_empty() {
        true => format!(" Against {name}, its standard deviations are {} in the mean", smaller(of_decided)),
        false => format!(
            " Against {name}, the {} that the motion decides are {} in the mean",
            counted(decided.len(), "standard deviation"),
            smaller(of_decided)
        ),
    };
    if let Some(times) = mean_ratio(&symmetric_ratios(other, best)).filter(|_| !elsewhere.is_empty()) {
        words += &format!(", those of the symmetric parts of the matrices {}", smaller(times));
    }
    words + &format!(", and all are {by_criterion}.")
}

/// Which parameters the mount alone limits, and what would change that; `None` where it limits none.
pub(super) fn limited_by_mount(
    best: &TrajectoryEvaluation,
    problem: &TrajectoryProblem<'_>,
) -> Option<String> {
    let MountingPrior::Within(sd_rad) = problem.setup.mounting else { return None };
    let places = limited_by(best, Source::Mounting);
    // the part of a variance that a known mount leaves
    let left = |k: &usize| (1.0 - part(&best.budget[*k], Source::Mounting)).max(1e-12).sqrt().recip();
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
    Some(format!(
        "The mount, known to {}°, limits {} of {}, whatever the motion: of {}. Known exactly, as by a fixture with pins (`rotation_sd_deg = 0`), it would leave them about {} times smaller. \
         With `rotation = \"unknown\"` the axes of the accelerometer are the frame, and they do not depend on the mount.",
        significant(sd_rad.to_degrees(), 2),
        counted(places.len(), "standard deviation"),
        best.budget.len(),
        kinds.join(", "),
        significant(times, 2)
    ))
}
