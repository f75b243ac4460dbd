//! Simulates an accelerometer on a commanded motion.

use super::length;
use super::options::SimulationOptions;
use super::random::Random;
use super::simulated::Simulation;
use crate::design_remarks::rest_remark;
use crate::session::MotionSource;
use calibrant_core::error::Result;
use calibrant_core::motion::{JerkControlledMotion, KnownEnds, Limits, Trust};
use calibrant_core::simulate::{
    ClockedTimes, Purpose, draw_gravity, draw_sensor, perturb, simulate_recording, stream,
};
use calibrant_design::{DesignProblem, evaluate, initial_motion, usual_motion};
use calibrant_io::{Experiment, MotionPlan, Truth};
use nalgebra::Vector3;

/// Largest number of draws of an initial motion.
const MOST_DRAWS: u64 = 100;

/// The commanded motion: the given one, or the experiment's random initial one for this recording (from 1).
///
/// # Errors
/// [`Error::Experiment`](crate::Error::Experiment) where the given motion makes no sense. [`Error::Infeasible`](crate::Error::Infeasible) where the
/// limits admit none.
pub fn commanded_motion(
    given: Option<&MotionSource>,
    plan: &MotionPlan,
    axes: usize,
    limits: &Limits,
    seed: u64,
    recording: u64,
) -> Result<JerkControlledMotion> {
    if let Some(given) = given {
        return given.commanded(axes);
    }
    // with both ends known and nothing in between, the ends must differ: draw again until they differ by a
    // tenth of the peak
    let first = MOST_DRAWS * (recording - 1);
    let drawn = |draw| {
        let mut rng = stream(seed, Purpose::Motion, draw);
        initial_motion(plan.intervals, plan.interval_s, axes, limits, &mut rng)
    };
    for draw in first..first + MOST_DRAWS {
        let motion = drawn(draw)?;
        let a = motion.acceleration_mps2();
        let apart = (0..axes).all(|k| {
            let peak = a.iter().fold(0.0_f64, |peak, a| peak.max(a[k].abs()));
            (a[plan.intervals][k] - a[0][k]).abs() >= 0.1 * peak
        });
        if plan.trust != Trust::Unknown || plan.known_ends != KnownEnds::Both || apart {
            return Ok(motion);
        }
    }
    drawn(first)
}

/// Would a recording of this motion determine a parameter less well than the datasheet?
fn says_less_than_the_datasheet(problem: &DesignProblem<'_>, motion: &JerkControlledMotion) -> Result<bool> {
    let Some(covariance) = evaluate(problem, motion)?.covariance else { return Ok(true) };
    let parameters = problem.sensor.parameter_list().describe(problem.sensor, &problem.at);
    let weaker =
        |(k, spread): (usize, Option<f64>)| spread.is_some_and(|spread| covariance[(k, k)].sqrt() > spread);
    Ok(parameters.iter().map(|parameter| parameter.spread).enumerate().any(weaker))
}

/// Simulates a recording of the given motion. Without one the machine makes the random initial motion, or, where this would say less than the datasheet,
/// what an engineer would command.
pub(super) fn simulate(
    experiment: &Experiment,
    plan: &MotionPlan,
    options: &SimulationOptions,
    random: Random,
) -> Result<Simulation> {
    let sensor = &experiment.sensor;
    let limits = experiment.limits.within_range(plan.range_left(sensor));
    let given = options.motion.as_ref();
    let notes = rest_remark(&limits).filter(|_| given.is_none());
    let mut motion = commanded_motion(given, plan, sensor.axes, &limits, random.seed, random.recording)?;
    length::check_motion(&motion, plan.rate_hz, options.budget)?;
    // an unknown motion determines something only where its ends differ, which those of a shuttle do not
    if given.is_none() && plan.trust != Trust::Unknown {
        let problem = experiment.design_problem(&[])?;
        if says_less_than_the_datasheet(&problem, &motion)? {
            motion = usual_motion(&problem)?.unwrap_or(motion);
        }
    }
    let mut rng = random.sensor();
    let truth = draw_sensor(sensor, &mut rng);
    let mut rng = random.happening(rng);
    let happened = match plan.trust {
        Trust::Noisy(noise) => Some(perturb(&motion, &noise, sensor.axes, plan.known_ends, &mut rng)?),
        Trust::Known | Trust::Unknown => None,
    };
    let noise = sensor.noise(&truth.matrix.diagonal()).unwrap_or_else(Vector3::zeros);
    let gravity = plan.gravity.as_ref().map(|gravity| draw_gravity(gravity, &mut rng));
    let at_rest = gravity.map_or_else(Vector3::zeros, |gravity| gravity.force_mps2);
    let sensed = happened.as_ref().unwrap_or(&motion).plus(&at_rest)?;
    let times = ClockedTimes::draw(&motion, plan.rate_hz, &plan.clock, &mut rng);
    let recording =
        simulate_recording(&truth, &noise, sensor.unit, sensor.axes, &sensed, &times.motion_s, &mut rng);
    let clock = times.clock;
    let recording = times.on_own_clock(recording);
    let truth = Truth::of_sensor(random.seed, &sensor.parameter_list(), sensor.unit, &truth);
    Ok(Simulation {
        motion: Some((motion, sensor.axes)),
        true_motion: happened,
        notes: notes.into_iter().collect(),
        ..Simulation::new(random.seed, recording, truth.with_gravity(gravity).with_clock(clock))
    })
}
