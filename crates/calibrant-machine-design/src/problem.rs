//! What is designed, and how long it is searched.

use crate::TrajectoryCriterion;
use crate::limits::{JointLimit, SensorBody, Surroundings};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::progress::Progress;
use calibrant_core::sensor::{ImuQuantity, SensorKind};
use calibrant_design::Interruption;
use calibrant_machine::chain::KinematicChain;
use calibrant_machine::estimate::MachineSetup;
use nalgebra::Vector3;

/// Find the trajectory of a chain whose recording determines the sensor's parameters best:
///
/// `minimise over q(t): Φ(Σ_θ)` subject to the limits for all times, with all else that is not known exactly marginalised under its prior.
#[derive(Clone)]
pub struct TrajectoryProblem<'a> {
    /// The chain from base to tip.
    pub chain: &'a KinematicChain,
    /// What is known of gravity, mount, clocks and geometry: the priors.
    pub setup: &'a MachineSetup,
    /// The sensor's parameters that the recording is to determine.
    pub quantities: &'a [ImuQuantity],
    /// Noise of the sensor.
    pub noise: TrajectoryNoise,
    /// Spread of the cross terms of sensors, of accelerometer and gyroscope, where nothing is known of them. An uncertain mount moves them into the scale factors.
    pub cross_axis_sd: [f64; 2],
    /// Limits of each joint.
    pub joints: Vec<JointLimit>,
    /// Range of the accelerometer on each axis, m/s²; infinite where it is not known.
    pub force_range_mps2: Vector3<f64>,
    /// Range of the gyroscope on each axis, rad/s; infinite where it is not known.
    pub rate_range_radps: Vector3<f64>,
    /// Largest speed of the tip frame and of the sensor's body, m/s.
    pub tip_speed_mps: Option<f64>,
    /// The sensor's body; `None`: only the tip frame's speed is limited.
    pub sensor_body: Option<SensorBody>,
    /// What the machine may collide with, itself included; `None`: nothing.
    pub surroundings: Option<&'a dyn Surroundings>,
    /// Smallest distance that is kept, m.
    pub clearance_m: f64,
    /// Duration, s.
    pub duration_s: f64,
    /// Distance of the knots, s, about: the duration is a whole number of intervals, four times a whole one.
    pub knot_s: f64,
    /// The posture at the beginning and the end; `None`: both are free.
    pub home: Option<Vec<f64>>,
    /// What is minimised.
    pub criterion: TrajectoryCriterion,
    /// How often the machine may stand still in between.
    pub dwells: Dwells,
}

/// Noise of the sensor's readings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrajectoryNoise {
    /// Density `N` of the accelerometer, m/s²/√Hz: a sample's standard deviation is `N √rate`. `None`: there is none.
    pub force_density: Option<f64>,
    /// Density `N` of the gyroscope, rad/s/√Hz. `None`: there is none.
    pub rate_density: Option<f64>,
    /// Noise while moving over noise at rest, 1 or more.
    pub moving: f64,
}

/// How often the machine stands still. Ends count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dwells {
    /// Not at all.
    None,
    /// Several numbers are tried where noise grows with motion.
    Auto,
    /// So often.
    Number(usize),
}

/// How the search goes. The result does not depend on the number of threads, unless a time is given.
#[derive(Debug, Clone, PartialEq)]
pub struct TrajectorySettings {
    /// Number of random starts on the coarsest knots.
    pub starts: usize,
    /// Number of the best of them that are searched on the next knots; half as many on the finest.
    pub kept: usize,
    /// Time for the search, s. What is under way then ends.
    pub seconds: Option<f64>,
    /// Seed of the starts.
    pub seed: u64,
    /// Largest number of iterations on each knots.
    pub max_iterations: usize,
    /// Iterations with the full information at the end.
    pub polish: usize,
    /// Ends the search early where it is asked: the trajectory is then the best so far.
    pub interruption: Interruption,
    /// Is told of each stage that is done.
    pub progress: Progress,
}

impl Default for TrajectorySettings {
    fn default() -> Self {
        Self {
            starts: 16,
            kept: 4,
            seconds: None,
            seed: 1,
            max_iterations: 200,
            polish: 25,
            interruption: Interruption::default(),
            progress: Progress::default(),
        }
    }
}

/// Can a trajectory be designed for this problem at all?
///
/// # Errors
/// [`Error::Experiment`] says what is missing or contradicts itself.
pub(crate) fn check(problem: &TrajectoryProblem<'_>) -> Result<()> {
    let refuse = |code: Refusal, key: &str, message: String, help: &str| {
        Err(Error::experiment(InputError::new(code, message, help).about_key(key)))
    };
    let joints = &problem.chain.joints;
    if joints.is_empty() || problem.joints.len() != joints.len() {
        return refuse(
            Refusal::ValueInvalid,
            "machine.limits",
            format!("limits of {} joints are given for a machine of {}", problem.joints.len(), joints.len()),
            "give the limits of each joint that moves",
        );
    }
    for (joint, limit) in joints.iter().zip(&problem.joints) {
        let name = &joint.name;
        if !(limit.lower.is_finite() && limit.upper.is_finite() && limit.lower < limit.upper) {
            return refuse(
                Refusal::ValueInvalid,
                "machine.limits.position",
                format!("joint `{name}` has no range of positions"),
                "give the smallest and the largest position, the smaller first",
            );
        }
        if !(limit.acceleration.is_finite() && limit.acceleration > 0.0) {
            return refuse(
                Refusal::KeyMissing,
                "machine.limits.acceleration",
                format!("joint `{name}` has no limit of its acceleration"),
                "give `acceleration` in [machine.limits], or MoveIt's file as `joint_limits`",
            );
        }
        if !(limit.velocity > 0.0 && limit.jerk > 0.0) {
            return refuse(
                Refusal::ValueInvalid,
                "machine.limits",
                format!("joint `{name}` may not move: its speed or its jerk is limited to 0"),
                "give limits above 0",
            );
        }
    }
    if !(problem.duration_s > 0.0 && problem.duration_s.is_finite() && problem.knot_s > 0.0) {
        return refuse(
            Refusal::ValueInvalid,
            "machine.design.duration_s",
            "a trajectory needs a duration and a distance of its knots above 0".into(),
            "give both in seconds",
        );
    }
    if let Some(home) = &problem.home {
        let outside =
            |j: &usize| !(problem.joints[*j].lower < home[*j] && home[*j] < problem.joints[*j].upper);
        if home.len() != joints.len() {
            return refuse(
                Refusal::ValueInvalid,
                "machine.design.home",
                format!("the home posture has {} positions for {} joints", home.len(), joints.len()),
                "give one position for each joint that moves",
            );
        }
        if let Some(j) = (0..joints.len()).find(outside) {
            return refuse(
                Refusal::ValueOutOfRange,
                "machine.design.home",
                format!("the home position of joint `{}` is at or beyond its limits", joints[j].name),
                "give a position between them",
            );
        }
    }
    let noise = &problem.noise;
    for (kind, density) in SensorKind::ALL.into_iter().zip([noise.force_density, noise.rate_density]) {
        let asked = problem.quantities.iter().any(|quantity| quantity.sensor_kind() == kind);
        if asked && !density.is_some_and(|density| density > 0.0 && density.is_finite()) {
            return refuse(
                Refusal::KeyMissing,
                "sensor.noise_density",
                format!("the noise of the {kind} is not known"),
                "give its noise density",
            );
        }
    }
    if problem.quantities.is_empty() {
        return refuse(
            Refusal::ValueInvalid,
            "sensor",
            "no parameter is to be determined".into(),
            "name the parameters of the design",
        );
    }
    if !(noise.moving >= 1.0 && noise.moving.is_finite()) {
        return refuse(
            Refusal::ValueOutOfRange,
            "machine.design.moving_noise",
            format!("noise while moving is {} times noise at rest", noise.moving),
            "give a factor of 1 or more",
        );
    }
    Ok(())
}
