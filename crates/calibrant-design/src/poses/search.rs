//! The search for the best n poses: many starts, exchange, descent.
//!
//! Half of the starts are random. The others take poses from the approximate design, by their shares. Each is
//! improved by exchange, over the allowed list or the directions of the approximate design, and then by
//! descent where directions may move. The best is kept.

use super::approximate::{Approximate, approximate};
use super::exchange::exchange;
use super::hold_information::HoldInformation;
use super::problem::PoseProblem;
use super::result::{PoseBound, PoseDesign};
use super::spectral_projected_gradient::{Descent, Poses};
use super::{Allowed, DirectionKnowledge};
use crate::smooth_criterion::SmoothCriterion;
use crate::{AT_BEST, DesignSettings};
use calibrant_core::error::{Error, InputError, NotIdentifiable, Refusal, Result, UndeterminedGroup};
use calibrant_core::information::{Criterion, Undetermined, undetermined};
use calibrant_core::simulate::{Purpose, Rng, stream};
use nalgebra::Vector3;
use rand::RngExt;
use rayon::prelude::*;

/// Directions with which the approximate design begins.
const BEGINNING: usize = 60;
/// Random sets that are tried for each number of poses, to see whether it suffices.
const TRIED: usize = 20;
/// Most poses that are tried.
const MOST: usize = 100;
/// Starts that run between two looks at the interruption.
const ROUND: usize = 8;
/// Iterations of a descent.
const ITERATIONS: usize = 400;

/// The best poses, with the bound that no set of as many can beat.
///
/// `settings`: the number of starts and the seed. `progress` is told how many starts have ended.
///
/// # Errors
/// [`Error::NotIdentifiable`] where there are fewer poses than the parameters need, with that number, or where
/// the allowed directions leave parameters undetermined however many there are. [`Error::Experiment`] where
/// the sensor's matrix is singular.
///
/// # Examples
/// With `|f| = g` alone and nine parameters, twelve poses can be as good as any: the corners of an icosahedron.
/// ```
/// use calibrant_core::information::criterion::{Criterion, DOptimality};
/// use calibrant_core::sensor::{Gauge, SensorModel, SensorParameters};
/// use calibrant_design::DesignSettings;
/// use calibrant_design::poses::{Allowed, DirectionKnowledge, PoseProblem, design_poses};
/// use nalgebra::{DVector, Vector3};
///
/// let criterion = Criterion::D(DOptimality { scale: DVector::repeat(9, 1.0) });
/// let problem = PoseProblem {
///     list: Gauge::Symmetric.parameter_list(SensorModel::Full),
///     at: SensorParameters::identity(),
///     gravity_mps2: 9.81,
///     mean_sd: Vector3::repeat(1e-3),
///     directions: DirectionKnowledge::Unknown,
///     allowed: Allowed::Anywhere,
///     criterion: criterion.clone(),
///     prior: None,
///     poses: 12,
/// };
/// let design = design_poses(&problem, &DesignSettings::default(), &|_| {})?;
/// assert!(design.efficiency(&criterion) > 0.999);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
///
/// # References
/// `kiefer1960`, `fedorov1972`, `birgin2000`
pub fn design_poses(
    problem: &PoseProblem,
    settings: &DesignSettings,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<PoseDesign> {
    let information = HoldInformation::new(problem).ok_or_else(singular)?;
    check(problem, &information, settings.seed)?;
    let relaxed = relaxed(problem, &information, settings.seed).ok_or_else(singular)?;
    let mut found: Vec<(f64, Poses)> = Vec::new();
    let mut interrupted = false;
    for first in (0..settings.starts).step_by(ROUND) {
        interrupted = settings.interruption.is_asked() && !found.is_empty();
        if interrupted {
            break;
        }
        let round: Vec<_> = (first..settings.starts.min(first + ROUND))
            .into_par_iter()
            .filter_map(|number| {
                let mut rng = stream(settings.seed, Purpose::Start, number as u64);
                let outcome =
                    improve(problem, &information, &relaxed, start(problem, &relaxed, number, &mut rng));
                progress(1);
                outcome
            })
            .collect();
        found.extend(round);
    }
    let starts = found.len();
    let values: Vec<f64> = found.iter().map(|(value, _)| *value).collect();
    let (value, poses) =
        found.into_iter().min_by(|one, other| one.0.total_cmp(&other.0)).ok_or_else(singular)?;
    let covariance = poses.covariance(&information).ok_or_else(singular)?;
    let all: f64 = relaxed.poses.shares.iter().sum();
    Ok(PoseDesign {
        directions: poses.directions,
        covariance,
        value,
        bound: PoseBound {
            value: relaxed.bound.min(value),
            directions: relaxed.poses.directions,
            shares: relaxed.poses.shares.iter().map(|share| share / all).collect(),
        },
        starts,
        starts_at_best: values.iter().filter(|other| problem.criterion.gap(**other, value) < AT_BEST).count(),
        interrupted,
    })
}

/// The approximate design of a problem.
pub(super) fn relaxed(
    problem: &PoseProblem,
    information: &HoldInformation,
    seed: u64,
) -> Option<Approximate> {
    let mut rng = stream(seed, Purpose::Motion, 0);
    let beginning = match &problem.allowed {
        Allowed::Of(list) => list.clone(),
        allowed => (0..BEGINNING).map(|_| allowed.draw(&mut rng)).collect(),
    };
    approximate(problem, information, beginning)
}

fn start(problem: &PoseProblem, relaxed: &Approximate, number: usize, rng: &mut Rng) -> Vec<Vector3<f64>> {
    if number % 2 == 1 {
        return (0..problem.poses).map(|_| problem.allowed.draw(rng)).collect();
    }
    // as many at each direction as its share says, and the rest by lot
    let mut poses: Vec<Vector3<f64>> = Vec::new();
    let offset: f64 = rng.random_range(0.0..1.0);
    let mut passed = 0.0;
    for (u, share) in relaxed.poses.directions.iter().zip(&relaxed.poses.shares) {
        passed += share;
        while (poses.len() as f64) + offset < passed && poses.len() < problem.poses {
            poses.push(*u);
        }
    }
    while poses.len() < problem.poses {
        poses.push(problem.allowed.draw(rng));
    }
    poses
}

fn improve(
    problem: &PoseProblem,
    information: &HoldInformation,
    relaxed: &Approximate,
    start: Vec<Vector3<f64>>,
) -> Option<(f64, Poses)> {
    let exponents: &[f64] = match problem.criterion {
        Criterion::E(_) | Criterion::M(_) => &[10.0, 50.0, 250.0],
        _ => &[1.0],
    };
    let list = match &problem.allowed {
        Allowed::Of(list) => list,
        _ => &relaxed.poses.directions,
    };
    let mut poses = Poses::equal(start);
    for &exponent in exponents {
        let criterion = SmoothCriterion { criterion: &problem.criterion, exponent };
        poses = Poses::equal(exchange(information, criterion, list, poses.directions));
        if problem.allowed.is_continuous() {
            let descent = Descent {
                information,
                allowed: &problem.allowed,
                criterion,
                moves_shares: false,
                iterations: ITERATIONS,
            };
            poses = descent.run(poses)?;
        }
    }
    let value = problem.criterion.value(&poses.covariance(information)?);
    value.is_finite().then_some((value, poses))
}

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
fn check(problem: &PoseProblem, information: &HoldInformation, seed: u64) -> Result<()> {
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
