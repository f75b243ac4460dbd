//! The shortest motion with which parameters are determined well enough.
//!
//! Intervals keep their duration, and their number N is sought. A standard deviation falls about as 1/√N, which
//! gives the next N to try. The search ends with an N that does and N − 1, for which no motion was found that
//! does.
//!
//! For each smaller N, from 1 on, the certificate bounds every standard deviation from below, until one bound
//! no longer exceeds its goal. No motion with fewer intervals reaches the goals. That each N is examined costs
//! little, since short motions do. It is needed: a motion that must rest at its end, or stay in a room, is
//! not always the beginning of a longer one.

use crate::problem::Goal;
use crate::{Design, DesignProblem, DesignSettings, certificate, check_feasible, design};
use calibrant_core::budget::Budget;
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
/// # Errors
/// As [`design`]. [`Error::Experiment`] where 16 times the experiment's intervals do not reach the goals.
pub fn shortest_motion(
    problem: &DesignProblem<'_>,
    goals: &[Goal],
    settings: &DesignSettings,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<ShortestMotion> {
    let of = |intervals: usize| DesignProblem { intervals, ..problem.clone() };
    let uncertified = DesignSettings { certificate: false, ..settings.clone() };
    let intervals =
        fewest_intervals(problem, |intervals| excess(&of(intervals), goals, &uncertified, progress))?;
    let at_least = if settings.certificate {
        Some(fewest_possible(intervals, |intervals| is_possible(&of(intervals), goals, settings))?)
    } else {
        None
    };
    let design = design(&of(intervals), settings, progress)?;
    Ok(ShortestMotion { design, intervals, at_least })
}

impl DesignSettings {
    /// What the search for the shortest motion takes at most: some designs, the last of them of the most intervals.
    #[must_use]
    pub fn work_on_shortest(&self, problem: &DesignProblem<'_>) -> Budget {
        /// Designs that are as long as the last.
        const DESIGNS: f64 = 2.0;
        let longest = DesignProblem { intervals: MOST * problem.intervals, ..problem.clone() };
        self.work(&longest).repeated(DESIGNS)
    }
}

/// Largest ratio of a standard deviation to its goal in the best motion found; infinite without a motion.
fn excess(
    problem: &DesignProblem<'_>,
    goals: &[Goal],
    settings: &DesignSettings,
    progress: &(dyn Fn(u64) + Sync),
) -> Result<f64> {
    match design(problem, settings, progress) {
        Ok(found) if found.optimal.covariance.is_some() => {
            let sd = found.optimal.sd();
            Ok(Goal::worst(goals, |k| sd[k]))
        }
        Ok(_) => Ok(f64::INFINITY),
        // a motion that is too short for the limits
        Err(error) if error.is_infeasible() => Ok(f64::INFINITY),
        Err(error) => Err(error),
    }
}

/// The number of intervals with which the excess first is at most 1.
fn fewest_intervals(
    problem: &DesignProblem<'_>,
    mut excess: impl FnMut(usize) -> Result<f64>,
) -> Result<usize> {
    let most = MOST * problem.intervals;
    let (mut low, mut high) = (0, None);
    let (mut next, mut tries) = (problem.intervals, 0);
    while high.is_none_or(|high| high - low > 1) {
        let found = excess(next)?;
        if found > 1.0 && next >= most {
            return Err(out_of_reach(problem, most));
        }
        if found > 1.0 {
            low = next
        } else {
            high = Some(next)
        }
        tries += 1;
        // infinite for a motion that is too short
        let wanted = (next as f64 * (found * found).clamp(0.25, 4.0)).ceil() as usize;
        next = match high {
            None => wanted.clamp(low + 1, most),
            // every third is in the middle, where the rule misleads
            Some(high) if tries % 3 == 0 => low + (high - low) / 2,
            Some(high) => wanted.clamp(low + 1, (high - 1).max(low + 1)),
        };
    }
    Ok(high.unwrap_or(most))
}

/// The first number of intervals that is not proved to be too small.
fn fewest_possible(found: usize, mut is_possible: impl FnMut(usize) -> Result<bool>) -> Result<usize> {
    for intervals in 1..found {
        if is_possible(intervals)? {
            return Ok(intervals);
        }
    }
    Ok(found)
}

/// May a motion of these intervals reach the goals, as far as the certificate shows?
fn is_possible(problem: &DesignProblem<'_>, goals: &[Goal], settings: &DesignSettings) -> Result<bool> {
    if check_feasible(problem).is_err_and(|error| error.is_infeasible()) {
        return Ok(false);
    }
    let Some(bound) = certificate::lower_bound(problem, &settings.interruption)? else { return Ok(true) };
    let least = bound.certificate(&problem.criterion, f64::INFINITY, 0.0).sd_lower_bound;
    // a parameter without a bound may have any standard deviation
    let of = |k: usize| least.get(k).copied().filter(|sd| sd.is_finite()).unwrap_or(0.0);
    Ok(Goal::worst(goals, of) <= 1.0)
}

fn out_of_reach(problem: &DesignProblem<'_>, most: usize) -> Error {
    let message = format!(
        "the best motion found of {most} intervals of {} s does not reach the standard deviations asked for",
        problem.interval_s
    );
    let help = "loosen the limits, choose criterion c with weights on these parameters, or ask for less";
    Error::experiment(InputError::new(Refusal::ValueOutOfRange, message, help))
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant_core::information::Criterion;
    use calibrant_core::information::criterion::AOptimality;
    use calibrant_core::motion::{KnownEnds, Limits, MotionClock, Trust};
    use calibrant_core::sensor::{Sensor, SensorParameters};
    use nalgebra::{DVector, Vector3};

    /// The thesis's stage, D1, on one axis.
    fn with_stage(run: impl FnOnce(&DesignProblem<'_>)) {
        let sensor = Sensor { axes: 1, ..Sensor::memsic_mxd2020u() };
        let all = |limit: f64| Some(Vector3::repeat(limit));
        let limits = Limits { acceleration_mps2: all(30.0), jerk_mps3: all(30.0), ..Limits::default() };
        run(&DesignProblem {
            sensor: &sensor,
            at: SensorParameters::identity(),
            intervals: 4,
            interval_s: 1.0,
            rate_hz: 10.0,
            trust: Trust::Known,
            known_ends: KnownEnds::Start,
            gravity: None,
            clock: MotionClock::default(),
            limits: &limits,
            criterion: Criterion::A(AOptimality { scale: DVector::repeat(2, 1.0) }),
            prior: None,
        });
    }

    #[test]
    fn no_shorter_motion_does_and_the_bound_says_so() {
        with_stage(|problem| {
            let settings = DesignSettings { starts: 8, ..DesignSettings::default() };
            let goals = [Goal { parameter: 1, sd: 9e-7 }];
            let found = shortest_motion(problem, &goals, &settings, &|_| {}).expect("reachable");
            // the first of all N
            let quick = DesignSettings { certificate: false, ..settings.clone() };
            let expected = (1..30)
                .find(|&intervals| {
                    let problem = DesignProblem { intervals, ..problem.clone() };
                    excess(&problem, &goals, &quick, &|_| {}).expect("a number") <= 1.0
                })
                .expect("one of them");
            assert_eq!(found.intervals, expected);
            assert!(found.design.optimal.sd()[1] <= 9e-7);
            let least = found.at_least.expect("a certificate");
            println!("{expected} intervals, at least {least}");
            assert!(least <= expected && least + 1 >= expected, "{least} {expected}");
        });
    }

    /// The sum of squares is at most that of the largest acceleration in every sample, so that more samples
    /// than a number are needed: the search cannot promise less.
    #[test]
    fn a_goal_beyond_every_motion_is_refused() {
        with_stage(|problem| {
            let settings = DesignSettings { starts: 2, certificate: false, ..DesignSettings::default() };
            let goals = [Goal { parameter: 0, sd: 1e-7 }];
            let error =
                shortest_motion(problem, &goals, &settings, &|_| {}).expect_err("far away").to_string();
            assert!(error.contains("64 intervals") && error.contains("loosen"), "{error}");
        });
    }

    #[test]
    fn the_fewest_intervals_are_found_in_few_tries() {
        with_stage(|problem| {
            for answer in [1, 2, 3, 4, 5, 17, 40, 64] {
                let mut tries = 0;
                let found = fewest_intervals(problem, |intervals| {
                    tries += 1;
                    // a motion of fewer than two intervals does not exist
                    Ok(if intervals < 2 && answer > 1 {
                        f64::INFINITY
                    } else {
                        (answer as f64 / intervals as f64).sqrt()
                    })
                });
                assert_eq!(found.expect("reachable"), answer);
                assert!(tries <= 8, "{answer}: {tries} tries");
            }
        });
    }
}
