//! `design.json` of the trajectory of a machine, and `evaluation.json` of one.

use super::heading::{Heading, JsonFile};
use super::reach::Reached;
use crate::experiment::{LinksKnown, MachineDesignPlan};
use calibrant_core::estimate::{Budget, VarianceSource};
use calibrant_core::form::rows;
use calibrant_core::json::{flat, if_some};
use calibrant_core::json_object;
use calibrant_machine_design::world::{Body, Capsule, LeftOutPair, Reason, World};
use calibrant_machine_design::{
    Kept, LimitProof, TrajectoryBound, TrajectoryDesign, TrajectoryEvaluation, TrajectoryProblem,
    TrajectoryStart,
};
use schemars::JsonSchema;
use serde::Serialize;

/// The content of `design.json`.
#[derive(Clone, Copy)]
pub struct TrajectoryFile<'a> {
    /// The trajectory.
    pub design: &'a TrajectoryDesign,
    /// What it is for.
    pub problem: &'a TrajectoryProblem<'a>,
    /// What the experiment says of it.
    pub plan: &'a MachineDesignPlan,
    /// What the machine must not touch.
    pub world: &'a World,
    /// The goals that it reaches, where a duration was sought.
    pub reached: Option<&'a Reached>,
}

/// The content of `evaluation.json`.
#[derive(Clone, Copy)]
pub struct TrajectoryEvaluationFile<'a> {
    /// The trajectory that was given.
    pub evaluation: &'a TrajectoryEvaluation,
    /// The best one; `None` where it was not sought.
    pub design: Option<&'a TrajectoryDesign>,
    /// What it is for.
    pub problem: &'a TrajectoryProblem<'a>,
    /// What the experiment says of it.
    pub plan: &'a MachineDesignPlan,
    /// What the machine must not touch.
    pub world: &'a World,
}

json_object! {
    /// The best trajectory of a machine, what it determines, and the proof of its limits. The trajectory itself is in `trajectory.csv`.
    TrajectoryFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        /// How the search ended.
        status: file.design.status.name(),
        setting: flat(Setting { problem: file.problem, plan: file.plan, world: file.world }),
        /// What the best trajectory gives.
        optimal: Value { of: &file.design.optimal, problem: file.problem },
        /// What a random admissible motion gives: the first start.
        random: Value { of: &file.design.random, problem: file.problem },
        /// The plain routine that an engineer would write, in the same time: `six poses` or `joints in turn`.
        plain_routine: if_some(file.design.plain.as_ref().map(|of| of.routine.name())),
        /// What it gives; missing where none was found that keeps the limits.
        plain: if_some(file.design.plain.as_ref().map(|of| Value { of: &of.evaluation, problem: file.problem })),
        /// Times at which the machine stands still, from and to, s.
        dwells_s: file.design.dwells_s.iter().map(|(from, to)| [*from, *to]).collect::<Vec<_>>(),
        /// A bound on what admissible trajectories can reach; it is loose, and its minimum was looked for on a grid.
        bound: if_some(file.design.bound.map(Bound::of)),
        /// The starts of the search, the best first.
        starts: file.design.starts.iter().map(Start::of).collect::<Vec<_>>(),
        /// Iterations of all starts.
        iterations: file.design.iterations,
        reach: if_some(file.reached),
    }
}

impl JsonFile for TrajectoryFile<'_> {
    const KIND: &'static str = "trajectory";
}

json_object! {
    /// A trajectory that was given, beside the best one.
    TrajectoryEvaluationFile<'_> as file {
        heading: flat(Heading::<Self>::of()),
        setting: flat(Setting { problem: file.problem, plan: file.plan, world: file.world }),
        /// What the given trajectory gives.
        evaluation: Value { of: file.evaluation, problem: file.problem },
        /// What the best one gives.
        optimal: if_some(file.design.map(|design| Value { of: &design.optimal, problem: file.problem })),
    }
}

impl JsonFile for TrajectoryEvaluationFile<'_> {
    const KIND: &'static str = "trajectory-evaluation";
}

/// What both files say of the machine.
#[derive(Clone, Copy)]
struct Setting<'a> {
    problem: &'a TrajectoryProblem<'a>,
    plan: &'a MachineDesignPlan,
    world: &'a World,
}

json_object! {
    Setting<'_> as of {
        /// Letter of the criterion; its value is in nats: D is ln det C, and a mean variance v of r numbers is r ln v.
        criterion: of.problem.criterion.letter(),
        /// Duration, s.
        duration_s: of.problem.duration_s,
        /// Sample rate of the IMU, Hz.
        rate_hz: of.plan.rate_hz,
        /// Noise in motion over noise at rest.
        moving_noise: of.plan.moving_noise,
        /// The joints, in the order of all lists of joints.
        joints: of.problem.chain.joints.iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>(),
        /// The parameters of the sensor, in the order of all lists of parameters.
        parameters: of.problem.quantities.iter().map(|quantity| quantity.name()).collect::<Vec<_>>(),
        /// The bodies of the machine and of the sensor: capsules.
        bodies: of.world.scene().bodies.iter().map(BodyShape::of).collect::<Vec<_>>(),
        /// What is known of the shapes of the links.
        links: match of.plan.world.links {
            LinksKnown::Shapes => "shapes",
            LinksKnown::Joints => "joints",
            LinksKnown::Nothing => "nothing",
        },
        /// Links whose mesh is missing: a capsule from joint to joint stands for each.
        without_mesh: of.plan.world.without_mesh.iter().map(|of| of.link.as_str()).collect::<Vec<_>>(),
        /// Pairs of bodies that are not kept apart, and why.
        left_out: of.world.left_out().iter().map(LeftOut::of).collect::<Vec<_>>(),
        /// Smallest distance that is kept, m.
        clearance_m: of.problem.clearance_m,
    }
}

/// What a trajectory gives.
#[derive(Clone, Copy)]
struct Value<'a> {
    of: &'a TrajectoryEvaluation,
    problem: &'a TrajectoryProblem<'a>,
}

json_object! {
    Value<'_> as value {
        /// Value of the criterion, in nats; null where the parameters are not determined.
        value: value.of.value.is_finite().then_some(value.of.value),
        /// Standard deviation that a calibration will state of each parameter; null where they are not determined.
        sd: value.of.covariance.as_ref().map(|of| of.diagonal().iter().map(|of| of.sqrt()).collect::<Vec<f64>>()),
        /// Entry (i, j) in the unit of parameter i times that of parameter j.
        covariance: value.of.covariance.as_ref().map(rows),
        /// Where the variance of each parameter comes from.
        budget: Budget::of(&value.of.budget, VarianceSource::ON_MACHINE),
        /// Posture at the beginning, rad or m: the machine goes there first.
        start: value.of.motion.at(value.of.motion.knots.start_s, 0),
        /// Every limit, and whether it is proved for all times.
        limits: value.limits(),
    }
}

impl Value<'_> {
    fn limits(&self) -> Vec<LimitUsed> {
        let used = |proof: &LimitProof| LimitUsed {
            kind: proof.limit.kind(),
            of: self.problem.limited(proof.limit),
            unit: self.problem.unit_of(proof.limit),
            peak: proof.peak,
            allowed: proof.allowed,
            used: proof.used,
            time_s: proof.time_s,
            is_proved: proof.kept == Kept::Proved,
            is_broken: proof.kept == Kept::Broken,
        };
        self.of.limits.iter().map(used).collect()
    }
}

/// How far a trajectory goes towards a limit.
#[derive(Serialize, JsonSchema)]
struct LimitUsed {
    /// What is limited: position, velocity, …
    kind: &'static str,
    /// Of what: a joint, an axis of the sensor, the tip, or two bodies.
    of: String,
    /// Unit of peak and limit.
    unit: &'static str,
    /// The value nearest to the limit.
    peak: f64,
    /// The limit there.
    allowed: f64,
    /// Share of the limit that is used; of a distance, the clearance over the distance.
    used: f64,
    /// When, s.
    time_s: f64,
    /// Is it proved that the limit is kept at all times?
    is_proved: bool,
    /// Is it broken?
    is_broken: bool,
}

/// The bound.
#[derive(Serialize, JsonSchema)]
struct Bound {
    /// The smallest value that the bound leaves, nats.
    value: f64,
    /// By the bound, standard deviations are at most so many times smaller than those of the design.
    times_better: f64,
}

impl Bound {
    fn of(bound: TrajectoryBound) -> Self {
        Self { value: bound.value, times_better: bound.times_better }
    }
}

/// A start of the search.
#[derive(Serialize, JsonSchema)]
struct Start {
    /// Its number.
    number: usize,
    /// Distance of the knots that it reached, s.
    knot_s: f64,
    /// Value there, nats.
    value: f64,
    /// Did it reach the last stage?
    is_polished: bool,
    /// How it ended.
    status: &'static str,
}

impl Start {
    fn of(start: &TrajectoryStart) -> Self {
        Self {
            number: start.number,
            knot_s: start.knot_s,
            value: start.value,
            is_polished: start.polished,
            status: start.status.name(),
        }
    }
}

/// A body: all points within a radius of one of its segments.
#[derive(Serialize, JsonSchema)]
struct BodyShape {
    /// Its name: a link, or the sensor.
    name: String,
    /// The frame that it moves with: 0 the base, k the one behind joint k.
    frame: usize,
    /// Its capsules, in the axes of that frame.
    capsules: Vec<CapsuleShape>,
}

/// All points within a radius of a segment.
#[derive(Serialize, JsonSchema)]
struct CapsuleShape {
    /// One end of the segment, m.
    from_m: [f64; 3],
    /// The other end, m.
    to_m: [f64; 3],
    /// The radius, m.
    radius_m: f64,
}

impl BodyShape {
    fn of(body: &Body) -> Self {
        let shape = |of: &Capsule| CapsuleShape {
            from_m: of.ends_m[0].into(),
            to_m: of.ends_m[1].into(),
            radius_m: of.radius_m,
        };
        Self {
            name: body.name.clone(),
            frame: body.frame,
            capsules: body.capsules.iter().map(shape).collect(),
        }
    }
}

/// Two bodies that are not kept apart.
#[derive(Serialize, JsonSchema)]
struct LeftOut {
    /// Their names.
    bodies: [String; 2],
    /// Why: they are neighbours, an SRDF file disables the pair, or no sampled posture parts their capsules.
    reason: &'static str,
}

impl LeftOut {
    fn of(pair: &LeftOutPair) -> Self {
        let reason = match pair.reason {
            Reason::Neighbours => "neighbours",
            Reason::NeverApart { .. } => "never_apart",
            Reason::Disabled => "disabled",
        };
        Self { bodies: pair.bodies.clone(), reason }
    }
}
