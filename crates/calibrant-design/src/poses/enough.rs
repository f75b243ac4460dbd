//! How many poses are enough to determine the parameters, and the errors that say so.

use super::hold_information::{HoldInformation, Sum};
use super::problem::{DirectionKnowledge, PoseProblem};
use calibrant_core::error::{Error, InputError, NotIdentifiable, Refusal, Result, UndeterminedGroup};
use calibrant_core::information::{Undetermined, undetermined};
use nalgebra::{DMatrix, Vector3};

/// The fewest poses that determine all parameters: what any set needs, and a set that does.
pub(super) struct Enough {
    /// Fewer poses leave parameters undetermined, whatever their directions: a hold adds at most its own rank to that of the information.
    pub(super) at_least: usize,
    /// Allowed directions that determine all parameters, none of them twice. One direction a hold, they are as few as any.
    pub(super) set: Vec<Vector3<f64>>,
}

/// The fewest poses that determine all parameters.
///
/// # Errors
/// [`Error::NotIdentifiable`] where the allowed directions leave parameters undetermined however many there are.
pub(super) fn enough(problem: &PoseProblem, information: &HoldInformation) -> Result<Enough> {
    let reason = "the allowed directions are not enough, however often each is held";
    let all = problem.allowed.sample();
    let left = left_free(information, &all);
    if !left.is_empty() {
        let remedy = match problem.directions {
            DirectionKnowledge::Unknown => {
                "allow more directions in design.allowed, or say design.directions = \"known\""
            }
            DirectionKnowledge::Known { .. } => "allow more directions in design.allowed",
        };
        let groups = named(&left, &problem.list.names(), reason, remedy);
        return Err(Error::NotIdentifiable(Box::new(NotIdentifiable { groups })));
    }
    let free: usize = left_free(information, &[]).iter().map(|group| group.free_combinations).sum();
    let of_one = match problem.directions {
        DirectionKnowledge::Unknown => 1,
        DirectionKnowledge::Known { .. } => 3,
    };
    let set = completed(information, &[], &all);
    Ok(Enough { at_least: free.div_ceil(of_one).max(1), set })
}

/// What these directions leave undetermined.
fn left_free(information: &HoldInformation, directions: &[Vector3<f64>]) -> Vec<Undetermined> {
    let f = information.of_parameters(&information.sum(directions.iter().map(|u| (u, 1.0))));
    undetermined(&f, &f.diagonal(), 0)
}

/// As many directions as are needed to determine all parameters: of `first` as far as they add to the rank, then of `pool`.
///
/// The next is the one that raises `det(M + ε)` most, with parameters scaled to their information in the pool.
fn completed(
    information: &HoldInformation,
    first: &[Vector3<f64>],
    pool: &[Vector3<f64>],
) -> Vec<Vector3<f64>> {
    /// What stands for no information: far below that of a direction, far above rounding.
    const NOTHING: f64 = 1e-11;
    let of = |u: &Vector3<f64>| information.sum(std::iter::once((u, 1.0)));
    let reference = information.of_parameters(&information.sum(pool.iter().map(|u| (u, 1.0))));
    let scale = reference.diagonal().map(|of_all| if of_all > 0.0 { of_all.sqrt().recip() } else { 1.0 });
    let height = |sum: &Sum| {
        let f = information.of_parameters(sum);
        let scaled = DMatrix::from_fn(f.nrows(), f.nrows(), |i, j| {
            f[(i, j)] * scale[i] * scale[j] + if i == j { NOTHING } else { 0.0 }
        });
        scaled.cholesky().map_or(f64::NEG_INFINITY, |root| 2.0 * root.l().diagonal().map(f64::ln).sum())
    };
    let mut kept: Vec<Vector3<f64>> = Vec::new();
    let mut sum = information.nothing();
    while kept.len() < scale.len() && !left_free(information, &kept).is_empty() {
        let here = height(&sum);
        let best_of = |list: &[Vector3<f64>]| {
            let with = |u: &Vector3<f64>| {
                let mut with = sum.clone();
                with += &of(u);
                with
            };
            let raised = list.iter().map(|u| (height(&with(u)) - here, *u));
            raised.max_by(|one, other| one.0.total_cmp(&other.0))
        };
        // a direction in which there is nothing yet raises the determinant by much more than another
        let raises_rank = |(raised, _): &(f64, Vector3<f64>)| *raised > -0.5 * NOTHING.ln();
        let Some((_, next)) = best_of(first).filter(raises_rank).or_else(|| best_of(pool)) else { break };
        sum += &of(&next);
        kept.push(next);
    }
    kept
}

/// As many poses as these, some of them replaced by others of the pool where they leave parameters undetermined.
pub(super) fn made_regular(
    information: &HoldInformation,
    poses: Vec<Vector3<f64>>,
    pool: &[Vector3<f64>],
) -> Vec<Vector3<f64>> {
    if left_free(information, &poses).is_empty() {
        return poses;
    }
    let count = poses.len();
    completed(information, &poses, pool).into_iter().chain(poses).take(count).collect()
}

/// Refuses too few poses, and directions that leave parameters undetermined.
pub(super) fn check(problem: &PoseProblem, information: &HoldInformation) -> Result<()> {
    let at_least = enough(problem, information)?.at_least;
    if problem.poses >= at_least {
        return Ok(());
    }
    let count = counted_poses(problem.poses);
    let reason = format!("{count} for {} parameters, which need at least {at_least}", problem.list.len());
    Err(too_few(reason, at_least))
}

/// No set that was tried determines all parameters.
pub(super) fn none_found(problem: &PoseProblem, information: &HoldInformation, tried: usize) -> Error {
    let enough = match enough(problem, information) {
        Ok(enough) => enough.set.len(),
        Err(error) => return error,
    };
    let count = counted_poses(problem.poses);
    too_few(format!("of {tried} sets of {count} that were tried, none determines all parameters"), enough)
}

fn counted_poses(count: usize) -> String {
    if count == 1 { "one pose".into() } else { format!("{count} poses") }
}

fn too_few(reason: String, enough: usize) -> Error {
    let remedy = format!("hold the sensor in {enough} poses or more");
    let group = UndeterminedGroup { parameters: Vec::new(), free_combinations: 0, reason, remedy };
    Error::NotIdentifiable(Box::new(NotIdentifiable { groups: vec![group] }))
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
