//! The first stage: the motion is trusted. The parameters come near, and the residuals show how large the errors are.

use super::MachineTrust;
use super::gauss_newton::minimise;
use super::model::{Model, State};

/// Rounds of noise and steps.
const ROUNDS: usize = 6;
/// Samples of each sensor that these rounds use.
const SAMPLES: usize = 20_000;

/// Fits the parameters to the motion as it is, with the noise that the residuals show. The noise and the samples of the model remain so. `None` where
/// nothing is determined.
pub(super) fn trusted(model: &mut Model<'_>, state: &mut State) -> Option<()> {
    let trust = std::mem::replace(&mut model.trust, MachineTrust::Known);
    for stream in &mut model.streams {
        stream.stride = (stream.recording.len() / SAMPLES).max(1);
    }
    for _ in 0..ROUNDS {
        let rms = model.residual_rms(state);
        for (stream, rms) in model.streams.iter_mut().zip(rms) {
            stream.sd.component_mul_assign(&rms.map(|rms| rms.max(1e-9)));
        }
        *state = minimise(model, state.clone(), 2, 1e-2)?.state;
    }
    model.trust = trust;
    for stream in &mut model.streams {
        stream.stride = 1;
    }
    Some(())
}
