//! What an engineer would write: the routine that the optimum is compared with.
//!
//! Six poses: each axis of the sensor up, then down, held at rest, with moves in between. Where the machine cannot take them: each joint in turn, to both of its ends.
//!
//! # Formula
//! A move from `A` to `B` goes straight in the space of the joints, with all joints at the same time. Its control points are `A + (B − A) s(k/m)`, with the smooth step
//! `s(x) = 10x³ − 15x⁴ + 6x⁵`. Its derivatives are at most `15/8`, `10/√3` and `60`. Divided differences are means of derivatives, so speed `V`, acceleration `A` and jerk
//! `J` of a joint that goes `Δ` are kept by the duration
//!
//! ```text
//! T ≥ max(15/8 Δ/V, √(10/√3 Δ/A), ∛(60 Δ/J))
//! ```
//!
//! Where a move breaks another limit it takes longer, then another posture is taken. A move that alone is longer than the motion is none. Holds share the time that is left.

use crate::evaluate::evaluated;
use crate::information::Sensing;
use crate::limits::Pointwise;
use crate::motion::{Knots, REST};
use crate::search::{HELD_BACK, Probe, levels};
use crate::{TrajectoryEvaluation, TrajectoryProblem};
use calibrant_core::interruption::Interruption;
use calibrant_core::simulate::{Purpose, Rng, stream};
use nalgebra::{DMatrix, Vector3};
use rand::RngExt;

/// Routines that are tried; the best is taken, so that the comparison is fair to it.
const ROUTINES: u64 = 4;
/// Postures that are drawn for each direction, those that are kept, and tries to turn one of them nearer.
const DRAWN: usize = 3000;
const KEPT: usize = 12;
const TURNED: usize = 150;
/// Cosines between gravity and the axis: of what is drawn, and of what is held.
const NEAR: f64 = 0.8;
const ALONG: f64 = 0.998;
/// Factors of a move's duration that are tried.
const SLOWER: [f64; 4] = [1.0, 1.4, 2.0, 3.0];
/// Shortest hold, intervals.
const HOLD: usize = 2;
/// Part of a joint's range that is left at its ends.
const EDGE: f64 = 0.03;

/// A routine as an engineer would write it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlainRoutine {
    /// Each axis of the sensor up and down, held, with moves in between.
    SixPoses,
    /// Each joint in turn, to both of its ends.
    JointsInTurn,
}

impl PlainRoutine {
    /// Its name in results.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::SixPoses => "six poses",
            Self::JointsInTurn => "joints in turn",
        }
    }
}

/// A plain routine with what it determines.
#[derive(Debug, Clone)]
pub struct PlainTrajectory {
    /// What it does.
    pub routine: PlainRoutine,
    /// Its motion.
    pub evaluation: TrajectoryEvaluation,
}

/// The best of some plain routines; `None` where none was found that keeps the limits within the duration, or an interruption came before.
pub(crate) fn plain(
    problem: &TrajectoryProblem<'_>,
    sensing: &Sensing,
    seed: u64,
    interruption: &Interruption,
) -> Option<PlainTrajectory> {
    let tried = |routine: PlainRoutine| {
        (0..ROUTINES)
            .filter_map(|number| {
                let mut rng = stream(seed, Purpose::Motion, number);
                let controls = Planner::new(problem, sensing, interruption).routine(routine, &mut rng)?;
                let evaluation = evaluated(problem, sensing, finest(problem), &controls).ok()?;
                evaluation.is_proved().then_some(PlainTrajectory { routine, evaluation })
            })
            .min_by(|one, other| one.evaluation.value.total_cmp(&other.evaluation.value))
    };
    tried(PlainRoutine::SixPoses).or_else(|| tried(PlainRoutine::JointsInTurn))
}

fn finest(problem: &TrajectoryProblem<'_>) -> Knots {
    *levels(problem).last().expect("there is a level")
}

/// A posture, rad and m.
type Posture = Vec<f64>;

/// Postures one after the other, and the intervals from each to the next.
struct Tour {
    postures: Vec<Posture>,
    moves: Vec<usize>,
}

struct Planner<'a> {
    problem: &'a TrajectoryProblem<'a>,
    sensing: &'a Sensing,
    probe: Probe<'a>,
    knots: Knots,
    /// Steps from one control point to the next, without those of the ends at rest.
    room: usize,
    interruption: &'a Interruption,
}

impl<'a> Planner<'a> {
    fn new(problem: &'a TrajectoryProblem<'a>, sensing: &'a Sensing, interruption: &'a Interruption) -> Self {
        let knots = finest(problem);
        let clearance_m = problem.clearance_m + HELD_BACK.clearance_m;
        let pointwise = Pointwise::new(problem, sensing.links.clone(), clearance_m, 1.0 - HELD_BACK.share);
        let room = (knots.controls() - 1).saturating_sub(2 * (REST - 1));
        Self { problem, sensing, probe: Probe::new(pointwise, knots), knots, room, interruption }
    }

    /// The control points of a routine.
    fn routine(&mut self, routine: PlainRoutine, rng: &mut Rng) -> Option<DMatrix<f64>> {
        let room = self.room;
        match routine {
            PlainRoutine::SixPoses => {
                let tour = self.tour_of_faces(rng)?;
                let used: usize = tour.moves.iter().sum();
                let hold = room.checked_sub(used)? / tour.postures.len();
                (hold >= HOLD).then(|| self.controls(&tour, hold, self.knots.controls()))
            }
            PlainRoutine::JointsInTurn => {
                let once = self.tour_of_ends(rng)?;
                let times = room / once.moves.iter().sum::<usize>().max(1);
                let rounds = std::iter::repeat_n(&once.postures[1..], times).flatten();
                let postures = once.postures[..1].iter().chain(rounds).cloned().collect();
                let tour = Tour { postures, moves: once.moves.repeat(times) };
                (times > 0).then(|| self.controls(&tour, 0, self.knots.controls()))
            }
        }
    }

    /// From face to face, the nearest first; from home and back, where there is one.
    fn tour_of_faces(&mut self, rng: &mut Rng) -> Option<Tour> {
        let mut faces = self.faces(rng)?;
        let start = self.problem.home.clone().unwrap_or_else(|| faces.remove(0).swap_remove(0));
        let mut tour = Tour { postures: vec![start], moves: Vec::new() };
        while !faces.is_empty() {
            let here = tour.postures.last().expect("it has a start");
            let mut ways: Vec<(f64, usize, &Posture)> = (faces.iter().enumerate())
                .flat_map(|(face, all)| all.iter().map(move |there| (face, there)))
                .map(|(face, there)| (self.shortest_s(here, there), face, there))
                .collect();
            ways.sort_by(|one, other| one.0.total_cmp(&other.0));
            let found = ways
                .iter()
                .find_map(|(_, face, there)| Some((*face, there.to_vec(), self.way(here, there)?)));
            let (face, there, intervals) = found?;
            faces.remove(face);
            tour.postures.push(there);
            tour.moves.push(intervals);
        }
        self.closed(tour)
    }

    /// From a posture to both ends of each joint and back, as far as the way is free.
    fn tour_of_ends(&mut self, rng: &mut Rng) -> Option<Tour> {
        let base = match &self.problem.home {
            Some(home) => home.clone(),
            None => {
                let drawn: Vec<Posture> = (0..DRAWN).map(|_| self.drawn(rng)).collect();
                drawn.into_iter().find(|posture| self.may_rest(posture))?
            }
        };
        let mut tour = Tour { postures: vec![base.clone()], moves: Vec::new() };
        for (j, limit) in self.problem.joints.iter().enumerate() {
            let edge = EDGE * (limit.upper - limit.lower);
            for end in [limit.lower + edge, limit.upper - edge] {
                let there = |part: f64| {
                    let mut posture = base.clone();
                    posture[j] += part * (end - base[j]);
                    posture
                };
                let found = [1.0, 0.7, 0.4, 0.2].map(there).into_iter().find_map(|there| {
                    let (out, back) = (self.way(&base, &there)?, self.way(&there, &base)?);
                    Some((there, [out, back]))
                });
                if let Some((there, ways)) = found {
                    tour.postures.extend([there, base.clone()]);
                    tour.moves.extend(ways);
                }
            }
        }
        (!tour.moves.is_empty()).then_some(tour)
    }

    /// Ends where it began, if that is home.
    fn closed(&mut self, mut tour: Tour) -> Option<Tour> {
        if let (Some(home), Some(last)) = (&self.problem.home, tour.postures.last()) {
            tour.moves.push(self.way(last, home)?);
            tour.postures.push(home.clone());
        }
        Some(tour)
    }

    /// Postures in which an axis of the sensor points up or down; `None` where one is not found for each.
    fn faces(&mut self, rng: &mut Rng) -> Option<Vec<Vec<Posture>>> {
        let drawn: Vec<Posture> = (0..DRAWN).map(|_| self.drawn(rng)).collect();
        let drawn: Vec<(Vector3<f64>, Posture)> =
            drawn.into_iter().map(|posture| (self.up(&posture), posture)).collect();
        let faces = (0..3).flat_map(|axis| [1.0, -1.0].map(|sign| sign * Vector3::ith(axis, 1.0)));
        let of_face = |face: Vector3<f64>| {
            let near = drawn.iter().filter(|(up, _)| up.dot(&face) > NEAR);
            let turned =
                near.map(|(_, posture)| self.turned(posture.clone(), &face, rng)).collect::<Vec<_>>();
            let found = turned.into_iter().flatten().filter(|posture| self.may_rest(posture));
            let found: Vec<Posture> = found.take(KEPT).collect();
            (!found.is_empty()).then_some(found)
        };
        faces.map(of_face).collect()
    }

    /// Turns a posture until this axis of the sensor is upright.
    fn turned(&self, mut posture: Posture, face: &Vector3<f64>, rng: &mut Rng) -> Option<Posture> {
        let mut along = self.up(&posture).dot(face);
        for _ in 0..TURNED {
            if along > ALONG {
                return Some(posture);
            }
            let most = (1.0 - along).sqrt();
            let next: Posture = posture.iter().map(|q| q + most * rng.random_range(-1.0..=1.0)).collect();
            let next_along = self.up(&next).dot(face);
            let inside = next.iter().zip(&self.problem.joints).all(|(q, of)| of.lower < *q && *q < of.upper);
            if next_along > along && inside {
                (posture, along) = (next, next_along);
            }
        }
        None
    }

    /// Direction of the specific force on the sensor at rest.
    fn up(&self, posture: &[f64]) -> Vector3<f64> {
        Vector3::from(self.sensing.links.felt_at_rest(posture).0).normalize()
    }

    fn may_rest(&mut self, posture: &[f64]) -> bool {
        let rest = DMatrix::from_fn(REST + 1, posture.len(), |_, j| posture[j]);
        self.probe.interval_is_free(&rest, 0)
    }

    /// A posture within half a turn of zero, and off the ends of the joints.
    fn drawn(&self, rng: &mut Rng) -> Posture {
        let one = |limit: &crate::JointLimit| {
            let edge = EDGE * (limit.upper - limit.lower);
            let (low, high) = (limit.lower + edge, limit.upper - edge);
            let turn = std::f64::consts::PI;
            match (low.max(-turn), high.min(turn)) {
                (near, far) if near < far => rng.random_range(near..=far),
                _ => rng.random_range(low..=high),
            }
        };
        self.problem.joints.iter().map(one).collect()
    }

    /// Shortest duration of a move by the joints' limits, s.
    fn shortest_s(&self, from: &[f64], to: &[f64]) -> f64 {
        let one = |(j, limit): (usize, &crate::JointLimit)| {
            let way = (to[j] - from[j]).abs();
            let by_speed = 15.0 / 8.0 * way / limit.velocity;
            let by_acceleration = (10.0 / 3.0_f64.sqrt() * way / limit.acceleration).sqrt();
            by_speed.max(by_acceleration).max((60.0 * way / limit.jerk).cbrt())
        };
        self.problem.joints.iter().enumerate().map(one).fold(0.0, f64::max)
    }

    /// Intervals of the quickest move between two postures at rest that keeps the limits, of those that are tried and fit into the motion.
    fn way(&mut self, from: &[f64], to: &[f64]) -> Option<usize> {
        let shortest = 1.01 * self.shortest_s(from, to) / self.knots.step_s;
        let tried = SLOWER.map(|times| ((shortest * times).ceil() as usize).max(1));
        tried.into_iter().find(|intervals| {
            if *intervals > self.room || self.interruption.is_asked() {
                return false;
            }
            let tour = Tour { postures: vec![from.to_vec(), to.to_vec()], moves: vec![*intervals] };
            let controls = self.controls(&tour, 0, 0);
            (0..controls.nrows() - REST).all(|i| self.probe.interval_is_free(&controls, i))
        })
    }

    /// Control points of a tour. It stays `hold` intervals at each posture. The last posture is repeated until there are `at_least` control points.
    fn controls(&self, tour: &Tour, hold: usize, at_least: usize) -> DMatrix<f64> {
        let mut rows: Vec<Posture> = vec![tour.postures[0].clone(); REST + hold];
        for (pair, intervals) in tour.postures.windows(2).zip(&tour.moves) {
            for k in 1..=*intervals {
                let x = k as f64 / *intervals as f64;
                let s = x * x * x * (10.0 - x * (15.0 - 6.0 * x));
                rows.push(pair[0].iter().zip(&pair[1]).map(|(a, b)| a + (b - a) * s).collect());
            }
            rows.resize(rows.len() + hold, pair[1].clone());
        }
        let last = rows[rows.len() - 1].clone();
        rows.resize((rows.len() + REST - 1).max(at_least), last);
        DMatrix::from_fn(rows.len(), self.problem.joints.len(), |i, j| rows[i][j])
    }
}
