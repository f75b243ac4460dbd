//! Limits, how far a trajectory goes towards each, and whether it is proved to keep it.

/// A limit of a trajectory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TrajectoryLimit {
    /// Position of a joint, rad or m.
    Position(usize),
    /// Speed of a joint.
    Velocity(usize),
    /// Acceleration of a joint.
    Acceleration(usize),
    /// Jerk of a joint.
    Jerk(usize),
    /// Speed of a joint at the beginning and at the end of the motion.
    Rest(usize),
    /// Speed of a joint near its ends.
    SpeedNearEnds(usize),
    /// Specific force on an axis of the sensor, m/s².
    Force(usize),
    /// Angular rate about an axis of the sensor, rad/s.
    Rate(usize),
    /// Speed of the tip frame, m/s.
    TipSpeed,
    /// Speed of the sensor's body, m/s.
    SensorSpeed,
    /// Distance of a pair of bodies, m.
    Clearance(usize),
}

/// How far a trajectory goes towards a limit, and whether it keeps it for all times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimitProof {
    /// The limit.
    pub limit: TrajectoryLimit,
    /// The value nearest to it that was seen.
    pub peak: f64,
    /// The limit's value there.
    pub allowed: f64,
    /// Share of the limit that is used; of a distance, the clearance over the distance.
    pub used: f64,
    /// Time of the peak, s.
    pub time_s: f64,
    /// Is it kept?
    pub kept: Kept,
}

/// Whether a limit is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kept {
    /// For all times: proved.
    Proved,
    /// At all times that were looked at; the proof came to its end.
    Unproved,
    /// Not.
    Broken,
}

/// Limits are broken where they are exceeded by more than this part: rounding of control points that go through files.
pub(crate) const ROUNDING: f64 = 1e-9;

/// Shortest part of an interval that a bisection looks at.
pub(super) const SHORTEST: f64 = 1e-6;

/// Parts of an interval at most. A limit that is touched takes two for each halving; one along which the motion stays would take all of them.
pub(super) const MOST_PARTS: usize = 2000;

/// A proof under way: the peak so far, and what is known.
#[derive(Debug, Clone, Copy)]
pub(super) struct Running {
    pub(super) peak: f64,
    pub(super) time_s: f64,
    pub(super) kept: Kept,
}

impl Running {
    pub(super) fn new() -> Self {
        Self { peak: f64::NEG_INFINITY, time_s: 0.0, kept: Kept::Proved }
    }

    /// A value, larger being nearer to the limit.
    pub(super) fn see(&mut self, value: f64, time_s: f64) {
        if value > self.peak {
            (self.peak, self.time_s) = (value, time_s);
        }
    }

    pub(super) fn breaks(&mut self) {
        self.kept = Kept::Broken;
    }

    pub(super) fn give_up(&mut self) {
        if self.kept == Kept::Proved {
            self.kept = Kept::Unproved;
        }
    }

    pub(super) fn proof(&self, limit: TrajectoryLimit, allowed: f64) -> LimitProof {
        let used = self.peak / allowed;
        LimitProof { limit, peak: self.peak, allowed, used, time_s: self.time_s, kept: self.kept }
    }
}
