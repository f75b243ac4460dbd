//! The last half second of samples: means and scatter of each axis, in steps of a tenth of a second.

use crate::layout::Sample;
use std::collections::VecDeque;

/// Length of a step, s, and how many a window has.
const STEP_S: f64 = 0.1;
const STEPS: usize = 5;
/// Axes of both sensors.
pub(crate) const AXES: usize = 6;

/// Sums over some samples, about a reference: sums of squares of large numbers would lose the noise.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sums {
    count: [f64; AXES],
    sum: [f64; AXES],
    square: [f64; AXES],
}

impl Sums {
    fn add(&mut self, axis: usize, value: f64) {
        self.count[axis] += 1.0;
        self.sum[axis] += value;
        self.square[axis] += value * value;
    }

    pub(crate) fn joined<'a>(parts: impl IntoIterator<Item = &'a Self>) -> Self {
        let mut sums = Self::default();
        parts.into_iter().for_each(|part| sums.join(part));
        sums
    }

    pub(crate) fn join(&mut self, other: &Self) {
        for axis in 0..AXES {
            self.count[axis] += other.count[axis];
            self.sum[axis] += other.sum[axis];
            self.square[axis] += other.square[axis];
        }
    }

    pub(crate) fn count(&self, axis: usize) -> f64 {
        self.count[axis]
    }

    pub(crate) fn mean(&self, axis: usize) -> f64 {
        self.sum[axis] / self.count[axis].max(1.0)
    }

    /// Standard deviation of a sample.
    pub(crate) fn sd(&self, axis: usize) -> f64 {
        let count = self.count[axis];
        if count < 2.0 {
            return 0.0;
        }
        ((self.square[axis] - self.sum[axis].powi(2) / count) / (count - 1.0)).max(0.0).sqrt()
    }
}

/// Samples within a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    pub(crate) start_s: f64,
    pub(crate) end_s: f64,
    pub(crate) sums: Sums,
}

/// The window.
#[derive(Debug, Default)]
pub(crate) struct Window {
    steps: VecDeque<Step>,
    now: Option<Step>,
    /// The first reading of each axis: sums are about it.
    pub(crate) about: [Option<f64>; AXES],
}

impl Window {
    /// Takes a sample; the step that it completes.
    pub(crate) fn push(&mut self, sample: &Sample) -> Option<Step> {
        let mut complete = None;
        if let Some(now) = &self.now
            && sample.t_s >= now.start_s + STEP_S
        {
            complete = self.now.take();
        }
        let now =
            self.now.get_or_insert(Step { start_s: sample.t_s, end_s: sample.t_s, sums: Sums::default() });
        now.end_s = sample.t_s;
        for (sensor, reading) in sample.readings.iter().enumerate() {
            let Some(reading) = reading else { continue };
            for (of, value) in reading.iter().enumerate() {
                let axis = 3 * sensor + of;
                now.sums.add(axis, value - *self.about[axis].get_or_insert(*value));
            }
        }
        if let Some(step) = complete {
            self.steps.push_back(step);
            if self.steps.len() > STEPS {
                self.steps.pop_front();
            }
        }
        complete
    }

    /// Forgets what was there: the samples before a gap.
    pub(crate) fn clear(&mut self) {
        self.steps.clear();
        self.now = None;
    }

    /// Its sums and where it begins; `None` until it is full.
    pub(crate) fn whole(&self) -> Option<(f64, Sums)> {
        (self.steps.len() == STEPS)
            .then(|| (self.steps[0].start_s, Sums::joined(self.steps.iter().map(|step| &step.sums))))
    }

    /// Its two halves, the middle step left out.
    pub(crate) fn halves(&self) -> [Sums; 2] {
        let sums = || self.steps.iter().map(|step| &step.sums);
        [Sums::joined(sums().take(STEPS / 2)), Sums::joined(sums().skip(STEPS - STEPS / 2))]
    }

    /// A mean as a reading.
    pub(crate) fn reading(&self, sums: &Sums, sensor: usize) -> Option<[f64; 3]> {
        let of = |of: usize| {
            let axis = 3 * sensor + of;
            (sums.count(axis) > 0.0).then(|| self.about[axis].unwrap_or(0.0) + sums.mean(axis))
        };
        Some([of(0)?, of(1)?, of(2)?])
    }
}
