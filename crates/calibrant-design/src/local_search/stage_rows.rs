//! The limits of one axis as rows: of the stages of a chain for long motions, and dense.
//!
//! Acceleration, velocity and displacement are in units of `size`, `size Δτ` and `size Δτ²`. The limits hold at the
//! nodes. Between them the velocity is limited at the time of its peak, and so is the displacement, where a motion
//! that was found broke the limit ([`Peaks`]).
//!
//! Limits that no motion can reach are left out: nothing accelerates beyond its limit, so the velocity at time t is
//! at most `a t`, and the displacement `a t²/2`, or `v t`.
//!
//! The limits of one axis as rows in its nodes alone, for short motions.
//!
//! Velocity and displacement at a time t are linear in the nodes' accelerations: node j adds the first and
//! the second integral of its hat function. So the limits at the nodes are rows, and so is a limit at any one
//! time between them. There are too many times to list. A motion that breaks a limit inside an interval gives
//! the row of the time at which it is worst ([`Region::rows_inside`]). At a peak the time does not matter
//! to first order, so a few such rows suffice.
//!
//! Rows that no motion within the acceleration limit can reach are left out.

use crate::convex::{Chain, LinearRow, Stage, StageRow, Transition};
use crate::limits::{InsideBreach, Region, State};
use calibrant_core::motion::Rest;
use nalgebra::Vector3;

/// Times between the nodes at which a limit holds, too.
#[derive(Debug, Clone, Default)]
pub(crate) struct Peaks(Vec<InsideBreach>);

/// A limit between the nodes that a motion keeps with more than this share to spare is forgotten.
const SPARE: f64 = 0.02;

impl Peaks {
    /// Adds the peaks beyond a limit. None is left out before the program is solved, or rounds would go in circles.
    pub(crate) fn update(&mut self, region: &Region, a: &[f64]) {
        self.0.extend(region.broken_inside(a));
    }

    /// Forgets the peaks that a motion keeps by far, once its program is solved. Of each interval the last two
    /// stay: the peak moves little from one motion to the next.
    pub(crate) fn forget(&mut self, region: &Region, stages: &[Stage]) {
        let mut newer = vec![[0; 2]; region.intervals()];
        let mut kept = Vec::new();
        for peak in self.0.drain(..).rev() {
            let count = &mut newer[peak.interval][usize::from(peak.state == State::Velocity)];
            if *count < 2 && region.peak_form(&peak).dot(&stages[peak.interval]).abs() > 1.0 - SPARE {
                kept.push(peak);
                *count += 1;
            }
        }
        kept.reverse();
        self.0 = kept;
    }
}

impl Region {
    /// The chain with all limits, and without an objective.
    pub(crate) fn chain(&self, peaks: &Peaks) -> Chain {
        let (l, n, unit) = (&self.limits, self.intervals(), self.tau[1]);
        let mut held = Vec::new();
        if l.rest == Rest::Both {
            held.push(Vector3::y());
        }
        if l.end.is_some() {
            held.push(Vector3::x());
        }
        Chain {
            transitions: (0..n).map(|i| Transition((self.tau[i + 1] - self.tau[i]) / unit)).collect(),
            free: l.start.is_none(),
            rows: self.stage_rows(peaks),
            held,
            slope: vec![Stage::zeros(); n + 1],
            square: vec![1.0; n],
        }
    }

    fn stage_rows(&self, peaks: &Peaks) -> Vec<StageRow> {
        let (l, n, unit) = (&self.limits, self.intervals(), self.tau[1]);
        let mut rows = Vec::new();
        let mut within = |stage: usize, c: Stage| {
            rows.push(StageRow { stage, c, bound: 1.0 });
            rows.push(StageRow { stage, c: -c, bound: 1.0 });
        };
        for i in 0..=n {
            let prescribed = (i == 0 && l.start.is_some()) || (i == n && l.end.is_some());
            if let (Some(limit), false) = (l.acceleration, prescribed) {
                within(i, Stage::x() * (self.size / limit));
            }
            if let (Some(limit), true) = (l.velocity, i > 0 && self.reaches_velocity(i)) {
                within(i, Stage::y() * (self.size * unit / limit));
            }
            if let (Some(limit), true) = (l.displacement, i > 0 && self.reaches_displacement(i)) {
                within(i, Stage::z() * (self.size * unit * unit / limit));
            }
            if i == n {
                break;
            }
            let dt = self.tau[i + 1] - self.tau[i];
            if let Some(limit) = l.jerk.filter(|jerk| l.acceleration.is_none_or(|a| 2.0 * a > jerk * dt)) {
                within(i, Stage::w() * (self.size / (limit * dt)));
            }
            if let (Some(limit), false) = (l.intercept, prescribed && self.tau[i] == 0.0) {
                within(i, (Stage::x() - Stage::w() * (self.tau[i] / dt)) * (self.size / limit));
            }
        }
        for peak in &peaks.0 {
            within(peak.interval, self.peak_form(peak));
        }
        rows
    }

    fn reaches_velocity(&self, node: usize) -> bool {
        let (l, t) = (&self.limits, self.tau[node]);
        l.acceleration.zip(l.velocity).is_none_or(|(a, v)| a * t > v)
    }

    fn reaches_displacement(&self, node: usize) -> bool {
        let (l, t) = (&self.limits, self.tau[node]);
        let Some(d) = l.displacement else { return false };
        l.acceleration.is_none_or(|a| a * t * t / 2.0 > d) && l.velocity.is_none_or(|v| v * t > d)
    }

    /// Velocity or displacement at the peak, relative to its limit.
    fn peak_form(&self, peak: &InsideBreach) -> Stage {
        let unit = self.tau[1];
        let dt = self.tau[peak.interval + 1] - self.tau[peak.interval];
        let h = peak.time / unit;
        // the jerk in units of the increment
        let jerk = unit / dt;
        match peak.state {
            State::Velocity => {
                Stage::new(h, 1.0, 0.0, jerk * h * h / 2.0, 0.0) * (self.size * unit / peak.limit)
            }
            State::Displacement => {
                let form = Stage::new(h * h / 2.0, h, 1.0, jerk * h * h * h / 6.0, 0.0);
                form * (self.size * unit * unit / peak.limit)
            }
        }
    }

    /// The stages of a motion.
    pub(crate) fn stages(&self, a: &[f64]) -> Vec<Stage> {
        let unit = self.tau[1];
        let mut state = Vector3::new(a[0] / self.size, 0.0, 0.0);
        let mut stages: Vec<Stage> = Vec::with_capacity(a.len());
        for i in 0..a.len() - 1 {
            let u = (a[i + 1] - a[i]) / self.size;
            let stage = Stage::new(state[0], state[1], state[2], u, 0.0);
            stages.push(stage);
            state = Transition((self.tau[i + 1] - self.tau[i]) / unit).next(&stage);
        }
        stages.push(Stage::new(state[0], state[1], state[2], 0.0, 0.0));
        stages
    }
}

/// Velocity and displacement at one time, as coefficients of the first nodes.
struct StateForm {
    velocity: Vec<f64>,
    displacement: Vec<f64>,
}

impl Region {
    /// All limits at the nodes but that of the jerk, in variables x with node i at `size · x[first + i]`.
    pub(crate) fn node_rows(&self, first: usize) -> Vec<LinearRow> {
        let (l, n) = (&self.limits, self.intervals());
        let mut rows = Vec::new();
        let mut within = |form: &[f64], node: usize, limit: Option<f64>| {
            if let Some(limit) = limit.filter(|&limit| self.can_reach(form, limit)) {
                rows.push(self.row(form, first + node, limit));
            }
        };
        for i in 0..n {
            let dt = self.tau[i + 1] - self.tau[i];
            let line = self.tau[i] / dt;
            within(&[1.0 + line, -line], i, l.intercept);
            let state = self.state(i, dt);
            within(&state.velocity, 0, l.velocity);
            within(&state.displacement, 0, l.displacement);
        }
        if let Some(limit) = l.acceleration {
            rows.extend((0..=n).map(|i| self.row(&[1.0], first + i, limit)));
        }
        let mut fixed = |node, form, value| rows.push(LinearRow::new(first + node, form, value, value));
        for (node, value) in [(0, l.start), (n, l.end)] {
            if let Some(value) = value {
                fixed(node, vec![1.0], value / self.size);
            }
        }
        if l.rest == Rest::Both {
            let end = self.state(n - 1, self.tau[n] - self.tau[n - 1]).velocity;
            fixed(0, end, 0.0);
        }
        rows
    }

    /// The rows of the times at which `a` breaks a limit most, in each interval where it does.
    pub(crate) fn rows_inside(&self, a: &[f64], first: usize) -> Vec<LinearRow> {
        let row = |breach: InsideBreach| {
            let forms = self.state(breach.interval, breach.time);
            let form = match breach.state {
                State::Velocity => forms.velocity,
                State::Displacement => forms.displacement,
            };
            self.row(&form, first, breach.limit)
        };
        self.broken_inside(a).into_iter().map(row).collect()
    }

    fn row(&self, form: &[f64], first: usize, limit: f64) -> LinearRow {
        LinearRow::new(first, form.iter().map(|c| c * self.size).collect(), -limit, limit)
    }

    fn can_reach(&self, form: &[f64], limit: f64) -> bool {
        let largest = |a: f64| form.iter().map(|c| c.abs() * a).sum::<f64>();
        self.limits.acceleration.is_none_or(|a| largest(a) > limit)
    }

    /// Velocity and displacement at `s` after the start of interval i.
    fn state(&self, i: usize, s: f64) -> StateForm {
        let tau = &self.tau;
        let (t, dt) = (tau[i] + s, tau[i + 1] - tau[i]);
        let (mut velocity, mut displacement) = (vec![0.0; i + 2], vec![0.0; i + 2]);
        // the falling half of node k's hat and the rising half of the next: area, and place of the centre
        for k in 0..i {
            let step = tau[k + 1] - tau[k];
            for (node, place) in [(k, tau[k] + step / 3.0), (k + 1, tau[k + 1] - step / 3.0)] {
                velocity[node] += step / 2.0;
                displacement[node] += step / 2.0 * (t - place);
            }
        }
        let rising = [s * s / (2.0 * dt), s * s * s / (6.0 * dt)];
        velocity[i] += s - rising[0];
        velocity[i + 1] = rising[0];
        displacement[i] += s * s / 2.0 - rising[1];
        displacement[i + 1] = rising[1];
        StateForm { velocity, displacement }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibrant_core::motion::{AxisLimits, JerkControlledMotion};
    use nalgebra::{DVector, Vector3};

    fn region() -> Region {
        let limits = AxisLimits {
            acceleration: Some(10.0),
            velocity: Some(0.4),
            displacement: Some(0.3),
            rest: Rest::Both,
            ..AxisLimits::default()
        };
        Region::new(limits, &[0.0, 0.5, 1.0, 1.5, 2.0])
    }

    #[test]
    fn the_forms_are_velocity_and_displacement() {
        let (region, a) = (region(), [1.0, -2.0, 4.0, -3.0, 2.0]);
        let motion = JerkControlledMotion::uniform(0.5, a.iter().map(|&a| Vector3::repeat(a)).collect())
            .expect("valid");
        for (i, s) in [(0, 0.2), (1, 0.5), (3, 0.1)] {
            let form = region.state(i, s);
            let at = |form: &[f64]| form.iter().zip(&a).map(|(c, a)| c * a).sum::<f64>();
            let t = 0.5 * i as f64 + s;
            assert!((at(&form.velocity) - motion.states_at(&[t])[0].velocity_mps.x).abs() < 1e-14);
            assert!((at(&form.displacement) - motion.states_at(&[t])[0].displacement_m.x).abs() < 1e-14);
        }
    }

    #[test]
    fn a_motion_that_breaks_a_limit_in_between_gives_the_row_that_forbids_it() {
        // velocity 0 at the nodes 0, 2 and 4, and 0.5 in between
        let (region, a) = (region(), [1.0, 1.0, -3.0, 1.0, 1.0]);
        let x = DVector::from_iterator(5, a.iter().map(|a| a / region.size));
        let rows = region.rows_inside(&a, 0);
        assert!(!rows.is_empty());
        for row in &rows {
            assert!(row.at(&x) > row.upper || row.at(&x) < row.lower);
        }
        let kept: Vec<f64> = a.iter().map(|a| a * 0.1).collect();
        assert!(region.rows_inside(&kept, 0).is_empty());
    }

    #[test]
    fn a_limit_out_of_reach_has_no_row() {
        // 10 m/s² for 2 s go 20 m: no node can break a limit of 30 m
        let slow = Region::new(AxisLimits { displacement: Some(30.0), ..region().limits }, &region().tau);
        assert!(slow.node_rows(0).len() < region().node_rows(0).len());
    }
}
