//! The times of the gyroscope beside those of the accelerometer.

/// The time offset of the gyroscope, from the rotations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeOffset {
    /// How much later the gyroscope shows movements than the accelerometer, s.
    pub offset_s: f64,
    /// Standard deviation, s.
    pub sd_s: f64,
    /// Degrees of freedom of it.
    pub degrees_of_freedom: usize,
}

/// The gyroscope's clock beside the accelerometer's, where they go at different rates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClockRate {
    /// By this share of the time the gyroscope's goes faster, and by this share its gains are too large if the accelerometer's is right.
    pub faster: f64,
    /// Standard deviation.
    pub sd: f64,
}
