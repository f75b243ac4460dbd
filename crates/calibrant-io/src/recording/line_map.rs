//! The lines of samples.

/// The line of each sample, stored only where it is not the line after the sample before.
#[derive(Default)]
pub(super) struct LineMap {
    breaks: Vec<(usize, usize)>,
}

impl LineMap {
    pub(super) fn push(&mut self, sample: usize, line: usize) {
        if self.breaks.last().is_none_or(|(first, start)| start + (sample - first) != line) {
            self.breaks.push((sample, line));
        }
    }

    /// Line of a sample.
    pub(super) fn line(&self, sample: usize) -> Option<usize> {
        let after = self.breaks.partition_point(|(first, _)| *first <= sample);
        let (first, line) = self.breaks.get(after.checked_sub(1)?)?;
        Some(line + (sample - first))
    }
}
