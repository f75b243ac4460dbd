//! What the gate decides.

/// What was decided.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Decision {
    /// A hold is long enough.
    Held { start_s: f64, seconds: f64, mean: [f64; 3] },
    /// It ended.
    Ended { start_s: f64, end_s: f64 },
    /// A knock was cut out.
    Cut,
    /// It ended too early: it lasted `seconds`, and `needed_s` would do.
    Short { seconds: f64, needed_s: f64 },
    /// It slides by so much, in the unit of the readings.
    Slides { by: f64 },
    /// Readings at the end of the range.
    Clips { axis: usize },
    /// The rotation before was beyond the gyroscope's range.
    Fast { axis: usize },
    /// No samples for so long.
    Gap { seconds: f64 },
}
