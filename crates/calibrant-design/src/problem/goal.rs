//! A goal of a calibration: the standard deviation that a parameter should have.

/// A parameter, and the largest standard deviation that is good enough.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// Place of the parameter in the list.
    pub parameter: usize,
    /// Largest standard deviation, in the parameter's unit.
    pub sd: f64,
}

impl Goal {
    /// Largest of `sd / goal` over all goals: the goals are reached where it is at most 1.
    pub(crate) fn worst(goals: &[Self], sd: impl Fn(usize) -> f64) -> f64 {
        goals.iter().map(|goal| sd(goal.parameter) / goal.sd).fold(0.0, f64::max)
    }
}

/// The first of the numbers `low + 1 ..= high` that passes, where all after it do. `high` is known to pass,
/// `low` is known not to.
pub(crate) fn first_that_passes<E>(
    mut low: usize,
    mut high: usize,
    mut passes: impl FnMut(usize) -> Result<bool, E>,
) -> Result<usize, E> {
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if passes(middle)? { high = middle } else { low = middle }
    }
    Ok(high)
}
