//! A tracker's errors are no noise: they are correlated, and a thousandth of its samples are jumps. The scatter of blocks of time widens the standard deviations by
//! that; what they cannot see is an error that all blocks share, as that of a mount that gives way. Where the residuals do not show one, what they leave room for is
//! added to the covariance, which then holds.

use super::flexure::Flexure;
use crate::estimate::{MachineCalibration, MachineQuantity, MachineTrust};
use calibrant_core::diagnostic::machine::{
    LogOutliers, MachineResiduals, MountAllowedFor, ReferenceUndermodelled,
};
use calibrant_core::diagnostic::{Check, Code, Diagnostic};
use calibrant_core::estimate::VarianceSource;

/// What correlated errors of a tracker cause.
const OF_TRACKERS: [Code; 3] = [MachineResiduals::CODE, ReferenceUndermodelled::CODE, LogOutliers::CODE];
/// A log of which more than this part is outliers has errors of which the rest may have a share.
const MANY_OUTLIERS: f64 = 0.02;
/// Residuals of more than this many times the noise are of something else.
const MILD: f64 = 2.0;

/// Widens the covariance of a tracked body, and puts a note in the place of the warnings that it answers.
pub(super) fn allow_for(
    flexure: &Flexure,
    calibration: &mut MachineCalibration,
    found: &mut Vec<Diagnostic>,
) {
    let is_answered = |of: &Diagnostic| of.is_warning() && OF_TRACKERS.contains(&of.code());
    let (outliers, samples) = calibration.outliers();
    // a machine with joints is wrong by its geometry, too
    let is_mild = calibration.joints.is_empty()
        && calibration.trust == MachineTrust::Noisy
        && outliers as f64 <= MANY_OUTLIERS * samples as f64
        && calibration.noise.iter().all(|of| of.excess() <= MILD);
    let (None, Some(unseen)) = (&flexure.found, &flexure.unseen) else { return };
    let codes: Vec<String> =
        found.iter().filter(|of| is_answered(of)).map(|of| of.code().to_string()).collect();
    if !is_mild || codes.is_empty() {
        return;
    }
    let before = calibration.sd();
    calibration.widen(VarianceSource::ReferenceNoise, unseen);
    calibration.unseen.clone_from(unseen);
    let factors = calibration.sd().into_iter().zip(before).map(|(after, before)| after / before);
    let of_sensor = |(k, _): &(usize, f64)| matches!(calibration.quantities[*k], MachineQuantity::Imu(_));
    let widest = factors.enumerate().filter(of_sensor).max_by(|one, other| one.1.total_cmp(&other.1));
    let Some((place, factor)) = widest else { return };
    found.retain(|of| !is_answered(of));
    let parameter = calibration.names().swap_remove(place);
    found.push(MountAllowedFor { codes, parameter, factor }.into());
}
