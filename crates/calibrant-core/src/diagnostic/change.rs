//! A change of a sensor within a recording: what changes, when, and by how much.

use crate::diagnostic::parts::{Part, Parts};
use crate::sensor::SensorKind;
use nalgebra::Vector3;

/// A sensor that changes within a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// The sensor.
    pub sensor_kind: SensorKind,
    /// The property that changes.
    pub of: Changed,
    /// Another property whose change explains the residuals nearly as well.
    pub instead: Option<Changed>,
    /// When.
    pub course: Course,
    /// The difference of after and before, or of end and begin. For each axis, in the unit of [`Changed`].
    pub amount: Vector3<f64>,
    /// Its standard deviation, or zero for an axis that the data do not determine.
    pub sd: Vector3<f64>,
    /// p-value of the change, over all times at which it might occur.
    pub p_value: f64,
}

/// The property of a sensor that changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Changed {
    /// Its bias, m/s² or rad/s.
    Bias,
    /// Its gains, as shares of themselves.
    Gain,
    /// The directions of its axes against those of the accelerometer, rad about each.
    Axes,
}

/// The course of a change in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Course {
    /// All at once.
    Step {
        /// Number of the last hold before it, from 0.
        before: usize,
        /// Number of the first hold after it. It equals `before` if the change lies within that hold.
        after: usize,
        /// About when, s.
        time_s: f64,
    },
    /// Proportional to time.
    Drift,
    /// There and back. The amount is that of the holds in between, against those before and after.
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
    /// The largest amount of an axis, in its standard deviations.
    #[must_use]
    pub fn in_sd(&self) -> f64 {
        let ratio = |(amount, sd): (&f64, &f64)| if *sd > 0.0 { amount.abs() / sd } else { 0.0 };
        self.amount.iter().zip(&self.sd).map(ratio).fold(0.0, f64::max)
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
