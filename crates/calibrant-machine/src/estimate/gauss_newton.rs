//! Gauss–Newton steps, halved where they do not lower the cost.

use super::front::Solved;
use super::model::{Equations, Model, State};
use calibrant_core::estimate::CalibrationStatus;
use nalgebra::DVector;

/// Halvings of a step at most.
const HALVINGS: usize = 8;

/// A minimum, and the equations there.
pub(super) struct Minimum {
    pub(super) state: State,
    pub(super) solved: Solved,
    pub(super) cost: f64,
    pub(super) scores: Vec<(f64, DVector<f64>)>,
    pub(super) iterations: usize,
    pub(super) status: CalibrationStatus,
    /// Length of the last step of the parameters, in standard deviations.
    pub(super) last_step: f64,
}

/// Minimises the cost from a state. `None` where the equations determine nothing.
pub(super) fn minimise(
    model: &Model<'_>,
    start: State,
    max_iterations: usize,
    tolerance: f64,
) -> Option<Minimum> {
    let mut state = start;
    let Equations { front, mut cost, mut scores } = model.equations(&state);
    let mut solved = front.finish()?;
    for iteration in 1..=max_iterations {
        let length = solved.parameters.dot(&solved.right).max(0.0).sqrt();
        let done = |status| (status, iteration);
        if length < tolerance {
            let (status, iterations) = done(CalibrationStatus::Converged);
            return Some(Minimum { state, solved, cost, scores, iterations, status, last_step: length });
        }
        let controls = solved.controls();
        let mut share = 1.0;
        let mut found = None;
        for _ in 0..HALVINGS {
            let mut tried = state.clone();
            model.layout.step(&mut tried.parameters, &(&solved.parameters * share));
            if !controls.is_empty() {
                let steps: Vec<f64> = controls.iter().map(|step| step * share).collect();
                tried.motion.step(&steps);
            }
            let equations = model.equations(&tried);
            // samples may enter or leave with a delay: that is no reason to stop
            if equations.cost <= cost * (1.0 + 1e-6) || length < 1e-2 {
                found = Some((tried, equations));
                break;
            }
            share *= 0.5;
        }
        let Some((tried, equations)) = found else {
            return Some(Minimum {
                state,
                solved,
                cost,
                scores,
                iterations: iteration,
                status: CalibrationStatus::Stalled,
                last_step: length,
            });
        };
        (state, cost, scores) = (tried, equations.cost, equations.scores);
        solved = equations.front.finish()?;
    }
    let last_step = solved.parameters.dot(&solved.right).max(0.0).sqrt();
    let status =
        if last_step < tolerance { CalibrationStatus::Converged } else { CalibrationStatus::IterationLimit };
    Some(Minimum { state, solved, cost, scores, iterations: max_iterations, status, last_step })
}
