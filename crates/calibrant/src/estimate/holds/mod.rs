//! Static multi-position calibration.
use super::*;
/// Setup
#[derive(Debug, Clone)]
pub struct HoldsSetup {}
pub(super) fn calibrate(_: &CalibrationProblem<'_>, _: &HoldsSetup, _: &CalibrationSettings) -> Result<Calibration> {
    todo!()
}
