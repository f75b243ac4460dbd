//! What the other soaks of a campaign over temperature say of one.

use calibrant_core::estimate::KnownTerm;
use calibrant_core::sensor::ImuParameters;

/// What the other soaks of a campaign say of one.
#[derive(Debug, Clone, Default)]
pub struct OtherSoaks {
    /// The prior of its parameters; what `[known]` states of them stays.
    pub prior: Vec<KnownTerm>,
    /// The sensor over temperature, about the soak's mean. The temperature terms of an IMU are expected to be these. The calibration of an accelerometer alone has none: its
    /// holds are taken to their mean temperature.
    pub sensor: Option<ImuParameters>,
}
