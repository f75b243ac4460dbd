//! Distances of bodies.

use super::limit_proof::{LimitProof, MOST_PARTS, Running, SHORTEST, TrajectoryLimit};
use crate::TrajectoryProblem;
use crate::limits::{Surroundings, poses};
use crate::motion::{Knots, derivative, rows_at};
use crate::recursion::{JointAt, Links, Sweep};
use crate::world::{BodyPair, Proximity};
use calibrant_machine::chain::SensorMount;
use nalgebra::{DMatrix, IsometryMatrix3, UnitQuaternion, Vector3};

/// A distance may be smaller by this, m: rounding.
const SLACK_M: f64 = 1e-9;

struct Proof<'p, 'a> {
    problem: &'p TrajectoryProblem<'a>,
    surroundings: &'a dyn Surroundings,
    knots: Knots,
    controls: &'p DMatrix<f64>,
    links: Links,
    joints: Vec<JointAt>,
    sweep: Sweep,
    frames: Vec<IsometryMatrix3<f64>>,
    near: Vec<Proximity>,
    running: Vec<Running>,
    /// Parts of the interval that may still be looked at.
    parts: usize,
}

/// All distances. The peak of a distance is its least value.
pub(super) fn all(problem: &TrajectoryProblem<'_>, knots: Knots, controls: &DMatrix<f64>) -> Vec<LimitProof> {
    let Some(surroundings) = problem.surroundings else { return Vec::new() };
    let rows = surroundings.rows();
    let pairs: Vec<BodyPair> = (0..rows).map(|row| surroundings.pair(row)).collect();
    // postures need no sensor
    let mount = SensorMount { lever_m: Vector3::zeros(), tip_from_sensor: UnitQuaternion::identity() };
    let n = problem.chain.joints.len();
    let mut proof = Proof {
        problem,
        surroundings,
        knots,
        controls,
        links: Links::new(problem.chain, &mount, &Vector3::zeros()),
        joints: vec![JointAt::REST; n],
        sweep: Sweep::new(n),
        frames: vec![IsometryMatrix3::identity(); n + 1],
        near: vec![Proximity::far(); rows],
        running: vec![Running::new(); rows],
        parts: 0,
    };
    let mut first = proof.distances(0, 0.0);
    for i in 0..knots.intervals {
        let speeds: Vec<f64> = pairs.iter().map(|pair| proof.approach(pair, i)).collect();
        let last = proof.distances(i, 1.0);
        proof.parts = MOST_PARTS;
        proof.part(i, (0.0, first), (1.0, last.clone()), &speeds);
        first = last;
    }
    let each = proof.running.iter().enumerate();
    each.map(|(row, running)| {
        let of = running.proof(TrajectoryLimit::Clearance(row), problem.clearance_m);
        let peak = -of.peak;
        LimitProof { peak, used: of.allowed / peak, ..of }
    })
    .collect()
}

impl Proof<'_, '_> {
    fn distances(&mut self, i: usize, u: f64) -> Vec<f64> {
        let rows = rows_at(u, self.knots.step_s);
        for (j, joint) in self.joints.iter_mut().enumerate() {
            *joint = JointAt::new(derivative(self.controls, i, &rows[0], j), 0.0, 0.0);
        }
        self.sweep.forward(&self.links, &self.joints);
        poses(&self.sweep, &self.links, &self.joints, &mut self.frames);
        self.surroundings.proximities(&self.frames, &mut self.near);
        let time_s = (i as f64 + u) * self.knots.step_s;
        let distances: Vec<f64> = self.near.iter().map(|near| near.distance_m).collect();
        for (running, distance) in self.running.iter_mut().zip(&distances) {
            running.see(-distance, time_s);
            if *distance < self.problem.clearance_m - SLACK_M {
                running.breaks();
            }
        }
        distances
    }

    /// The largest speed at which two bodies may approach in interval `i`.
    ///
    /// The joints between their frames move them against each other. A point of the farther body is as far from a joint's axis as the lengths of the links between,
    /// and its own extent, allow.
    fn approach(&self, pair: &BodyPair, i: usize) -> f64 {
        let (near, far) = if pair.frames[0] < pair.frames[1] { (0, 1) } else { (1, 0) };
        let joints = &self.problem.chain.joints;
        let (mut reach, mut speed) = (pair.extents_m[far], 0.0);
        for j in (pair.frames[near]..pair.frames[far]).rev() {
            let c = [0, 1, 2, 3].map(|r| self.controls[(i + r, j)]);
            let fastest =
                c.windows(2).map(|of| (of[1] - of[0]).abs()).fold(0.0, f64::max) / self.knots.step_s;
            if joints[j].kind.turns() {
                speed += fastest * reach;
            } else {
                speed += fastest;
                reach += c.iter().fold(0.0, |most, c| c.abs().max(most));
            }
            reach += joints[j].origin.translation.vector.norm();
        }
        speed
    }

    fn part(&mut self, i: usize, (u0, first): (f64, Vec<f64>), (u1, last): (f64, Vec<f64>), speeds: &[f64]) {
        let least = self.problem.clearance_m - SLACK_M;
        let length_s = (u1 - u0) * self.knots.step_s;
        let open = |row: usize| {
            let (d0, d1) = (first[row], last[row]);
            d0 >= least && d1 >= least && d0 + d1 - speeds[row] * length_s < 2.0 * least
        };
        let left: Vec<usize> = (0..speeds.len()).filter(|row| open(*row)).collect();
        if left.is_empty() {
            return;
        }
        self.parts = self.parts.saturating_sub(1);
        if u1 - u0 < SHORTEST || self.parts == 0 {
            for row in left {
                self.running[row].give_up();
            }
            return;
        }
        let u = (u0 + u1) / 2.0;
        let middle = self.distances(i, u);
        self.part(i, (u0, first), (u, middle.clone()), speeds);
        self.part(i, (u, middle), (u1, last), speeds);
    }
}
