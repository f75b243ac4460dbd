//! The first stage: the motion is trusted. The parameters come near, and the residuals show how large the errors are.

use super::MachineTrust;
use super::gauss_newton::{equations_at, stepped};
use super::model::{Model, State};

/// How thorough the stage is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Effort {
    /// Rounds of noise and one step each.
    pub(super) rounds: usize,
    /// Samples of each sensor that are used.
    pub(super) samples: usize,
}

impl Effort {
    /// Enough to compare distances of knots.
    pub(super) const QUICK: Self = Self { rounds: 4, samples: 4000 };
    /// Enough to begin with.
    pub(super) const THOROUGH: Self = Self { rounds: 6, samples: 20_000 };
}

/// Fits the parameters to the motion as it is, with the noise that the residuals show. The noise and the samples of the model remain so. `None` where
/// nothing is determined.
pub(super) fn trusted(model: &mut Model<'_>, state: &mut State, effort: Effort) -> Option<()> {
    let trust = std::mem::replace(&mut model.trust, MachineTrust::Known);
    for stream in &mut model.streams {
        stream.stride = (stream.recording.len() / effort.samples).max(1);
    }
    for _ in 0..effort.rounds {
        let rms = model.residual_rms(state);
        for (stream, rms) in model.streams.iter_mut().zip(rms) {
            stream.sd.component_mul_assign(&rms.map(|rms| rms.max(1e-9)));
        }
        *state = stepped(model, &equations_at(model, state.clone())?, 1.0);
    }
    model.trust = trust;
    for stream in &mut model.streams {
        stream.stride = 1;
    }
    Some(())
}
