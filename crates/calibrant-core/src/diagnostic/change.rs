//! A change of a sensor within a recording: of what, when and by how much.

use crate::diagnostic::parts::{Part, Parts};
use crate::sensor::SensorKind;
use nalgebra::Vector3;

/// A sensor that is not the same throughout a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// The sensor.
    pub sensor_kind: SensorKind,
    /// What of it changes.
    pub of: Changed,
    /// What explains the residuals nearly as well in its place.
    pub instead: Option<Changed>,
    /// When.
    pub course: Course,
    /// By how much, from before to after, or from begin to end; per axis, in the unit of [`Changed`].
    pub amount: Vector3<f64>,
    /// Its standard deviation; zero for an axis of which nothing is known.
    pub sd: Vector3<f64>,
    /// Probability of a change at least as significant, at any time, in a sensor that does not change.
    pub p_value: f64,
}

/// What of a sensor changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Changed {
    /// Its bias, m/s² or rad/s.
    Bias,
    /// Its gains, as shares of themselves.
    Gain,
    /// The directions of its axes against those of the accelerometer, rad about each.
    Axes,
}

/// How a change runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Course {
    /// All at once.
    Step {
        /// Number of the last hold before it, from 0.
        before: usize,
        /// Number of the first hold after it; the same where it is seen in the rotations beside that hold.
        after: usize,
        /// About when, s.
        time_s: f64,
    },
    /// All along, as time.
    Drift,
    /// There and back: the amount is that of the holds in between against those before and after.
    Episode {
        /// Number of the first hold of it, from 0.
        first: usize,
        /// Number of the last hold of it, from 0.
        last: usize,
        /// About when it begins, s.
        start_s: f64,
        /// About when it ends, s.
        end_s: f64,
    },
}

impl Change {
    /// The largest amount on an axis in its standard deviations.
    #[must_use]
    pub fn in_sd(&self) -> f64 {
        let of = |(amount, sd): (&f64, &f64)| if *sd > 0.0 { amount.abs() / sd } else { 0.0 };
        self.amount.iter().zip(&self.sd).map(of).fold(0.0, f64::max)
    }
}

impl Part for Change {
    fn add_to(&self, parts: &mut Parts, _: &'static str) {
        parts.subject.push(self.sensor_kind.name().to_owned());
        match self.course {
            Course::Step { before, after, time_s } => {
                let holds = [("before_hold", before), ("after_hold", after)];
                parts.numbers.extend(holds.map(|(key, hold)| (key, hold as f64 + 1.0)));
                parts.numbers.push(("time_s", time_s));
            }
            Course::Drift => {}
            Course::Episode { first, last, start_s, end_s } => {
                let holds = [("first_hold", first), ("last_hold", last)];
                parts.numbers.extend(holds.map(|(key, hold)| (key, hold as f64 + 1.0)));
                parts.numbers.extend([("start_s", start_s), ("end_s", end_s)]);
            }
        }
        let amount = ["amount_x", "amount_y", "amount_z"].into_iter().zip(self.amount.iter().copied());
        parts.numbers.extend(amount);
        parts.numbers.extend([("deviations", self.in_sd()), ("p_value", self.p_value)]);
    }
}
