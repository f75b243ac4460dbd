//! The first stage: the motion is trusted. The parameters come near, and the residuals show how large the errors are.

use crate::estimate::least_squares::gauss_newton::{equations_at, stepped};
use crate::estimate::least_squares::model::{Model, State};
use crate::estimate::least_squares::pass::Pass;

/// Fits the parameters to the motion as it is, with the noise that the residuals show. The noise of the model remains so. `None` where
/// nothing is determined.
pub(crate) fn trusted(model: &mut Model<'_>, state: &mut State, steps: usize, samples: usize) -> Option<()> {
    let pass = Pass::trusting(samples);
    noise_of_residuals(model, state, pass);
    for _ in 0..steps {
        *state = stepped(model, &equations_at(model, state.clone(), pass)?, 1.0);
        noise_of_residuals(model, state, pass);
    }
    Some(())
}

fn noise_of_residuals(model: &mut Model<'_>, state: &State, pass: Pass) {
    let rms = model.residual_rms(state, pass);
    for (stream, rms) in model.streams.iter_mut().zip(rms) {
        stream.sd.component_mul_assign(&rms.map(|rms| rms.max(1e-9)));
    }
}
