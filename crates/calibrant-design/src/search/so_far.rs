//! What a search knows so far: the best value and the bound, for whoever waits.

use calibrant_core::information::Criterion;
use std::sync::{Arc, Mutex, PoisonError};

/// The best value of a search so far, and its lower bound. Clones share them.
#[derive(Debug, Clone, Default)]
pub struct SoFar(Arc<Mutex<State>>);

#[derive(Debug, Default)]
struct State {
    /// First axis of each part, the number of times that it occurs, and its best value.
    parts: Vec<(usize, usize, f64)>,
    /// Number of axes that are not in `parts` yet.
    missing: usize,
    bound: Option<f64>,
}

impl SoFar {
    /// Begins a search over this many axes.
    pub(crate) fn begin(&self, axes: usize) {
        self.change(|state| *state = State { missing: axes, ..State::default() });
    }

    /// A value of the part with this first axis. The part has `axes` axes, in groups of which each has this value.
    pub(crate) fn found(&self, first: usize, groups: usize, axes: usize, value: f64) {
        self.change(|state| match state.parts.iter_mut().find(|part| part.0 == first) {
            Some(part) => part.2 = part.2.min(value),
            None => {
                state.parts.push((first, groups, value));
                state.missing = state.missing.saturating_sub(axes);
            }
        });
    }

    /// The lower bound is known.
    pub(crate) fn bounded(&self, bound: f64) {
        self.change(|state| state.bound = Some(bound));
    }

    /// The lower bound, once it is known.
    #[must_use]
    pub fn bound(&self) -> Option<f64> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).bound
    }

    /// The best value of the criterion, once every axis has a motion.
    #[must_use]
    pub fn value(&self, criterion: &Criterion) -> Option<f64> {
        let state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if state.missing > 0 {
            return None;
        }
        let values = state.parts.iter().flat_map(|&(_, groups, value)| std::iter::repeat_n(value, groups));
        Some(criterion.combine(values)).filter(|value| value.is_finite())
    }

    fn change(&self, change: impl FnOnce(&mut State)) {
        change(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

impl PartialEq for SoFar {
    /// Two are equal where they share what they know.
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}
