//! The sensor's range, and the speeds of tip and sensor body.

use super::derivative_bounds::{DerivativeBounds, on_interval};
use super::limit_proof::{LimitProof, MOST_PARTS, ROUNDING, Running, SHORTEST, TrajectoryLimit};
use crate::TrajectoryProblem;
use crate::information::Sensing;
use crate::limits::{PointVelocity, SensorBody, poses};
use crate::motion::{Knots, derivative, rows_at};
use crate::recursion::{JointAt, Sweep, V};
use nalgebra::{DMatrix, IsometryMatrix3, Point3, Vector3};

/// Six readings and two speeds.
const VALUES: usize = 8;

struct Proof<'p, 'a> {
    problem: &'p TrajectoryProblem<'a>,
    sensing: &'p Sensing,
    knots: Knots,
    controls: &'p DMatrix<f64>,
    bodies: [SensorBody; 2],
    limits: [f64; VALUES],
    sweep: Sweep,
    frames: Vec<IsometryMatrix3<f64>>,
    tip: IsometryMatrix3<f64>,
    joints: Vec<JointAt>,
    running: [Running; VALUES],
    /// Parts of the interval that may still be looked at.
    parts: usize,
}

/// All of these limits that are finite.
pub(super) fn all(problem: &TrajectoryProblem<'_>, knots: Knots, controls: &DMatrix<f64>) -> Vec<LimitProof> {
    let Ok(sensing) = Sensing::new(problem) else { return Vec::new() };
    let n = problem.chain.joints.len();
    let (f, w) = (&problem.force_range_mps2, &problem.rate_range_radps);
    let tip = SensorBody { center_m: Vector3::zeros(), radius_m: 0.0 };
    let speed = problem.tip_speed_mps.unwrap_or(f64::INFINITY);
    let of_body = problem.sensor_body.map_or(f64::INFINITY, |_| speed);
    let mut proof = Proof {
        problem,
        sensing: &sensing,
        knots,
        controls,
        bodies: [tip, problem.sensor_body.unwrap_or(tip)],
        limits: [f.x, f.y, f.z, w.x, w.y, w.z, speed, of_body],
        sweep: Sweep::new(n),
        frames: vec![IsometryMatrix3::identity(); n + 1],
        tip: nalgebra::convert(problem.chain.tip_transform),
        joints: vec![JointAt::REST; n],
        running: [Running::new(); VALUES],
        parts: 0,
    };
    for i in 0..knots.intervals {
        proof.interval(i);
    }
    let kinds = [0, 1, 2]
        .map(TrajectoryLimit::Force)
        .into_iter()
        .chain([0, 1, 2].map(TrajectoryLimit::Rate))
        .chain([TrajectoryLimit::TipSpeed, TrajectoryLimit::SensorSpeed]);
    let each = kinds.zip(&proof.running).zip(proof.limits).filter(|(_, limit)| limit.is_finite());
    each.map(|((kind, running), limit)| running.proof(kind, limit)).collect()
}

impl Proof<'_, '_> {
    fn interval(&mut self, i: usize) {
        let behind = |point: Vector3<f64>| (self.problem.chain.tip_transform * Point3::from(point)).coords;
        let bounds =
            |point: Vector3<f64>| on_interval(self.problem, self.knots, self.controls, i, &behind(point));
        let sensor = bounds(self.sensing.mount.lever_m);
        let bodies = self.bodies.map(|body| (bounds(body.center_m), body.radius_m));
        let curvature: [f64; VALUES] = std::array::from_fn(|k| match k {
            0..3 => sensor.force,
            3..6 => sensor.rate,
            _ => {
                let (DerivativeBounds { speed, .. }, radius) = bodies[k - 6];
                speed[0] + radius * speed[1]
            }
        });
        let (first, last) = (self.values(i, 0.0), self.values(i, 1.0));
        self.parts = MOST_PARTS;
        self.part(i, (0.0, first), (1.0, last), &curvature);
    }

    /// The sizes of readings and speeds at place `u` of interval `i`.
    fn values(&mut self, i: usize, u: f64) -> [f64; VALUES] {
        let rows = rows_at(u, self.knots.step_s);
        for (j, joint) in self.joints.iter_mut().enumerate() {
            let [q, qd, qdd] = [0, 1, 2].map(|d| derivative(self.controls, i, &rows[d], j));
            *joint = JointAt::new(q, qd, qdd);
        }
        self.sweep.forward(&self.sensing.links, &self.joints);
        let [f, w] = self.sweep.readings();
        let mut values = [0.0; VALUES];
        for k in 0..3 {
            (values[k], values[3 + k]) = (f.0[k].abs(), w.0[k].abs());
        }
        if self.problem.tip_speed_mps.is_some() {
            let Self { sweep, joints, frames, .. } = self;
            poses(sweep, &self.sensing.links, joints, frames);
            let tip = frames[joints.len()] * self.tip;
            for (k, body) in self.bodies.iter().enumerate() {
                let point = V::of(&(tip * Point3::from(body.center_m)).coords);
                let of = PointVelocity::new(sweep, &self.sensing.links, joints, &point);
                values[6 + k] = body.fastest_mps(&Vector3::from(of.v.0), &Vector3::from(of.w.0));
            }
        }
        let time_s = (i as f64 + u) * self.knots.step_s;
        for ((running, value), limit) in self.running.iter_mut().zip(values).zip(self.limits) {
            running.see(value, time_s);
            if value > limit * (1.0 + ROUNDING) {
                running.breaks();
            }
        }
        values
    }

    /// Proves a part of an interval, or its halves.
    fn part(
        &mut self,
        i: usize,
        (u0, first): (f64, [f64; VALUES]),
        (u1, last): (f64, [f64; VALUES]),
        curvature: &[f64; VALUES],
    ) {
        let square = ((u1 - u0) * self.knots.step_s).powi(2) / 8.0;
        let open = |k: usize| {
            let chord = first[k].max(last[k]);
            // what is broken already needs no proof
            chord <= self.limits[k] * (1.0 + ROUNDING)
                && chord + square * curvature[k] > self.limits[k] * (1.0 + ROUNDING)
        };
        let left: Vec<usize> = (0..VALUES).filter(|k| open(*k)).collect();
        if left.is_empty() {
            return;
        }
        self.parts = self.parts.saturating_sub(1);
        if u1 - u0 < SHORTEST || self.parts == 0 {
            for k in left {
                self.running[k].give_up();
            }
            return;
        }
        let u = (u0 + u1) / 2.0;
        let middle = self.values(i, u);
        self.part(i, (u0, first), (u, middle), curvature);
        self.part(i, (u, middle), (u1, last), curvature);
    }
}
