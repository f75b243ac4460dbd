//! All experiments of one experiment file.

use super::{DesignStudy, Study, TraceSurface};

/// What `calibrant study` gives: the experiments that were asked for. The preset `report` asks for all of them.
#[derive(Debug, Clone, Default)]
pub struct Studies {
    /// Sensors calibrated without a design: the report's chapter 3, where nothing is known of the motion but its ends (Figures 4 to 6).
    pub calibration: Option<Study>,
    /// The criterion over the jerks of two intervals (Figure 7).
    pub surface: Option<TraceSurface>,
    /// Initial against optimal motion, as `[motion]` and `[limits]` say (Figures 8 to 11).
    pub design: Option<DesignStudy>,
    /// The same with process noise, of `[study.noisy]` (Figures 13 and 14).
    pub noisy: Option<DesignStudy>,
    /// What was not run although one might expect it, and why, in words.
    pub remarks: Vec<String>,
}
