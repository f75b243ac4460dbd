//! Lines that are no rows: how many of late, and why.

use std::time::{Duration, Instant};

/// The share of unusable lines is taken over so many lines; where it is larger than this, a message says so, at most so often.
const TOGETHER: u32 = 200;
const MANY: f64 = 0.05;
const AGAIN: Duration = Duration::from_secs(20);

/// The lines of late.
#[derive(Debug, Default)]
pub(crate) struct Unfit {
    lines: u32,
    dropped: u32,
    told: Option<Instant>,
    /// When the last row came, and why the last line was none.
    pub(crate) row_came: Option<Instant>,
    pub(crate) why: Option<&'static str>,
}

impl Unfit {
    pub(crate) fn row(&mut self) {
        (self.row_came, self.why) = (Some(Instant::now()), None);
        self.count(0);
    }

    /// The share of such lines, where it is large and not told of late.
    pub(crate) fn dropped(&mut self, why: &'static str) -> Option<f64> {
        self.why = Some(why);
        let share = self.count(1)?;
        let is_new = self.told.is_none_or(|told| told.elapsed() > AGAIN);
        (share > MANY && is_new).then(|| {
            self.told = Some(Instant::now());
            share
        })
    }

    /// The share among the last lines, where they are enough.
    fn count(&mut self, dropped: u32) -> Option<f64> {
        (self.lines, self.dropped) = (self.lines + 1, self.dropped + dropped);
        if self.lines < TOGETHER {
            return None;
        }
        let share = f64::from(self.dropped) / f64::from(self.lines);
        // the half counts on
        (self.lines, self.dropped) = (self.lines / 2, self.dropped / 2);
        Some(share)
    }
}
