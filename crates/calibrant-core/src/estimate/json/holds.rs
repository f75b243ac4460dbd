//! The holds of a calibration as JSON.

use crate::estimate::{FaceTilt, HoldCalibration, HoldResult};
use crate::form::{per_axis, vector_rows};
use crate::json::{if_some, with_ending};
use crate::json_object;
use crate::sensor::ReadingUnit;

/// The holds of an accelerometer with readings in this unit.
pub(super) struct HoldsOf<'a> {
    pub(super) holds: &'a HoldCalibration,
    pub(super) unit: ReadingUnit,
    /// Latitude of an IMU, where it was known.
    pub(super) latitude_deg: Option<f64>,
}

json_object! {
    /// The holds, estimated with the parameters.
    HoldsOf<'_> as of {
        gravity_mps2: of.holds.gravity.magnitude_mps2,
        gravity_sd_mps2: of.holds.gravity.sd_mps2,
        /// With a latitude, the model contains Earth's rate about the vertical.
        latitude_deg: if_some(of.latitude_deg),
        /// The form of the accelerometer's matrix, which fixes the true frame.
        gauge: of.holds.gauge.name(),
        /// Were they found in the recording?
        detected: of.holds.detected,
        /// Standard deviation of a hold's mean beyond the noise of its samples.
        between_holds_sd_mps2: of.holds.between_holds_sd_mps2,
        /// Does that scatter decide the covariance?
        between_holds_dominates: of.holds.between_holds_dominates,
        /// Drift of the bias from the first hold to the last, which was subtracted.
        bias_drift: if_some(of.holds.drift.as_ref().map(|drift| with_ending(of.unit.suffix(), per_axis(&drift.value, 3)))),
        bias_drift_sd: if_some(of.holds.drift.as_ref().map(|drift| with_ending(of.unit.suffix(), per_axis(&drift.sd(), 3)))),
        /// The biases in the recordings before the last less those in it, which were subtracted, where several recordings were calibrated together.
        earlier_biases: if_some(of.holds.recording_biases.as_deref().map(|biases| with_ending(of.unit.suffix(), vector_rows(&biases.values, 3)))),
        earlier_biases_sd: if_some(of.holds.recording_biases.as_deref().map(|biases| with_ending(of.unit.suffix(), vector_rows(&biases.sds().collect::<Vec<_>>(), 3)))),
        /// The time of which the biases are, where a drift was subtracted.
        biases_at_s: if_some(of.holds.drift.as_ref().map(|drift| drift.biases_at_s())),
        faces: if_some(of.holds.tilt),
        /// By how much the thermometer is supposed to lag the sensor, which is at T + t dT/dt; where parameters follow temperature.
        thermometer_lag_s: if_some(of.holds.thermometer.map(|lag| lag.lag_s)),
        thermometer_lag_sd_s: if_some(of.holds.thermometer.map(|lag| lag.sd_s)),
        /// Of the magnitudes of the used holds. With 0, the fit to them is exact and checks nothing.
        degrees_of_freedom: of.holds.degrees_of_freedom,
        magnitude_residual_rms_mps2: of.holds.magnitude_residual_rms_mps2,
        magnitude_residual_rms_before_mps2: of.holds.magnitude_residual_rms_before_mps2(),
        /// What the residuals before the calibration suppose.
        before: &of.holds.before.source,
        /// Largest over smallest eigenvalue of the scaled information: 1 is best.
        condition_number: of.holds.condition_number,
        table: of.holds.holds.iter().map(|result| HoldOf { result, of }).collect::<Vec<_>>(),
    }
}

json_object! {
    /// The face alignment of the holds.
    FaceTilt as tilt {
        tilt_sd_rad: tilt.sd_rad,
        /// Part that opposite faces share, as in a box off square: no scatter shows it.
        shared_sd_rad: tilt.shared_sd_rad,
        /// Where the tilt of the faces comes from.
        source: tilt.source.name(),
        /// Equations whose scatter determined it.
        degrees_of_freedom: tilt.degrees_of_freedom,
    }
}

struct HoldOf<'a> {
    result: &'a HoldResult,
    of: &'a HoldsOf<'a>,
}

json_object! {
    /// One hold and its fit.
    HoldOf<'_> as row {
        /// Its first sample, from 0.
        first_sample: row.result.hold.first,
        /// One past the last sample.
        end_sample: row.result.hold.end,
        /// Number of samples.
        samples: row.result.hold.samples(),
        start_s: row.result.hold.start_s,
        end_s: row.result.hold.end_s,
        /// Mean reading.
        mean: with_ending(row.of.unit.suffix(), per_axis(&row.result.hold.mean, 3)),
        /// Standard deviation of single readings.
        sd: with_ending(row.of.unit.suffix(), per_axis(&row.result.hold.sd, 3)),
        /// Estimated specific force.
        force_mps2: per_axis(&row.result.force_mps2, 3),
        /// Magnitude of the corrected mean reading, less gravity.
        magnitude_residual_mps2: row.result.magnitude_residual_mps2,
        magnitude_residual_before_mps2: row.of.holds.magnitude_residual_before_mps2(&row.result.hold),
        /// The residual in its expected standard deviations, without its own influence.
        studentised_residual: row.result.studentised_residual,
        /// Was it used?
        used: row.result.used,
        /// Why it was not used.
        reason: if_some(row.result.why_left_out().map(|why| why.to_string())),
    }
}
