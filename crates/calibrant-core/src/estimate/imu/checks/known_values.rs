//! Values that were given in `[known]`, where the data contradict them.

use crate::diagnostic::{Diagnostic, KnownEvidence, KnownMismatch};
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};

/// The data contradict a value that is off by this many standard deviations.
const CONTRADICTED_SD: f64 = 4.5;

/// Those that are far off by their own standard deviations.
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let (model, imu) = (evidence.model, &evidence.fit.state.imu);
    let Some((mean, weight)) = &model.prior else { return Vec::new() };
    let mut warnings = Vec::new();
    for (k, quantity) in model.quantities.iter().enumerate() {
        let off = (quantity.value(imu) - mean[k]).abs() * weight[k].sqrt();
        if off > CONTRADICTED_SD {
            warnings.push(Diagnostic::KnownContradicted {
                known: KnownMismatch {
                    parameter: quantity.name(),
                    given: mean[k],
                    evidence: KnownEvidence::Deviations(off),
                },
            });
        }
    }
    warnings
}
