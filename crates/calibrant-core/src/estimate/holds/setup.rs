//! The prior knowledge of the holds.

use crate::estimate::imu::KnownTerm;
use crate::motion::{Gravity, Hold};
use crate::sensor::{Gauge, NonlinearTerm, ParameterList, SensorModel};

/// The prior knowledge of the holds.
#[derive(Debug, Clone, PartialEq)]
pub struct HoldsSetup {
    /// The magnitude of gravity.
    pub gravity: Gravity,
    /// The gauge of the result.
    pub gauge: Gauge,
    /// The terms that bend the accelerometer's response, to be estimated; none where it is linear.
    pub nonlinearity: Vec<NonlinearTerm>,
    /// Holds given by the user as (start, end) in s; `None` to find them.
    pub intervals_s: Option<Vec<(f64, f64)>>,
    /// Were these times found by the program, for holds of known directions?
    pub intervals_are_found: bool,
    /// Standard deviation of the drift of each bias from the first hold to the last, m/s²; 0 for none. See [`BiasDrift`](crate::estimate::BiasDrift).
    pub bias_drift_sd_mps2: f64,
    /// Duration of the shortest hold, s.
    pub minimum_hold_s: f64,
    /// Times at which further recordings of the sensor begin, s. Between one and the next nothing is known of the motion, and the sensor may have been off.
    pub further_from_s: Vec<f64>,
    /// The holds of this recording, if they were found before, after its outliers were removed. Neither step is repeated.
    pub found: Option<Vec<Hold>>,
    /// What is known of the parameters of an IMU's accelerometer, for holds that do not determine them.
    pub known: Vec<KnownTerm>,
}

impl HoldsSetup {
    /// Usual drift of a bias over a recording, m/s²: 2 mg, as while a MEMS sensor warms up.
    pub const USUAL_DRIFT_SD_MPS2: f64 = 0.02;

    /// Did the user give the times of the holds?
    #[must_use]
    pub fn times_are_given(&self) -> bool {
        self.intervals_s.is_some() && !self.intervals_are_found
    }

    /// The parameters that are estimated of an accelerometer of this model, in the gauge: 6 for scale-bias, 9 for full, and 3 of each term.
    #[must_use]
    pub fn parameter_list(&self, model: SensorModel) -> ParameterList {
        self.gauge.parameter_list(model).with_terms(&self.nonlinearity)
    }

    /// The same where the directions of the holds are known: they fix the frame in place of the gauge.
    #[must_use]
    pub fn parameter_list_on_faces(&self, model: SensorModel) -> ParameterList {
        ParameterList::new(3, model).with_terms(&self.nonlinearity)
    }
}

/// As in the preset `static-poses`.
impl Default for HoldsSetup {
    fn default() -> Self {
        Self {
            gravity: Gravity::SOMEWHERE,
            gauge: Gauge::Upper,
            nonlinearity: Vec::new(),
            intervals_s: None,
            intervals_are_found: false,
            bias_drift_sd_mps2: Self::USUAL_DRIFT_SD_MPS2,
            minimum_hold_s: 1.0,
            further_from_s: Vec::new(),
            found: None,
            known: Vec::new(),
        }
    }
}
