//! Simulates an accelerometer that is held still: by hand, or on faces.

use super::length;
use super::options::SimulationOptions;
use super::random::Random;
use super::simulated::Simulation;
use super::table::{accelerometer_on_table, table};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::settings::SettingUnused;
use calibrant_core::diagnostic::simulation::NoiseAssumed;
use calibrant_core::error::Result;
use calibrant_core::sensor::USUAL_NOISE_MPS2;
use calibrant_core::simulate::{HoldsSimulation, draw_sensor, simulate_holds, simulate_holds_in};
use calibrant_io::{Experiment, HoldsPlan, Truth};
use nalgebra::Vector3;

pub(super) fn simulate(
    experiment: &Experiment,
    plan: &HoldsPlan,
    options: &SimulationOptions,
    random: Random,
) -> Result<Simulation> {
    let poses = options.poses.as_ref();
    let plan = &HoldsPlan { poses: poses.map_or(plan.poses, Vec::len), ..plan.clone() };
    length::check_holds(plan, options.budget)?;
    let assumed = experiment.sensor.with_usual_noise();
    let sensor = assumed.as_ref().unwrap_or(&experiment.sensor);
    let mut rng = random.sensor();
    let drawn = draw_sensor(sensor, &mut rng);
    let on_table = table(plan, &[]);
    // known directions fix the true frame; otherwise the gauge does
    let (truth, list) = match &on_table {
        Some(_) => (drawn, plan.parameter_list(sensor.model, true)),
        None => (plan.gauge.apply(&drawn), plan.parameter_list(sensor.model, false)),
    };
    let mut rng = random.happening(rng);
    let noise = sensor.noise(&truth.matrix.diagonal()).unwrap_or_else(Vector3::zeros);
    let mut notes = unused_motion(options);
    notes.extend(assumed.is_some().then(|| NoiseAssumed { noise_mps2: USUAL_NOISE_MPS2 }.into()));
    let recording = match (&on_table, poses) {
        (Some(steps), _) => {
            accelerometer_on_table(sensor, &truth, plan, steps, (options, &mut notes), &mut rng)?
        }
        (None, Some(poses)) => {
            simulate_holds_in(&truth, &noise, sensor.unit, poses, &by_hand(plan)?, &mut rng).0
        }
        (None, None) => simulate_holds(&truth, &noise, sensor.unit, &by_hand(plan)?, &mut rng).0,
    };
    let truth = Truth::of_sensor(random.seed, &list, sensor.unit, &truth);
    Ok(Simulation { notes, ..Simulation::new(random.seed, recording, truth) })
}

/// The warning about a motion that is given where there is none.
pub(super) fn unused_motion(options: &SimulationOptions) -> Vec<Diagnostic> {
    let why = "a [holds] experiment has no motion";
    options.motion.iter().map(|_| SettingUnused::of(&["option `motion`"], why).into()).collect()
}

fn by_hand(plan: &HoldsPlan) -> Result<HoldsSimulation> {
    Ok(HoldsSimulation {
        poses: plan.poses,
        hold_s: plan.hold_s,
        turn_s: 2.0,
        rate_hz: plan.rate_hz,
        gravity_mps2: plan.gravity()?.magnitude_mps2,
        between_holds_sd_mps2: plan.between_holds_sd_mps2,
    })
}
