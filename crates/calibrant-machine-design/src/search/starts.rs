//! Random admissible motions from which the search starts.
//!
//! Control points are drawn one after the other. Each continues the one before with a random acceleration, turns back near the ends of the joints, and comes to rest
//! where a dwell or the end is. An interval that breaks a limit is drawn again; after some tries the walk goes back by two control points. Where no walk ends, the
//! motion goes a little to and fro about a posture at rest: as little as the limits ask for.

use super::Probe;
use crate::TrajectoryProblem;
use crate::limits::{Pointwise, least_slack};
use crate::motion::{Knots, REST, Ties};
use calibrant_design::Interruption;
use nalgebra::DMatrix;
use rand::{Rng, RngExt};

/// Walks, tries of a control point, and times that a walk goes back.
const WALKS: usize = 20;
const TRIES: usize = 60;
const BACK: usize = 40;
/// Part of speeds and accelerations that is drawn, and part that is kept.
const DRAWN: f64 = 0.8;
const KEPT: f64 = 0.97;
/// Postures that are tried for a start at rest.
const POSTURES: usize = 2000;

/// Draws starts.
pub(crate) struct Starts<'a> {
    problem: &'a TrajectoryProblem<'a>,
    probe: Probe<'a>,
    knots: Knots,
    /// Runs of control points that are equal: first, number.
    dwells: Vec<(usize, usize)>,
}

impl<'a> Starts<'a> {
    pub(crate) fn new(pointwise: Pointwise<'a>, knots: Knots, dwells: &[(usize, usize)]) -> Self {
        let problem = pointwise.problem;
        Self { problem, probe: Probe::new(pointwise, knots), knots, dwells: dwells.to_vec() }
    }

    /// A motion that keeps all limits with some room. `None` if not even a posture at rest is found, or an interruption came before.
    pub(crate) fn draw(
        &mut self,
        ties: &Ties,
        interruption: &Interruption,
        rng: &mut impl Rng,
    ) -> Option<DMatrix<f64>> {
        for _ in 0..WALKS {
            if interruption.is_asked() {
                return None;
            }
            if let Some(controls) = self.walk(rng) {
                let controls = ties.controls_of(&ties.unknowns_of(&controls));
                if self.is_admissible(&controls) {
                    return Some(controls);
                }
            }
        }
        self.about_a_posture(ties, rng)
    }

    fn is_admissible(&mut self, controls: &DMatrix<f64>) -> bool {
        least_slack(&self.problem.joints, &self.knots, controls) > 1e-3
            && (0..self.knots.intervals).all(|i| self.probe.interval_is_free(controls, i))
    }

    /// A posture at which the machine may rest.
    pub(super) fn posture(&mut self, rng: &mut impl Rng) -> Option<Vec<f64>> {
        let problem = self.problem;
        let n = problem.joints.len();
        for _ in 0..POSTURES {
            let posture = match &problem.home {
                Some(home) => home.clone(),
                None => (problem.joints.iter())
                    .map(|joint| {
                        let (middle, half) =
                            ((joint.upper + joint.lower) / 2.0, (joint.upper - joint.lower) / 2.0);
                        middle + 0.9 * half * rng.random_range(-1.0..=1.0)
                    })
                    .collect(),
            };
            let rest = DMatrix::from_fn(self.knots.controls(), n, |_, j| posture[j]);
            if self.probe.interval_is_free(&rest, 0) {
                return Some(posture);
            }
            if problem.home.is_some() {
                return None;
            }
        }
        None
    }

    fn walk(&mut self, rng: &mut impl Rng) -> Option<DMatrix<f64>> {
        let problem = self.problem;
        let (n, number, h) = (problem.joints.len(), self.knots.controls(), self.knots.step_s);
        let posture = self.posture(rng)?;
        let mut controls = DMatrix::from_fn(number, n, |_, j| posture[j]);
        let last = number - REST;
        let mut backs = 0;
        let mut i = REST;
        while i < last {
            let run = self.dwells.iter().find(|(first, length)| *first < i && i < first + length).copied();
            let stop = self.dwells.iter().map(|(first, _)| first + 1).find(|stop| *stop >= i).unwrap_or(last);
            let mut placed = false;
            for _ in 0..TRIES {
                for j in 0..n {
                    let limit = &problem.joints[j];
                    let (before, here) = (controls[(i - 2, j)], controls[(i - 1, j)]);
                    let (v, a) = (limit.velocity * h, limit.acceleration * h * h);
                    let draw: f64 = rng.random_range(-1.0..=1.0);
                    let range = limit.upper - limit.lower;
                    let mut d = here - before + draw * DRAWN * a.min(2.0 * v).min(range);
                    d = d.clamp(-DRAWN * v, DRAWN * v);
                    let slowing = 0.9 * a * (stop.saturating_sub(i) as f64 + 0.5);
                    d = d.clamp(-slowing, slowing);
                    if let Some(home) = &problem.home {
                        let room = 0.5 * DRAWN * v * (last - i).saturating_sub(1) as f64;
                        d = (here + d).clamp(home[j] - room, home[j] + room) - here;
                    }
                    let edge = 0.02 * range;
                    if here + d > limit.upper - edge || here + d < limit.lower + edge {
                        d *= -0.5;
                    }
                    controls[(i, j)] = if run.is_some() { here } else { here + d };
                }
                if self.keeps_joint_limits(&controls, i) && self.probe.interval_is_free(&controls, i - 3) {
                    placed = true;
                    break;
                }
                if run.is_some() {
                    break;
                }
            }
            if placed {
                i += 1;
            } else {
                backs += 1;
                if backs > BACK {
                    return None;
                }
                i = REST.max(i.saturating_sub(2));
            }
        }
        let end: Vec<f64> =
            problem.home.clone().unwrap_or_else(|| controls.row(last - 1).iter().copied().collect());
        for i in last..number {
            for j in 0..n {
                controls[(i, j)] = end[j];
            }
        }
        Some(controls)
    }

    /// Do the differences that end at control point `i` keep the joints' limits?
    fn keeps_joint_limits(&self, controls: &DMatrix<f64>, i: usize) -> bool {
        let h = self.knots.step_s;
        self.problem.joints.iter().enumerate().all(|(j, limit)| {
            let c = |k: usize| controls[(i - k, j)];
            let margin = 0.01 * (limit.upper - limit.lower).min(1.0);
            let first = c(0) - c(1);
            let second = first - (c(1) - c(2));
            let third = second - (c(1) - 2.0 * c(2) + c(3));
            c(0) < limit.upper - margin
                && c(0) > limit.lower + margin
                && first.abs() <= KEPT * limit.velocity * h
                && second.abs() <= KEPT * limit.acceleration * h * h
                && third.abs() <= KEPT * limit.jerk * h.powi(3)
        })
    }

    /// A posture at rest, and random control points about it, drawn towards it until the limits are kept.
    fn about_a_posture(&mut self, ties: &Ties, rng: &mut impl Rng) -> Option<DMatrix<f64>> {
        let problem = self.problem;
        let n = problem.joints.len();
        let posture = self.posture(rng)?;
        let away = DMatrix::from_fn(self.knots.controls(), n, |_, j| {
            let limit = &problem.joints[j];
            rng.random_range(-0.5..=0.5)
                * (limit.acceleration * self.knots.step_s.powi(2)).min(limit.upper - limit.lower)
        });
        let mut part = 1.0;
        for _ in 0..60 {
            let controls =
                DMatrix::from_fn(self.knots.controls(), n, |i, j| posture[j] + part * away[(i, j)]);
            let controls = ties.controls_of(&ties.unknowns_of(&controls));
            if self.is_admissible(&controls) {
                return Some(controls);
            }
            part *= 0.7;
        }
        None
    }
}
