//! Gauss–Newton steps, halved where they do not lower the cost.

use super::{Block, Equations, Model, Pass, Solved, State};
use crate::estimate::MachineQuantity;
use crate::estimate::problem::MachineSettings;
use calibrant_core::error::Result;
use calibrant_core::estimate::CalibrationStatus;

/// Steps shorter than this are taken as they are, in standard deviations.
const NEAR: f64 = 0.3;
/// Halvings of a step at most.
const HALVINGS: usize = 8;

/// A minimum, and the equations there.
pub(crate) struct Minimum {
    pub(crate) state: State,
    pub(crate) solved: Solved,
    pub(crate) cost: f64,
    pub(crate) blocks: Vec<Block>,
    pub(crate) iterations: usize,
    pub(crate) status: CalibrationStatus,
    /// Length of the last step of the parameters, in standard deviations.
    pub(crate) last_step: f64,
}

/// The equations at a state, solved. `None` where they determine nothing.
pub(crate) fn equations_at(model: &Model<'_>, state: State, pass: Pass) -> Option<Minimum> {
    let Equations { front, cost, blocks } = model.equations(&state, pass);
    let solved = front.finish()?;
    let last_step = solved.parameters.dot(&solved.right).max(0.0).sqrt();
    let status = CalibrationStatus::IterationLimit;
    Some(Minimum { state, solved, cost, blocks, iterations: 0, status, last_step })
}

/// The state after this share of the step.
pub(crate) fn stepped(model: &Model<'_>, from: &Minimum, share: f64) -> State {
    let mut state = from.state.clone();
    model.layout.step(&mut state.parameters, &(&from.solved.parameters * share));
    if from.solved.has_motion() {
        let steps: Vec<f64> = from.solved.controls().iter().map(|step| step * share).collect();
        state.motion.step(&steps);
    }
    state
}

/// Minimises the cost from a state. `None` where the equations determine nothing; an error where it is interrupted.
pub(crate) fn minimise(
    model: &Model<'_>,
    start: State,
    settings: &MachineSettings,
) -> Result<Option<Minimum>> {
    let MachineSettings { max_iterations, tolerance, interruption, progress, .. } = settings;
    let pass = Pass::all(model.trust);
    let tolerance = |here: &Minimum| tolerance.max(rounding(model, here));
    let Some(mut here) = equations_at(model, start, pass) else { return Ok(None) };
    for iteration in 1..=*max_iterations {
        interruption.check()?;
        progress.tell("steps", iteration as u64, *max_iterations as u64);
        here.iterations = iteration;
        if here.last_step < tolerance(&here) {
            here.status = CalibrationStatus::Converged;
            return Ok(Some(here));
        }
        let mut share = 1.0;
        let mut found = None;
        for _ in 0..HALVINGS {
            let Some(tried) = equations_at(model, stepped(model, &here, share), pass) else {
                return Ok(None);
            };
            // near the end samples that cross a knot, and outliers, change the cost by more than the step does
            if tried.cost <= here.cost * (1.0 + 1e-6) || here.last_step < NEAR {
                found = Some(tried);
                break;
            }
            share *= 0.5;
        }
        let Some(tried) = found else {
            return Ok(Some(Minimum { status: CalibrationStatus::Stalled, ..here }));
        };
        here = Minimum { iterations: iteration, ..tried };
    }
    if here.last_step < tolerance(&here) {
        here.status = CalibrationStatus::Converged;
    }
    Ok(Some(here))
}

/// The step that rounding of the delays makes, in standard deviations: between two clocks of which one counts from 1970 a delay has steps of 0.24 µs.
fn rounding(model: &Model<'_>, here: &Minimum) -> f64 {
    let of_delay = |(k, quantity): (usize, &MachineQuantity)| match quantity {
        MachineQuantity::Delay(sensor) => {
            let delay_s = here.state.parameters.delays_s[*sensor];
            f64::EPSILON * delay_s.abs() * here.solved.information[(k, k)].sqrt()
        }
        _ => 0.0,
    };
    model.layout.quantities.iter().enumerate().map(of_delay).fold(0.0, f64::max)
}
