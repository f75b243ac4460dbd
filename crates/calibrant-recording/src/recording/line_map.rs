//! The lines of samples.

use calibrant_core::error::InputError;

/// The line of each sample, stored only where it is not the line after the sample before.
#[derive(Default)]
pub(crate) struct LineMap {
    breaks: Vec<(usize, usize)>,
}

impl LineMap {
    pub(crate) fn push(&mut self, sample: usize, line: usize) {
        if self.breaks.last().is_none_or(|(first, start)| start + (sample - first) != line) {
            self.breaks.push((sample, line));
        }
    }

    /// The lines of these samples, in this order.
    pub(crate) fn of(&self, samples: &[usize]) -> Self {
        let mut lines = Self::default();
        for (at, line) in
            samples.iter().enumerate().filter_map(|(at, &sample)| Some((at, self.line(sample)?)))
        {
            lines.push(at, line);
        }
        lines
    }

    /// Line of a sample.
    pub(crate) fn line(&self, sample: usize) -> Option<usize> {
        let after = self.breaks.partition_point(|(first, _)| *first <= sample);
        let (first, line) = self.breaks.get(after.checked_sub(1)?)?;
        Some(line + (sample - first))
    }

    /// The error, at the line of a sample where samples have lines.
    pub(crate) fn at(&self, input_error: InputError, sample: usize) -> InputError {
        match self.line(sample) {
            Some(line) => input_error.at_line(line),
            None => input_error,
        }
    }
}
