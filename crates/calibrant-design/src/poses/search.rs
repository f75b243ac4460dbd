//! The search for the best n poses: many starts, exchange, descent.
//!
//! Half of the starts are random. The others take poses from the approximate design, by their shares. Each is
//! improved by exchange, over the allowed list or the directions of the approximate design, and then by
//! descent where directions may move. The best is kept.

use super::Allowed;
use super::approximate::{Approximate, approximate};
use super::enough::{check, made_regular, none_found, singular};
use super::exchange::exchange;
use super::hold_information::HoldInformation;
use super::order::{Drift, best_order};
use super::problem::{PoseProblem, with_gravity};
use super::result::PoseDesign;
use super::spectral_projected_gradient::{Descent, Poses};
use super::usual::usual_poses;
use crate::criterion::SmoothCriterion;
use crate::{AT_BEST, DesignSettings};
use calibrant_core::error::Result;
use calibrant_core::information::Criterion;
use calibrant_core::simulate::{Purpose, Rng, stream};
use nalgebra::Vector3;
use rand::RngExt;
use rayon::prelude::*;

/// Directions with which the approximate design begins.
pub(super) const BEGINNING: usize = 60;
/// Starts that run between two looks at the interruption.
const ROUND: usize = 8;
/// Iterations of a descent.
const ITERATIONS: usize = 400;

/// The best poses, with the bound that no set of as many can beat.
///
/// `settings`: the number of starts and the seed. `progress` is told how many starts have ended.
///
/// # Errors
/// [`Error::NotIdentifiable`](calibrant_core::Error::NotIdentifiable) where there are fewer poses than the parameters need, with that number, or where
/// the allowed directions leave parameters undetermined however many there are. [`Error::Experiment`](calibrant_core::Error::Experiment) where
/// the sensor's matrix is singular.
///
/// # Examples
/// With `|f| = g` alone and nine parameters, twelve poses can be as good as any: the corners of an icosahedron.
/// ```
/// use calibrant_core::information::criterion::{Criterion, DOptimality};
/// use calibrant_core::sensor::{Gauge, SensorModel, SensorParameters};
/// use calibrant_design::DesignSettings;
/// use calibrant_design::poses::{Allowed, DirectionKnowledge, PoseNuisance, PoseProblem, design_poses};
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
///     nuisance: PoseNuisance::none(),
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
    check(problem, &information)?;
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
                let start = start(problem, &relaxed, number, &mut rng);
                let outcome = improve(problem, &information, &relaxed, start);
                progress(1);
                outcome
            })
            .collect();
        found.extend(round);
    }
    let starts = found.len();
    let values: Vec<f64> = found.iter().map(|(value, _)| *value).collect();
    let (value, poses) = found
        .into_iter()
        .min_by(|one, other| one.0.total_cmp(&other.0))
        .ok_or_else(|| none_found(problem, &information, settings.starts))?;
    let without = poses.covariance(&information).ok_or_else(singular)?;
    let drift = Drift::of(&information, &poses.directions, without, &problem.nuisance.drift_sd);
    let order = best_order(problem, &poses.directions, &drift, settings.seed);
    Ok(PoseDesign {
        directions: order.iter().map(|&pose| poses.directions[pose]).collect(),
        covariance: with_gravity(problem, drift.covariance(&order)),
        value,
        bound: relaxed.bound_of(value),
        usual: usual_poses(problem, &information, value),
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
    let mut poses = Poses::equal(made_regular(information, start, list));
    for &exponent in exponents {
        let criterion = SmoothCriterion { criterion: &problem.criterion, exponent };
        poses = Poses::equal(exchange(
            information,
            criterion,
            list,
            poses.directions,
            !problem.allowed.is_continuous(),
        ));
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
