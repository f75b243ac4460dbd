//! Times of samples whose sender has no clock.

/// Times by arrival, evenly spread: a port gives what it has in blocks.
#[derive(Debug, Clone, Default)]
pub(crate) struct Arrivals {
    first: Option<f64>,
    rows: f64,
    last_s: Option<f64>,
    /// What is added to the time of arrival.
    offset: f64,
    /// Time of the first row that arrives next.
    shift: Option<f64>,
}

impl Arrivals {
    /// Share of the distance to the clock that a row makes up.
    const FOLLOWS: f64 = 0.02;
    /// Further off, the time is that of the clock, s.
    const FAR_S: f64 = 0.5;

    pub(crate) fn next(&mut self, at_s: f64) -> f64 {
        if let Some(begin) = self.shift.take() {
            self.offset = begin - at_s;
        }
        let at_s = at_s + self.offset;
        let first = *self.first.get_or_insert(at_s);
        self.rows += 1.0;
        let Some(last_s) = self.last_s else {
            self.last_s = Some(at_s);
            return at_s;
        };
        let period = ((at_s - first) / self.rows).max(1e-4);
        let even = last_s + period;
        let off = at_s - even;
        let next = if off.abs() > Self::FAR_S {
            // behind a gap the period is another mean
            (self.first, self.rows) = (Some(at_s), 0.0);
            at_s.max(last_s + 1e-4)
        } else {
            even + Self::FOLLOWS * off
        };
        let next = (next.max(last_s + 1e-5) * 1e6).round() / 1e6;
        self.last_s = Some(next);
        next
    }

    /// After a row of an earlier run: what arrives now is later.
    pub(crate) fn after(last_s: Option<f64>) -> Self {
        Self { last_s, shift: last_s.map(|last_s| last_s + 1.0), ..Self::default() }
    }
}
