//! Sums over residuals, from which noise follows.

/// Sums over whitened residuals.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Moments {
    pub(crate) count: f64,
    /// Sum of squares.
    pub(crate) squares: f64,
    /// Sum of leverages: unknowns that these samples determine.
    pub(crate) leverage: f64,
}

impl std::ops::AddAssign for Moments {
    fn add_assign(&mut self, other: Self) {
        self.count += other.count;
        self.squares += other.squares;
        self.leverage += other.leverage;
    }
}

impl Moments {
    /// Squared factor by which the noise differs from what was assumed.
    pub(crate) fn variance_factor(&self) -> Option<f64> {
        let degrees = self.count - self.leverage;
        (degrees > 0.0).then(|| self.squares / degrees)
    }

    pub(crate) fn times(self, number: f64) -> Self {
        Self { count: number * self.count, squares: number * self.squares, leverage: number * self.leverage }
    }

    pub(crate) fn add(&mut self, residual: f64, leverage: f64) {
        self.count += 1.0;
        self.squares += residual * residual;
        self.leverage += leverage;
    }
}

/// Residuals up to this many standard deviations keep their full weight.
const HUBER: f64 = 4.0;

/// Square root of the weight of a whitened residual, and its part of the cost `2ρ`.
pub(crate) fn huber(whitened: f64) -> (f64, f64) {
    let size = whitened.abs();
    if size <= HUBER {
        (1.0, whitened * whitened)
    } else {
        ((HUBER / size).sqrt(), HUBER * (2.0 * size - HUBER))
    }
}
