//! The rates of two sensors' clocks.

/// The gyroscope's clock beside the accelerometer's, where they go at different rates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClockRate {
    /// By this share of the time the gyroscope's goes faster, and by this share its gains are too large if the accelerometer's is right.
    pub faster: f64,
    /// Standard deviation.
    pub sd: f64,
}
