//! The true motion of a simulated machine: a given one, or one at random.

use super::random::Random;
use crate::session::MotionSource;
use calibrant_core::diagnostic::simulation::MotionThroughLog;
use calibrant_core::diagnostic::{Diagnostic, Phrase};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::number_format::significant;
use calibrant_core::simulate::{Purpose, stream};
use calibrant_io::{MachinePlan, file_name};
use calibrant_machine::chain::KinematicChain;
use calibrant_machine::estimate::MachineSetup;
use calibrant_machine::reference::{JointMotion, Motion};
use calibrant_machine::simulate::{
    MotionOfLog, MotionToDraw, draw_body_motion, draw_joint_motion, motion_of_log,
};

/// Shortest recording, s.
const SHORTEST_S: f64 = 1.0;

/// Rest at either end of the recording of a drawn motion, s.
const REST_S: f64 = 1.0;

/// The motion, and how much of it the recording shows.
pub(super) struct TrueMotion {
    pub(super) motion: Motion,
    /// Time by which the recording begins after the motion, and ends before it, s.
    pub(super) edge_s: f64,
}

/// The shortest such edge: no delay leads out of the log, s.
fn least_edge_s(setup: &MachineSetup) -> f64 {
    0.5 + 5.0 * setup.delay_sd_s.hypot(0.5 * setup.delay_difference_sd_s)
}

/// The motion of the log that is given, or a random one for this recording.
pub(super) fn motion(
    (log, notes): (Option<&MotionSource>, &mut Vec<Diagnostic>),
    plan: &MachinePlan,
    chain: Option<&KinematicChain>,
    setup: &MachineSetup,
    random: Random,
) -> Result<TrueMotion> {
    if let Some(log) = log {
        return given((log, notes), plan, chain, setup);
    }
    let recorded_s = plan.simulation.duration_s;
    // whole seconds, which most rates and distances of knots divide
    let duration_s = (recorded_s + 2.0 * least_edge_s(setup)).ceil();
    let edge_s = 0.5 * (duration_s - recorded_s);
    let wanted = MotionToDraw {
        duration_s,
        rest_s: edge_s + REST_S,
        acceleration: plan.simulation.acceleration,
        knot_step_s: setup.knot_step_s,
    };
    let mut rng = stream(random.seed, Purpose::Motion, random.recording - 1);
    let motion = match chain {
        Some(chain) => draw_joint_motion(chain, &wanted, &mut rng),
        None => draw_body_motion(&wanted, &mut rng),
    };
    Ok(TrueMotion { motion, edge_s })
}

fn given(
    (source, notes): (&MotionSource, &mut Vec<Diagnostic>),
    plan: &MachinePlan,
    chain: Option<&KinematicChain>,
    setup: &MachineSetup,
) -> Result<TrueMotion> {
    let (file, path) = (source.logged(&plan.log_options())?, source.path());
    notes.extend(file.findings.iter().map(|found| found.clone().in_file(file_name(path))));
    let log = file.of_machine(chain, path)?;
    let refused = |message: String, help: &str| {
        Error::recording(InputError::new(Refusal::MachineUnsolved, message, help).in_file(path))
    };
    let MotionOfLog { motion, sd, .. } = motion_of_log(&log, chain, setup.knot_step_s.or(file.knot_step_s))
        .ok_or_else(|| {
        refused("the log has fewer than 8 samples".into(), "give a log of the whole motion")
    })?;
    let knots = motion.knots();
    notes.push(
        MotionThroughLog {
            file: Phrase(file_name(path)),
            knot_step_s: knots.step_s,
            scatter: sd.into_iter().fold(0.0, f64::max),
        }
        .into(),
    );
    let (lasts_s, edge_s) = (knots.end_s() - knots.start_s, least_edge_s(setup));
    // a machine that begins and ends at rest stood there before, and stays: the recording shows the whole motion
    let rests = (edge_s / knots.step_s).ceil();
    if let Motion::Joints(joints) = &motion
        && let Some(positions) = joints.positions.with_rest(rests as usize)
    {
        let motion = Motion::Joints(JointMotion { positions, ..joints.clone() });
        return Ok(TrueMotion { motion, edge_s: rests * knots.step_s });
    }
    if lasts_s < 2.0 * edge_s + SHORTEST_S {
        let message = format!(
            "the log lasts {} s, and {} s of it are the room for the delay of the sensor",
            significant(lasts_s, 3),
            significant(2.0 * edge_s, 3)
        );
        return Err(refused(message, "give a longer log, or a smaller delay_sd_s in [machine.clock]"));
    }
    Ok(TrueMotion { motion, edge_s })
}
