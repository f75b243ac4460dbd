//! χ² of the whole fit.

use crate::diagnostic::Diagnostic;
use crate::diagnostic::fit::{ChiSquaredLarge, GivenRefuted};
use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};

/// From this χ² for each degree of freedom on, what is given is refuted: residuals of ten standard deviations.
const REFUTED: f64 = 100.0;

/// Is it far above its degrees of freedom?
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let (chi2, degrees) = (evidence.fit.chi2, evidence.calibration.fit.degrees_of_freedom as f64);
    if degrees == 0.0 || chi2 <= degrees + 6.0 * (2.0 * degrees).sqrt() {
        return Vec::new();
    }
    let found = if chi2 > REFUTED * degrees {
        Diagnostic::from(GivenRefuted { chi2, degrees_of_freedom: degrees })
    } else {
        Diagnostic::from(ChiSquaredLarge { chi2, degrees_of_freedom: degrees })
    };
    vec![found]
}
