//! The gyroscope of a calibration as JSON: at rest, in rotations, in turns.

use crate::estimate::{Calibration, GyroscopeCalibration, RotationResult};
use crate::form::{per_axis, vector_rows};
use crate::json::{if_some, with_ending};
use crate::json_object;

/// The gyroscope in the holds.
pub(super) struct StillOf<'a>(pub(super) &'a GyroscopeCalibration);

json_object! {
    /// The gyroscope in the holds.
    StillOf<'_> as of {
        noise_per_sample: with_ending(of.0.unit.suffix(), per_axis(&of.0.still.noise, 3)),
        /// Where the noise comes from.
        noise_source: of.0.still.noise_source.to_string(),
        /// Standard deviation of the mean beyond this noise.
        between_holds_sd: with_ending(of.0.unit.suffix(), per_axis(&of.0.still.between_holds_sd, 3)),
        /// The biases in the recordings before the last less those in it, which were subtracted, where several recordings were calibrated together.
        earlier_biases: if_some(of.0.recording_biases.as_ref().map(|biases| with_ending(of.0.unit.suffix(), vector_rows(&biases.values, 3)))),
        earlier_biases_sd: if_some(of.0.recording_biases.as_ref().map(|biases| with_ending(of.0.unit.suffix(), vector_rows(&biases.sds().collect::<Vec<_>>(), 3)))),
        /// Root mean square of the calibrated mean rates.
        rate_rms_radps: of.0.still.rate_rms_radps,
        rate_rms_before_radps: of.0.still.rate_rms_before_radps,
        /// What the rates before the calibration suppose.
        before: &of.0.before.source,
    }
}

/// The rotations between holds.
pub(super) struct RotationsOf<'a> {
    pub(super) calibration: &'a Calibration,
    pub(super) gyroscope: &'a GyroscopeCalibration,
}

impl RotationsOf<'_> {
    fn used(&self) -> usize {
        self.calibration.used_rotations().count()
    }

    fn known(&self, rms_rad: f64) -> Option<f64> {
        (self.used() > 0).then_some(rms_rad)
    }
}

json_object! {
    /// The rotations between holds.
    RotationsOf<'_> as of {
        /// Number of rotations that were used.
        used: of.used(),
        error_rms_rad: of.known(of.calibration.rotation_rms_rad()),
        error_before_rms_rad: of.known(of.calibration.rotation_rms_before_rad()),
        /// Standard deviation beyond the gyroscope's noise, per axis.
        excess_sd_rad: of.gyroscope.between_rotations_sd_rad,
        /// Time offset of the gyroscope, where the rotations determine it.
        time_offset_s: of.gyroscope.time_offset.map(|time| time.offset_s),
        time_offset_sd_s: of.gyroscope.time_offset.map(|time| time.sd_s),
        table: &of.gyroscope.rotations,
    }
}

json_object! {
    /// A rotation between two holds and its fit. What could not be integrated has no numbers.
    RotationResult as rotation {
        /// The hold that it begins with, from 0.
        from_hold_index: rotation.from_hold,
        /// The hold that it ends in, from 0.
        to_hold_index: rotation.to_hold,
        start_s: rotation.start_s,
        end_s: rotation.end_s,
        path_rad: integrated(rotation, rotation.path_rad),
        peak_radps: integrated(rotation, rotation.peak_radps),
        /// Angle from propagated gravity to measured gravity.
        error_rad: integrated(rotation, rotation.error_rad),
        error_before_rad: integrated(rotation, rotation.error_before_rad),
        /// The error in its expected standard deviations, without its own influence.
        studentised: integrated(rotation, rotation.studentised),
        /// Was it used?
        used: rotation.used,
        /// Why it was not used.
        reason: rotation.reason.map(|reason| reason.to_string()),
    }
}

fn integrated(rotation: &RotationResult, value: f64) -> Option<f64> {
    rotation.is_integrated().then_some(value)
}
