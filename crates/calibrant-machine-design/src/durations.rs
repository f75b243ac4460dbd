//! Designs of several durations: what time is worth, and the shortest time that is enough.

use crate::{TrajectoryDesign, TrajectoryProblem, TrajectorySettings, design_trajectory};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::ImuQuantity;

/// The best trajectories of several durations.
#[derive(Debug, Clone)]
pub struct TrajectorySweep {
    /// The parameters, in the order of all lists.
    pub quantities: Vec<ImuQuantity>,
    /// One for each duration, in their order.
    pub points: Vec<TrajectorySweepPoint>,
}

/// The best trajectory of a duration.
#[derive(Debug, Clone)]
pub struct TrajectorySweepPoint {
    /// The duration, s.
    pub duration_s: f64,
    /// The design, or why there is none.
    pub outcome: std::result::Result<Box<TrajectoryDesign>, String>,
}

/// Designs the best trajectory of each duration; `progress` is told how many are done. Where it is interrupted, it has those that are finished.
#[must_use]
pub fn sweep_durations(
    problem: &TrajectoryProblem<'_>,
    settings: &TrajectorySettings,
    durations_s: &[f64],
    progress: &dyn Fn(usize),
) -> TrajectorySweep {
    let mut points = Vec::with_capacity(durations_s.len());
    for &duration_s in durations_s {
        let outcome = design_trajectory(&TrajectoryProblem { duration_s, ..problem.clone() }, settings);
        if settings.interruption.is_asked() {
            break;
        }
        points.push(TrajectorySweepPoint {
            duration_s,
            outcome: outcome.map(Box::new).map_err(|error| match error.input_error() {
                Some(input_error) => input_error.message.clone(),
                None => error.to_string(),
            }),
        });
        progress(points.len());
    }
    TrajectorySweep { quantities: problem.quantities.to_vec(), points }
}

/// The largest standard deviation of a parameter that is good enough.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrajectoryGoal {
    /// Its place among the quantities.
    pub parameter: usize,
    /// The standard deviation, in SI units.
    pub sd: f64,
}

/// A short trajectory that reaches goals.
#[derive(Debug, Clone)]
pub struct ShortestTrajectory {
    /// Its duration, s.
    pub duration_s: f64,
    /// The design.
    pub design: TrajectoryDesign,
    /// The longest duration in which none was found, s.
    pub not_found_s: Option<f64>,
}

/// Ratio of the shortest duration that is enough to the longest that is not, at which the search ends.
const NEAR: f64 = 1.06;
/// Designs at most.
const DESIGNS: usize = 12;
/// Shortest and longest duration, s: as `machine.design.duration_s` may be.
const SHORTEST_S: f64 = 1.0;
const LONGEST_S: f64 = 3600.0;
/// How far a duration goes from the one before, and how far beyond what is proposed.
const LEAST: f64 = 0.35;
const MOST: f64 = 3.0;
const BEYOND: f64 = 0.03;

/// The shortest duration, within 6 %, in which the search finds a trajectory that reaches the goals. Variances go down about as the duration goes up, which proposes the next duration.
///
/// # Errors
/// As [`design_trajectory`]. [`Error::Infeasible`] where no duration was found.
pub fn shortest_trajectory(
    problem: &TrajectoryProblem<'_>,
    settings: &TrajectorySettings,
    goals: &[TrajectoryGoal],
    progress: &dyn Fn(usize),
) -> Result<ShortestTrajectory> {
    let mut duration_s = problem.duration_s;
    let mut enough: Option<(f64, TrajectoryDesign)> = None;
    // a duration, and its largest standard deviation over the goal
    let mut not_enough: Option<(f64, f64)> = None;
    for number in 1..=DESIGNS {
        let outcome = design_trajectory(&TrajectoryProblem { duration_s, ..problem.clone() }, settings);
        progress(number);
        if settings.interruption.is_asked() {
            // a design that was broken off tells nothing of its duration
            break;
        }
        let (excess, design) = match outcome {
            Ok(design) => (excess(&design, goals), Some(design)),
            // too short to move at all
            Err(Error::Infeasible(_)) if enough.is_some() => (f64::INFINITY, None),
            Err(error) => return Err(error),
        };
        match design {
            Some(design) if excess <= 1.0 => enough = Some((duration_s, design)),
            _ => {
                let before = not_enough.replace((duration_s, excess));
                let stays =
                    before.is_some_and(|(shorter, more)| duration_s > 2.0 * shorter && excess > 0.98 * more);
                if enough.is_none() && (stays || duration_s >= LONGEST_S) {
                    return Err(out_of_reach(problem, goals, duration_s, excess));
                }
            }
        }
        let (shortest, longest) = (enough.as_ref().map(|(of, _)| *of), not_enough.map(|(of, _)| of));
        let is_near = shortest.zip(longest).is_some_and(|(shortest, longest)| shortest <= NEAR * longest);
        if is_near || (shortest.is_some() && duration_s <= SHORTEST_S) {
            break;
        }
        let proposed = duration_s * (excess * excess).clamp(LEAST, MOST);
        let next = match (longest, shortest) {
            (Some(low), Some(high)) if proposed <= low || proposed >= high => (low * high).sqrt(),
            (Some(low), Some(high)) => proposed.clamp(low * NEAR.sqrt(), high / NEAR.sqrt()),
            // a little beyond what is proposed, so that both sides are found
            (None, Some(_)) => proposed * (1.0 - BEYOND),
            (_, None) => proposed * (1.0 + BEYOND),
        };
        duration_s = next.clamp(SHORTEST_S, LONGEST_S);
    }
    if enough.is_none() {
        settings.interruption.check()?;
    }
    let Some((duration_s, design)) = enough else {
        let (longest, excess) = not_enough.unwrap_or((problem.duration_s, f64::INFINITY));
        return Err(out_of_reach(problem, goals, longest, excess));
    };
    Ok(ShortestTrajectory { duration_s, design, not_found_s: not_enough.map(|(of, _)| of) })
}

/// The largest standard deviation over its goal.
fn excess(design: &TrajectoryDesign, goals: &[TrajectoryGoal]) -> f64 {
    let Some(covariance) = &design.optimal.covariance else { return f64::INFINITY };
    let of = |goal: &TrajectoryGoal| covariance[(goal.parameter, goal.parameter)].sqrt() / goal.sd;
    goals.iter().map(of).fold(0.0, f64::max)
}

fn out_of_reach(
    problem: &TrajectoryProblem<'_>,
    goals: &[TrajectoryGoal],
    duration_s: f64,
    excess: f64,
) -> Error {
    let names: Vec<String> = goals.iter().map(|goal| problem.quantities[goal.parameter].name()).collect();
    let message = format!(
        "no trajectory was found that reaches the goals of {}: with {duration_s:.0} s the largest standard deviation is {excess:.3} times its goal",
        names.join(", ")
    );
    let help = "see the budget of a design: where the mount or the geometry has the largest share, time does not help; know that better, or ask for less";
    Error::infeasible(InputError::new(Refusal::MotionInfeasible, message, help))
}
