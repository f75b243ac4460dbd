//! χ² of the whole fit.

use crate::estimate::imu::checks::evidence::{Diagnostics, Evidence};

/// Is it far above its degrees of freedom?
pub(crate) fn check(evidence: &Evidence<'_>) -> Diagnostics {
    let (chi2, degrees) = (evidence.fit.chi2, evidence.calibration.degrees_of_freedom as f64);
    let is_large = degrees > 0.0 && chi2 > degrees + 6.0 * (2.0 * degrees).sqrt();
    let words = || {
        format!(
            "χ² is {chi2:.0} with {degrees:.0} degrees of freedom: the data contradict what was given (fixed terms and priors in [known], directions, turns, noise), and \
         the standard deviations are too small"
        )
    };
    is_large.then(words).into_iter().collect()
}
