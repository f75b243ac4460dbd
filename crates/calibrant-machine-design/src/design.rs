//! The stages of a design: check → search → certify (repair) → evaluate → bound.

use crate::bound::bound;
use crate::certificate::certify;
use crate::evaluate::evaluated;
use crate::information::Sensing;
use crate::plain::plain;
use crate::problem::check;
use crate::search::{Candidate, Found, repaired, search};
use crate::{
    Kept, PlainTrajectory, TrajectoryBound, TrajectoryEvaluation, TrajectoryProblem, TrajectorySettings,
    TrajectoryStart,
};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_design::{DesignStatus, Interruption};
use calibrant_machine::spline::VectorSpline;
use std::time::{Duration, Instant};

/// The best trajectory found.
#[derive(Debug, Clone)]
pub struct TrajectoryDesign {
    /// How the search ended.
    pub status: DesignStatus,
    /// The trajectory. All its limits are proved.
    pub optimal: TrajectoryEvaluation,
    /// A random admissible motion: the first start.
    pub random: TrajectoryEvaluation,
    /// What an engineer would write: a plain routine in the same time. `None` where none was found that keeps the limits.
    pub plain: Option<PlainTrajectory>,
    /// Every start that was searched to the end of its last level, the best first.
    pub starts: Vec<TrajectoryStart>,
    /// Iterations of all starts.
    pub iterations: usize,
    /// Times at which the machine stands still, from and to, s.
    pub dwells_s: Vec<(f64, f64)>,
    /// What no trajectory can beat; `None` where there is no bound for this criterion or these parameters.
    pub bound: Option<TrajectoryBound>,
}

/// Finds the best trajectory, and proves its limits.
///
/// # Errors
/// - [`Error::Experiment`]: the problem makes no sense, or it was interrupted before there was a trajectory.
/// - [`Error::Infeasible`]: no motion is found that keeps the limits.
pub fn design_trajectory(
    problem: &TrajectoryProblem<'_>,
    settings: &TrajectorySettings,
) -> Result<TrajectoryDesign> {
    check(problem)?;
    let sensing = Sensing::new(problem)?;
    let deadline = settings.seconds.map(|seconds| Instant::now() + Duration::from_secs_f64(seconds));
    let interruption = settings.interruption.or_at(deadline);
    let Found { candidates, first, starts, iterations } = search(problem, &sensing, settings, &interruption)?;
    let best = proved(problem, &sensing, &candidates, &settings.interruption)?;
    let mut optimal = evaluated(problem, &sensing, best.knots, &best.controls)?;
    let random = evaluated(problem, &sensing, first.knots, &first.controls)?;
    let plain = plain(problem, &sensing, settings.seed, &settings.interruption);
    // the search does not go through these; what they are better in is known only here
    for other in [Some(&random), plain.as_ref().map(|plain| &plain.evaluation)].into_iter().flatten() {
        if other.value < optimal.value && other.is_proved() {
            optimal = other.clone();
        }
    }
    Ok(TrajectoryDesign {
        status: if interruption.is_asked() { DesignStatus::Interrupted } else { best.status },
        dwells_s: dwells(problem, &optimal.motion),
        bound: bound(problem, &sensing, optimal.value),
        plain,
        optimal,
        random,
        starts,
        iterations,
    })
}

/// The best candidate whose limits are proved, repaired where they are not and nobody interrupts.
fn proved(
    problem: &TrajectoryProblem<'_>,
    sensing: &Sensing,
    candidates: &[Candidate],
    interruption: &Interruption,
) -> Result<Candidate> {
    let is_proved = |candidate: &Candidate| {
        let proofs = certify(problem, candidate.knots, &candidate.controls);
        proofs.iter().all(|proof| proof.kept == Kept::Proved)
    };
    let mut by_value: Vec<&Candidate> = candidates.iter().collect();
    by_value.sort_by(|one, other| one.value.total_cmp(&other.value));
    let mut best: Option<Candidate> = None;
    for candidate in by_value {
        // a repair costs value, so that the next candidate may be better
        if best.as_ref().is_some_and(|best| best.value <= candidate.value) {
            break;
        }
        let kept = match is_proved(candidate) {
            true => Some(candidate.clone()),
            false => repaired(problem, sensing, candidate, interruption, is_proved),
        };
        best = best.into_iter().chain(kept).min_by(|one, other| one.value.total_cmp(&other.value));
    }
    if best.is_none() {
        interruption.check()?;
    }
    best.ok_or_else(|| {
        Error::infeasible(InputError::new(
            Refusal::MotionInfeasible,
            "no trajectory was found whose limits hold between the times that were looked at",
            "allow more time (`machine.design.duration_s`), or give the machine more room",
        ))
    })
}

/// Where all control points of an interval are equal but for this part of the top speed.
const STILL: f64 = 0.01;

fn dwells(problem: &TrajectoryProblem<'_>, motion: &VectorSpline) -> Vec<(f64, f64)> {
    let h = motion.knots.step_s;
    let control = |i: usize, j: usize| motion.controls[i * motion.dimension + j];
    let rests = |i: usize| {
        problem.joints.iter().enumerate().all(|(j, limit)| {
            (0..3).all(|r| {
                let step = control(i + r + 1, j) - control(i + r, j);
                step.abs() <= STILL * limit.velocity * h
            })
        })
    };
    let mut dwells: Vec<(f64, f64)> = Vec::new();
    for i in (0..motion.knots.intervals).filter(|i| rests(*i)) {
        let (from, to) = (i as f64 * h, (i + 1) as f64 * h);
        match dwells.last_mut() {
            Some(last) if from - last.1 < h / 2.0 => last.1 = to,
            _ => dwells.push((from, to)),
        }
    }
    dwells
}
