//! How many poses are enough to determine the parameters, and the errors that say so.

use super::hold_information::HoldInformation;
use super::problem::{DirectionKnowledge, PoseProblem};
use calibrant_core::error::{Error, InputError, NotIdentifiable, Refusal, Result, UndeterminedGroup};
use calibrant_core::information::{Undetermined, undetermined};
use calibrant_core::simulate::{Purpose, stream};
use nalgebra::Vector3;

/// Random sets that are tried for each number of poses, to see whether it suffices.
const TRIED: usize = 20;
/// Most poses that are tried.
const MOST: usize = 100;

/// The fewest poses that determine all parameters, found by lot.
///
/// # Errors
/// [`Error::NotIdentifiable`] where the allowed directions leave parameters undetermined however many there are.
pub(super) fn fewest_that_determine(
    problem: &PoseProblem,
    information: &HoldInformation,
    seed: u64,
) -> Result<usize> {
    let free = |directions: &[Vector3<f64>]| {
        let f = information.of_parameters(&information.sum(directions.iter().map(|u| (u, 1.0))));
        undetermined(&f, &f.diagonal())
    };
    let (all, _) = problem.allowed.grid(8);
    let left = free(&all);
    if !left.is_empty() {
        let reason = "the allowed directions are not enough, however often each is held";
        let remedy = match problem.directions {
            DirectionKnowledge::Unknown => {
                "allow more directions in design.allowed, or say design.directions = \"known\""
            }
            DirectionKnowledge::Known { .. } => "allow more directions in design.allowed",
        };
        let groups = named(&left, &problem.list.names(), reason, remedy);
        return Err(Error::NotIdentifiable(Box::new(NotIdentifiable { groups })));
    }
    let mut rng = stream(seed, Purpose::Motion, 1);
    let mut suffices = |poses: usize| {
        (0..TRIED).any(|_| {
            let some: Vec<_> = (0..poses).map(|_| problem.allowed.draw(&mut rng)).collect();
            free(&some).is_empty()
        })
    };
    Ok((1..MOST).find(|&poses| suffices(poses)).unwrap_or(MOST))
}

/// Refuses too few poses, and directions that leave parameters undetermined.
pub(super) fn check(problem: &PoseProblem, information: &HoldInformation, seed: u64) -> Result<()> {
    let fewest = fewest_that_determine(problem, information, seed)?;
    if problem.poses >= fewest {
        return Ok(());
    }
    let group = UndeterminedGroup {
        parameters: Vec::new(),
        free_combinations: 0,
        reason: format!(
            "{} for {} parameters, which need at least {fewest}",
            if problem.poses == 1 { "one pose".into() } else { format!("{} poses", problem.poses) },
            problem.list.len()
        ),
        remedy: format!("hold the sensor in at least {fewest} poses"),
    };
    Err(Error::NotIdentifiable(Box::new(NotIdentifiable { groups: vec![group] })))
}

/// Groups of undetermined parameters with their names.
pub(super) fn named(
    groups: &[Undetermined],
    names: &[String],
    reason: &str,
    remedy: &str,
) -> Vec<UndeterminedGroup> {
    groups
        .iter()
        .map(|group| UndeterminedGroup {
            parameters: group.parameters.iter().map(|&k| names[k].clone()).collect(),
            free_combinations: group.free_combinations,
            reason: reason.into(),
            remedy: remedy.into(),
        })
        .collect()
}

pub(super) fn singular() -> Error {
    let help = "check the sensor's gain, or the calibration that the design begins with";
    Error::experiment(InputError::new(
        Refusal::CalibrationUnsuited,
        "the sensor's matrix has no inverse",
        help,
    ))
}
