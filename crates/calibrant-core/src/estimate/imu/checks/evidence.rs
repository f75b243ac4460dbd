//! What the checks after the fit look at, and what they give.
//!
//! A check is `fn check(evidence: &Evidence) -> Diagnostics`; it changes nothing. Checks before the fit refuse what makes no sense: they take what
//! is there by then, and give an error.

use crate::diagnostic::Diagnostic;
use crate::estimate::imu::alignment::axes::Axes;
use crate::estimate::imu::clock::ClockDifference;
use crate::estimate::imu::initial::accelerometer::{InitialAccelerometer, UsedHolds};
use crate::estimate::imu::model::{Fit, ImuModel};
use crate::estimate::imu::problem::ImuProblem;
use crate::estimate::imu::stationary::gyroscope::StationaryGyroscope;
use crate::estimate::imu::temperature::RecordingTemperature;
use crate::estimate::imu::thermometer_lag::LagEffect;
use crate::estimate::result::Calibration;
use crate::sensor::Recording;

/// What a user should know.
pub(crate) type Diagnostics = Vec<Diagnostic>;

/// Everything that is known after the fit.
pub(crate) struct Evidence<'a> {
    pub(crate) problem: &'a ImuProblem<'a>,
    /// The accelerometer by itself.
    pub(crate) accelerometer: &'a InitialAccelerometer,
    /// Its recording, at the reference temperature where its terms were fitted.
    pub(crate) accelerometer_recording: &'a Recording,
    pub(crate) used: &'a UsedHolds<'a>,
    pub(crate) gyroscope: &'a StationaryGyroscope,
    pub(crate) temperature: &'a RecordingTemperature<'a>,
    pub(crate) model: &'a ImuModel<'a>,
    pub(crate) fit: &'a Fit,
    /// The gyroscope's axes, where they are not the accelerometer's.
    pub(crate) axes: Option<&'a Axes>,
    /// What the turns of known angle said before the fit.
    pub(crate) turns: Diagnostics,
    /// The gyroscope's clock beside the accelerometer's.
    pub(crate) clock: Option<ClockDifference>,
    /// What a lag of the thermometer does, where it is not known.
    pub(crate) lag: Option<&'a LagEffect>,
    /// The result, but for its warnings.
    pub(crate) calibration: &'a Calibration,
}
