//! The shortest motion with which parameters are determined well enough.

use super::goal::{Goal, first_that_passes};
use super::{Design, DesignProblem, DesignSettings, certificate, check_feasible, design};
use calibrant_core::error::{Error, InputError, Refusal, Result};

/// Most intervals that are considered, as a multiple of those of the experiment.
const MOST: usize = 16;

/// The shortest motion found that reaches the goals, and a number of intervals that any motion needs.
#[derive(Debug, Clone)]
pub struct ShortestMotion {
    /// The design with the fewest intervals.
    pub design: Design,
    /// Its number of intervals.
    pub intervals: usize,
    /// No admissible motion of fewer intervals reaches the goals. `None` without a certificate.
    pub at_least: Option<usize>,
}

/// The best motion by the criterion of the problem, with as few intervals as reach the goals.
///
/// Intervals keep their duration. The proof for fewer intervals is the lower bound of each standard
/// deviation.
///
/// # Errors
/// As [`design`]. [`Error::Experiment`] where 16 times the experiment's intervals do not reach the goals.
pub fn shortest_motion(
    problem: &DesignProblem<'_>,
    goals: &[Goal],
    settings: &DesignSettings,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<ShortestMotion> {
    let uncertified = DesignSettings { certificate: false, ..settings.clone() };
    let of = |intervals: usize| DesignProblem { intervals, ..problem.clone() };
    let reaches = |intervals: usize| -> Result<bool> {
        let trial = of(intervals);
        match design(&trial, &uncertified, progress) {
            Ok(found) => {
                let sd = found.optimal.sd();
                Ok(found.optimal.covariance.is_some() && Goal::worst(goals, |k| sd[k]) <= 1.0)
            }
            // a motion that is too short for the limits
            Err(error) if error.is_infeasible() => Ok(false),
            Err(error) => Err(error),
        }
    };
    let (mut low, mut high) = (0, problem.intervals);
    while !reaches(high)? {
        if high >= MOST * problem.intervals {
            let message = format!(
                "{high} intervals of {} s do not reach the standard deviations asked for",
                problem.interval_s
            );
            let help =
                "loosen the limits, choose criterion c with weights on these parameters, or ask for less";
            return Err(Error::experiment(InputError::new(Refusal::ValueOutOfRange, message, help)));
        }
        (low, high) = (high, 2 * high);
    }
    let intervals = first_that_passes(low, high, reaches)?;
    let at_least = if settings.certificate {
        let possible = |intervals: usize| -> Result<bool> {
            let trial = of(intervals);
            if check_feasible(&trial).is_err_and(|error| error.is_infeasible()) {
                return Ok(false);
            }
            let bound = certificate::lower_bound(&trial, &settings.interruption)?;
            let sd =
                bound.map(|bound| bound.certificate(&problem.criterion, f64::INFINITY, 0.0).sd_lower_bound);
            let worst = sd.map_or(0.0, |sd| {
                Goal::worst(goals, |k| sd.get(k).copied().filter(|sd| sd.is_finite()).unwrap_or(0.0))
            });
            Ok(worst <= 1.0)
        };
        Some(first_that_passes(0, intervals, possible)?)
    } else {
        None
    };
    let design = design(&of(intervals), settings, progress)?;
    Ok(ShortestMotion { design, intervals, at_least })
}
