//! Limits in words: the kind, what it is of, and its unit.

use crate::{TrajectoryLimit, TrajectoryProblem};
use calibrant_core::sensor::Axis;

impl TrajectoryLimit {
    /// Its kind, as in results: `velocity`.
    #[must_use]
    pub fn kind(self) -> &'static str {
        match self {
            Self::Position(_) => "position",
            Self::Velocity(_) => "velocity",
            Self::Acceleration(_) => "acceleration",
            Self::Jerk(_) => "jerk",
            Self::Rest(_) => "velocity at begin and end",
            Self::SpeedNearEnds(_) => "velocity near the ends",
            Self::Force(_) => "specific force",
            Self::Rate(_) => "angular rate",
            Self::TipSpeed | Self::SensorSpeed => "speed",
            Self::Clearance(_) => "distance",
        }
    }
}

impl TrajectoryProblem<'_> {
    /// What a limit is of: a joint, an axis of the sensor, the tip, or two bodies.
    #[must_use]
    pub fn limited(&self, limit: TrajectoryLimit) -> String {
        match limit {
            TrajectoryLimit::Position(j)
            | TrajectoryLimit::Velocity(j)
            | TrajectoryLimit::Acceleration(j)
            | TrajectoryLimit::Jerk(j)
            | TrajectoryLimit::Rest(j)
            | TrajectoryLimit::SpeedNearEnds(j) => self.chain.joints[j].name.clone(),
            TrajectoryLimit::Force(axis) | TrajectoryLimit::Rate(axis) => {
                format!("sensor {}", Axis::ALL[axis])
            }
            TrajectoryLimit::TipSpeed => "tip".into(),
            TrajectoryLimit::SensorSpeed => "sensor body".into(),
            TrajectoryLimit::Clearance(row) => {
                let pair = self.surroundings.map(|of| of.pair(row).names);
                pair.map_or_else(String::new, |[one, other]| format!("{one} – {other}"))
            }
        }
    }

    /// The unit of a limit.
    #[must_use]
    pub fn unit_of(&self, limit: TrajectoryLimit) -> &'static str {
        let of = |j: usize, units: [&'static str; 2]| units[usize::from(!self.chain.joints[j].kind.turns())];
        match limit {
            TrajectoryLimit::Position(j) => of(j, ["rad", "m"]),
            TrajectoryLimit::Velocity(j) | TrajectoryLimit::Rest(j) => of(j, ["rad/s", "m/s"]),
            TrajectoryLimit::Acceleration(j) => of(j, ["rad/s²", "m/s²"]),
            TrajectoryLimit::Jerk(j) => of(j, ["rad/s³", "m/s³"]),
            TrajectoryLimit::SpeedNearEnds(_) => "1",
            TrajectoryLimit::Force(_) => "m/s²",
            TrajectoryLimit::Rate(_) => "rad/s",
            TrajectoryLimit::TipSpeed | TrajectoryLimit::SensorSpeed => "m/s",
            TrajectoryLimit::Clearance(_) => "m",
        }
    }
}
