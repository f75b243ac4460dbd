//! Ticks of axes that count.

/// A step of 1, 2, 5, 10, … that makes at most five of them.
pub(super) fn whole_step(most: usize) -> f64 {
    let steps = (0..).flat_map(|decade| [1.0, 2.0, 5.0].map(|step| step * 10f64.powi(decade)));
    steps.into_iter().find(|step| 5.0 * step >= most as f64).unwrap_or(1.0)
}
