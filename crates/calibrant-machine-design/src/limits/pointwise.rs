//! Limits at the times of a grid: distances, the sensor's range, speeds of tip and sensor body, speeds near the ends of joints.
//!
//! Each row is a number `G` that is positive where the limit is kept, about 1 far from it, with its derivative by positions, velocities and accelerations of
//! the joints.
//!
//! | limit | G |
//! |---|---|
//! | distance `d ≥ d_min` | `s (2 − s)`, `s = (d − d_min)/D` where `s < 1`, else 1 |
//! | range `\|f_i\| ≤ F` | `1 − (f_i/F)²` |
//! | speed of the tip `\|v\| ≤ V` | `1 − (\|v\|/V)²` |
//! | speed of a body of radius `r` | `1 − ((\|v\| + r \|ω\|)/V)²`: no point of it is faster |
//! | speed near the ends of a joint | `(k (upper − q) − max(q̇ + o, 0)²)/(k (upper − lower)/2)` |
//!
//! A distance beyond `d_min + D` says nothing: its row is constant.

use super::kinematics::{PointVelocity, per_joint, poses};
use super::{SensorBody, Surroundings};
use crate::TrajectoryProblem;
use crate::motion::{Grid, derivatives};
use crate::recursion::{JointAt, Links, Sweep, V};
use crate::world::Proximity;
use nalgebra::{DMatrix, IsometryMatrix3, Point3, Vector3};

/// `D`: distances that matter, m. An arm at 2 m/s covers it in a tenth of a second, about the distance of two times at which limits are taken.
const NEAR_M: f64 = 0.2;

/// Limits with what the search holds back of them.
#[derive(Clone)]
pub(crate) struct Pointwise<'a> {
    pub(crate) problem: &'a TrajectoryProblem<'a>,
    links: Links,
    /// Distance that is kept, m.
    pub(crate) clearance_m: f64,
    /// Part of ranges and speeds that is used.
    pub(crate) share: f64,
    /// Ranges of the six readings; only finite ones are rows.
    ranges: Vec<(usize, f64)>,
    points: Vec<SensorBody>,
    near_ends: Vec<usize>,
    distances: usize,
    tip: IsometryMatrix3<f64>,
}

/// Values of all rows at one time, and derivatives where they are wanted.
pub(crate) struct PointRows<'r> {
    pub(crate) values: &'r mut [f64],
    /// Of distances, by positions.
    pub(crate) by_position: &'r mut [f64],
    /// Of all other rows, by positions, by velocities, by accelerations.
    pub(crate) by_state: &'r mut [f64],
    pub(crate) with_slopes: bool,
}

/// Working memory.
#[derive(Clone)]
pub(crate) struct PointWork {
    /// Poses of the base and of the frames behind each joint.
    frames: Vec<IsometryMatrix3<f64>>,
    sweep: Sweep,
    joints: Vec<JointAt>,
    proximities: Vec<Proximity>,
}

impl<'a> Pointwise<'a> {
    pub(crate) fn new(
        problem: &'a TrajectoryProblem<'a>,
        links: Links,
        clearance_m: f64,
        share: f64,
    ) -> Self {
        let all = problem.force_range_mps2.iter().chain(problem.rate_range_radps.iter());
        let tip = SensorBody { center_m: Vector3::zeros(), radius_m: 0.0 };
        let points = problem.tip_speed_mps.map(|_| [Some(tip), problem.sensor_body].into_iter().flatten());
        Self {
            ranges: all.copied().enumerate().filter(|(_, range)| range.is_finite()).collect(),
            points: points.into_iter().flatten().collect(),
            near_ends: (0..problem.joints.len()).filter(|j| problem.joints[*j].near_ends.is_some()).collect(),
            distances: problem.surroundings.map_or(0, Surroundings::rows),
            tip: nalgebra::convert(problem.chain.tip_transform),
            problem,
            links,
            clearance_m,
            share,
        }
    }

    /// Number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.distances + self.ranges.len() + self.points.len() + 2 * self.near_ends.len()
    }

    /// Number of those that depend on positions alone, which come first.
    pub(crate) fn position_rows(&self) -> usize {
        self.distances
    }

    pub(crate) fn work(&self) -> PointWork {
        let n = self.links.len();
        PointWork {
            frames: vec![IsometryMatrix3::identity(); n + 1],
            sweep: Sweep::new(n),
            joints: vec![JointAt::REST; n],
            proximities: vec![Proximity::far(); self.distances],
        }
    }

    /// All rows at time `k` of a grid.
    pub(crate) fn at(
        &self,
        work: &mut PointWork,
        grid: &Grid,
        k: usize,
        controls: &DMatrix<f64>,
        rows: PointRows<'_>,
    ) {
        let (i, weights) = grid.rows(k);
        for (j, joint) in work.joints.iter_mut().enumerate() {
            let [q, qd, qdd, _] = derivatives(controls, i, weights, j);
            *joint = JointAt::new(q, qd, qdd);
        }
        self.at_state(work, rows);
    }

    /// All rows at the state of the joints in the working memory.
    fn at_state(&self, work: &mut PointWork, rows: PointRows<'_>) {
        let PointRows { values, by_position, by_state, with_slopes } = rows;
        if with_slopes {
            by_position.fill(0.0);
            by_state.fill(0.0);
        }
        let PointWork { sweep, joints, frames, .. } = work;
        sweep.forward(&self.links, joints);
        if self.distances + self.points.len() > 0 {
            poses(sweep, &self.links, joints, frames);
        }
        let (distances, others) = values.split_at_mut(self.distances);
        self.distances(work, distances, by_position, with_slopes);
        let (ranges, others) = others.split_at_mut(self.ranges.len());
        let (speeds, near_ends) = others.split_at_mut(self.points.len());
        let width = 3 * self.links.len();
        let part = |rows: usize| if with_slopes { rows * width } else { 0 };
        let (of_ranges, rest) = by_state.split_at_mut(part(ranges.len()));
        let (of_speeds, of_near_ends) = rest.split_at_mut(part(speeds.len()));
        self.ranges(work, ranges, of_ranges, with_slopes);
        self.speeds(work, speeds, of_speeds, with_slopes);
        self.near_ends(work, near_ends, of_near_ends, with_slopes);
    }

    fn distances(&self, work: &mut PointWork, values: &mut [f64], slopes: &mut [f64], with_slopes: bool) {
        let Some(surroundings) = self.problem.surroundings else { return };
        let n = self.links.len();
        let PointWork { sweep, frames, proximities, .. } = work;
        surroundings.proximities(frames, proximities);
        for (row, (value, near)) in values.iter_mut().zip(proximities.iter()).enumerate() {
            let s = (near.distance_m - self.clearance_m) / NEAR_M;
            if s >= 1.0 {
                *value = 1.0;
                continue;
            }
            *value = s * (2.0 - s);
            if with_slopes {
                let slope = 2.0 * (1.0 - s) / NEAR_M;
                let of = &mut slopes[row * n..(row + 1) * n];
                // the normal is from a to b: what carries b away along it adds distance. Joints before both move them together
                let ((a, of_a), (b, of_b)) = (near.a, near.b);
                let (joints, point, slope) = if a < b { (a..b, of_b, slope) } else { (b..a, of_a, -slope) };
                let (point, normal) = (V::of(&point), V::of(&near.normal) * slope);
                for k in joints {
                    of[k] = normal.dot(&per_joint(sweep, &self.links, k, &point));
                }
            }
        }
    }

    fn ranges(&self, work: &mut PointWork, values: &mut [f64], slopes: &mut [f64], with_slopes: bool) {
        if self.ranges.is_empty() {
            return;
        }
        let PointWork { sweep, joints, .. } = work;
        let readings = sweep.readings();
        let mut factors = [0.0; 6];
        for (value, &(reading, range)) in values.iter_mut().zip(&self.ranges) {
            let range = range * self.share;
            let at = readings[reading / 3].0[reading % 3];
            *value = 1.0 - (at / range).powi(2);
            factors[reading] = -2.0 * at / (range * range);
        }
        if !with_slopes {
            return;
        }
        let (n, axes) = (joints.len(), &sweep.sensor().turn);
        for k in 0..n {
            let [force_q, force_qd, force_qdd, rate_q, rate_qd] = sweep.of_joint(&self.links, k);
            let [V(force_q), V(force_qd), V(force_qdd)] = [
                axes.transposed_times(&force_q),
                axes.transposed_times(&force_qd),
                axes.transposed_times(&force_qdd),
            ];
            let [V(rate_q), V(rate_qd)] = [axes.transposed_times(&rate_q), axes.transposed_times(&rate_qd)];
            for (slopes, &(reading, _)) in slopes.chunks_exact_mut(3 * n).zip(&self.ranges) {
                let (factor, i) = (factors[reading], reading % 3);
                if reading < 3 {
                    slopes[k] = factor * force_q[i];
                    slopes[n + k] = factor * force_qd[i];
                    slopes[2 * n + k] = factor * force_qdd[i];
                } else {
                    slopes[k] = factor * rate_q[i];
                    slopes[n + k] = factor * rate_qd[i];
                }
            }
        }
    }

    fn speeds(&self, work: &mut PointWork, values: &mut [f64], slopes: &mut [f64], with_slopes: bool) {
        let Some(limit) = self.problem.tip_speed_mps else { return };
        let (limit, n) = (limit * self.share, self.links.len());
        let PointWork { sweep, frames, joints, .. } = work;
        let tip = frames[n] * self.tip;
        for (row, (value, body)) in values.iter_mut().zip(&self.points).enumerate() {
            let point = V::of(&(tip * Point3::from(body.center_m)).coords);
            let of = PointVelocity::new(sweep, &self.links, joints, &point);
            let (v, w) = (of.v.norm(), of.w.norm());
            let speed = v + body.radius_m * w;
            *value = 1.0 - (speed / limit).powi(2);
            if with_slopes {
                let factor = -2.0 * speed / (limit * limit);
                // at rest the speed, which is a factor, is 0
                let unit = |of: V, norm: f64| of * (factor / norm.max(1e-12));
                let (a, b) = (unit(of.v, v), unit(of.w, w) * body.radius_m);
                let slopes = &mut slopes[row * 3 * n..(row + 1) * 3 * n];
                of.slopes((sweep, &self.links, joints), &point, [&a, &b], |k, q, qd| {
                    (slopes[k], slopes[n + k]) = (q, qd);
                });
            }
        }
    }

    fn near_ends(&self, work: &mut PointWork, values: &mut [f64], slopes: &mut [f64], with_slopes: bool) {
        let n = self.links.len();
        for (place, &j) in self.near_ends.iter().enumerate() {
            let Some(limit) = self.problem.joints[j].near_ends else { continue };
            let scale = 2.0 / (limit.slope * (limit.upper - limit.lower));
            let at = work.joints[j];
            let rooms = limit.rooms(at.q, at.qd / self.share);
            for (side, [room, by_position, by_speed]) in rooms.into_iter().enumerate() {
                let row = 2 * place + side;
                values[row] = room * scale;
                if with_slopes {
                    slopes[row * 3 * n + j] = by_position * scale;
                    slopes[row * 3 * n + n + j] = by_speed * scale / self.share;
                }
            }
        }
    }
}
