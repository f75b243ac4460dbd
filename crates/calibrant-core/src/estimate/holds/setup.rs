//! What is known of the holds beforehand.

use crate::motion::{Gravity, Hold};
use crate::sensor::Gauge;

/// What is known of the holds.
#[derive(Debug, Clone, PartialEq)]
pub struct HoldsSetup {
    /// The magnitude of gravity.
    pub gravity: Gravity,
    /// The gauge of the result.
    pub gauge: Gauge,
    /// Holds given by the user as (start, end) in s; `None` to find them.
    pub intervals_s: Option<Vec<(f64, f64)>>,
    /// A shorter stillness is not a hold, s.
    pub minimum_hold_s: f64,
    /// The holds of this recording, where they were found before. Outliers were taken out of it before that; neither is looked for again.
    pub found: Option<Vec<Hold>>,
}

impl Default for HoldsSetup {
    fn default() -> Self {
        Self {
            gravity: Gravity { magnitude_mps2: 9.806_65, sd_mps2: 0.0 },
            gauge: Gauge::Upper,
            intervals_s: None,
            minimum_hold_s: 1.0,
            found: None,
        }
    }
}
