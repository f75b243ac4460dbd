//! χ² of the whole fit.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::fit::ChiSquaredLarge;
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};

/// Is it far above its degrees of freedom?
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let (chi2, degrees) = (evidence.fit.chi2, evidence.calibration.fit.degrees_of_freedom as f64);
    let is_large = degrees > 0.0 && chi2 > degrees + 6.0 * (2.0 * degrees).sqrt();
    is_large
        .then_some(Diagnostic::from(ChiSquaredLarge { chi2, degrees_of_freedom: degrees }))
        .into_iter()
        .collect()
}
