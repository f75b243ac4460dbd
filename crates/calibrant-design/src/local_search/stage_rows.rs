//! The limits of one axis as rows of the stages of a chain, for long motions.
//!
//! Acceleration, velocity and displacement are in units of `size`, `size Δτ` and `size Δτ²`. The limits hold at the
//! nodes. Between them the velocity is limited at the time of its peak, and so is the displacement, where a motion
//! that was found broke the limit ([`Peaks`]).
//!
//! Limits that no motion can reach are left out: nothing accelerates beyond its limit, so the velocity at time t is
//! at most `a t`, and the displacement `a t²/2`, or `v t`.

use crate::convex::chain_factor::{Stage, Transition};
use crate::convex::chain_program::{Chain, StageRow};
use crate::limits::admissible_region::{InsideBreach, Region, State};
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
