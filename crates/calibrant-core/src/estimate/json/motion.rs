//! A recovered motion as JSON.

use crate::estimate::{RecoveredClock, RecoveredGravity, RecoveredMotion};
use crate::json::{flat, if_some};
use crate::json_object;
use crate::motion::MotionTable;
use schemars::JsonSchema;
use serde::Serialize;

/// A motion over this number of axes.
pub(super) struct MotionOf<'a> {
    pub(super) recovered: &'a RecoveredMotion,
    pub(super) axes: usize,
}

json_object! {
    /// The motion, estimated with the parameters.
    MotionOf<'_> as of {
        /// Trust in the command: `known`, `noisy`, `unknown`.
        trust: of.recovered.trust,
        gravity: if_some(of.recovered.gravity.as_ref()),
        clock: if_some(Some(of.recovered.clock).filter(|clock| !clock.given.is_exact())),
        motion: flat(MotionTable {
            motion: &of.recovered.motion,
            axes: of.axes,
            acceleration_sd_mps2: Some(&of.recovered.acceleration_sd_mps2),
        }),
    }
}

json_object! {
    /// The clock of the recording beside that of the motion, estimated with the parameters: motion time = t + delay_s + rate (t − at_s).
    RecoveredClock as of {
        /// Delay at the time at_s: motion time less recording time.
        delay_s: of.delay_s,
        /// Its standard deviation.
        delay_sd_s: of.delay_sd_s,
        /// Rate between the clocks.
        rate_ppm: 1e6 * of.rate,
        /// Its standard deviation.
        rate_sd_ppm: 1e6 * of.rate_sd,
        /// Time of the recording at the middle of the motion.
        at_s: of.at_s,
    }
}

#[derive(Serialize, JsonSchema)]
struct Tilt {
    /// Its name: `tilt.x`.
    name: String,
    value_rad: f64,
    sd_rad: f64,
}

json_object! {
    /// Gravity beside a motion, and its tilt, which was estimated with the parameters.
    RecoveredGravity as of {
        /// Specific force of the sensor at rest, as given.
        force_mps2: <[f64; 3]>::from(of.gravity.force_mps2),
        /// Standard uncertainty of its magnitude.
        sd_mps2: of.gravity.sd_mps2,
        /// Standard deviation of the tilt beforehand.
        tilt_prior_sd_rad: of.gravity.tilt_sd_rad,
        /// The tilt about each level axis.
        tilt: of.tilts().into_iter().map(|(name, value_rad, sd_rad)| Tilt { name, value_rad, sd_rad }).collect::<Vec<_>>(),
    }
}
