//! The confidence of stated intervals.

/// Probability that a stated interval covers the truth.
pub const CONFIDENCE: f64 = 0.95;
