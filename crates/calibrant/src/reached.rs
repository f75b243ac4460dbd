//! Designs that are good enough: the fewest poses, the shortest motion, the shortest trajectory that reach goals.

use crate::design_plan::DesignPlan;
use crate::goal_request::{GoalRequest, goals, goals_of_imu};
use crate::trajectory_plan::TrajectoryPlan;
use calibrant_core::error::Result;
use calibrant_core::number_format::{counted, short, significant};
use calibrant_design::poses::{FewestPoses, PoseDesign, PoseProblem};
use calibrant_design::{Design, DesignProblem};
use calibrant_io::{Reached, ReachedGoal};
use calibrant_machine_design::{ShortestTrajectory, TrajectoryDesign, TrajectoryGoal, shortest_trajectory};

/// A design that reaches goals.
#[derive(Debug, Clone)]
pub struct ReachedDesign<D> {
    /// The design.
    pub design: D,
    /// The goals, as `design.json` has them.
    pub reached: Reached,
    /// What was found, in words.
    pub sentence: String,
}

impl DesignPlan {
    /// Finds the shortest motion that reaches what is asked for, and its problem; `progress` is told of each start.
    ///
    /// # Errors
    /// As [`shortest_motion`](Self::shortest_motion); [`Error::Experiment`](calibrant_core::Error::Experiment) where the sensor has no such parameter.
    pub fn reach<'a>(
        &self,
        problem: &DesignProblem<'a>,
        requests: &[GoalRequest],
        progress: &(dyn Fn(u64) + Sync),
    ) -> Result<(DesignProblem<'a>, ReachedDesign<Design>)> {
        let list = problem.sensor.parameter_list();
        let goals = goals(requests, &list, problem.sensor.unit, &problem.at)?;
        let found = self.shortest_motion(problem, &goals, progress)?;
        let intervals = |count: usize| {
            format!("{} ({} s)", counted(count, "interval"), short(count as f64 * problem.interval_s))
        };
        let evidence = evidence(found.at_least, found.intervals, self.settings.starts, intervals);
        let sentence =
            format!("A motion of {} reaches {}.{evidence}", intervals(found.intervals), asked(requests));
        let reached = Reached::new(&goals, &list.names(), found.at_least);
        let problem = DesignProblem { intervals: found.intervals, ..problem.clone() };
        Ok((problem, ReachedDesign { design: found.design, reached, sentence }))
    }

    /// Finds the fewest poses that reach what is asked for; `progress` is told of each start.
    ///
    /// # Errors
    /// As [`fewest_poses`](Self::fewest_poses); [`Error::Experiment`](calibrant_core::Error::Experiment) where the sensor has no such parameter.
    pub fn reach_by_poses(
        &self,
        problem: &PoseProblem,
        requests: &[GoalRequest],
        progress: &(dyn Fn(u64) + Sync),
    ) -> Result<ReachedDesign<PoseDesign>> {
        let goals = goals(requests, &problem.list, self.experiment.sensor.unit, &problem.at)?;
        let FewestPoses { design, at_least } = self.fewest_poses(problem, &goals, progress)?;
        let reached = Reached::new(&goals, &problem.list.names(), Some(at_least));
        let found = design.directions.len();
        let more = if self.earlier.is_empty() { "" } else { "more " };
        let poses =
            if found == 1 { format!("One {more}pose reaches") } else { format!("{found} {more}poses reach") };
        let evidence = evidence(reached.at_least, found, design.starts, |count| counted(count, "pose"));
        let beside = if problem.gravity_is_given() { "" } else { ", beside the error of gravity" };
        let sentence = format!("{poses} {}{beside}.{evidence}", asked(requests));
        Ok(ReachedDesign { design, reached, sentence })
    }
}

impl TrajectoryPlan {
    /// Finds the shortest trajectory, within 6 %, that reaches what is asked for; and the plan with its duration. `progress` is told how many durations are done.
    ///
    /// # Errors
    /// As [`shortest_trajectory`]; [`Error::Experiment`](calibrant_core::Error::Experiment) where the sensor has no such parameter.
    pub fn reach(
        mut self,
        requests: &[GoalRequest],
        progress: &dyn Fn(usize),
    ) -> Result<(Self, ReachedDesign<TrajectoryDesign>)> {
        let goals = goals_of_imu(requests, &self.quantities)?;
        let found = shortest_trajectory(&self.problem(), &self.settings, &goals, progress)?;
        let ShortestTrajectory { duration_s, design, not_found_s } = found;
        let shorter = not_found_s.map_or_else(String::new, |not_found_s| {
            let starts = counted(self.settings.starts, "start");
            format!(" With {} s, none was found in {starts}.", significant(not_found_s, 3))
        });
        let duration = significant(duration_s, 3);
        let sentence = format!("A trajectory of {duration} s reaches {}.{shorter}", asked(requests));
        let named =
            |goal: &TrajectoryGoal| ReachedGoal { name: self.quantities[goal.parameter].name(), sd: goal.sd };
        let reached = Reached { goals: goals.iter().map(named).collect(), at_least: None };
        self.machine.duration_s = duration_s;
        Ok((self, ReachedDesign { design, reached, sentence }))
    }
}

/// What is asked for, in words: `scale.x to 50ppm and bias.z to 0.2mg`.
fn asked(requests: &[GoalRequest]) -> String {
    requests.iter().map(GoalRequest::in_words).collect::<Vec<_>>().join(" and ")
}

/// What stands against fewer than were found: the bound, and below that the search.
fn evidence(
    at_least: Option<usize>,
    found: usize,
    starts: usize,
    counted: impl Fn(usize) -> String,
) -> String {
    // a bound of one says nothing
    let least = at_least.filter(|least| *least > 1);
    let bound = match least {
        Some(least) if least == found => return " Fewer cannot, by the bound.".into(),
        Some(least) => format!(" Fewer than {} cannot, by the bound.", counted(least)),
        None => String::new(),
    };
    match found {
        1 => bound,
        _ => format!("{bound} With {}, none was found in {starts} starts.", counted(found - 1)),
    }
}

#[cfg(test)]
mod tests {
    use super::evidence;

    #[test]
    fn a_bound_of_one_proves_nothing() {
        let said = |at_least, found| evidence(at_least, found, 30, |count| format!("{count} poses"));
        assert_eq!(said(Some(9), 9), " Fewer cannot, by the bound.");
        assert_eq!(said(Some(1), 4), " With 3 poses, none was found in 30 starts.");
        assert_eq!(
            said(Some(3), 4),
            " Fewer than 3 poses cannot, by the bound. With 3 poses, none was found in 30 starts."
        );
        assert_eq!(said(Some(1), 1), "");
    }
}
