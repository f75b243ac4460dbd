//! Why errors that are as large as predicted are no reason to believe the covariance.

use crate::estimate::{Change, ClockRate};

/// Why errors that are as large as predicted are no reason to believe the covariance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Caveat {
    /// A sensor changes within the recording that was calibrated from.
    Change(Change),
    /// The clocks of the sensors go at different rates in the recording that was calibrated from.
    Clocks(ClockRate),
    /// The calibration left out so many holds or rotations one after another.
    LeftOut {
        /// Number of them.
        count: usize,
        /// Begin of the first, s.
        start_s: f64,
        /// End of the last, s.
        end_s: f64,
    },
    /// So many errors one after another do not count.
    InARow {
        /// Number of them.
        count: usize,
        /// Begin of the first, s.
        start_s: f64,
        /// End of the last, s.
        end_s: f64,
    },
    /// So many errors do not count.
    Several {
        /// Number of them.
        count: usize,
    },
}

impl Caveat {
    /// As written in results: `change`, `clocks`, `left_out`, `in_a_row`, `several`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Change(_) => "change",
            Self::Clocks(_) => "clocks",
            Self::LeftOut { .. } => "left_out",
            Self::InARow { .. } => "in_a_row",
            Self::Several { .. } => "several",
        }
    }
}

crate::json_name!(Caveat);
