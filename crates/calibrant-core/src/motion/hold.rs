//! A hold: an interval in which the sensor is kept still in one orientation, reduced to its mean reading.

use nalgebra::Vector3;

/// An interval of a recording in which the sensor is stationary, reduced to its mean.
#[derive(Debug, Clone, PartialEq)]
pub struct Hold {
    /// First sample (index into the recording).
    pub first: usize,
    /// One past the last sample.
    pub end: usize,
    /// Time of the first sample, s.
    pub start_s: f64,
    /// Time of the last sample, s.
    pub end_s: f64,
    /// Mean reading ȳ, in the unit of the recording.
    pub mean: Vector3<f64>,
    /// Standard deviation of single readings within the hold.
    pub sd: Vector3<f64>,
}

/// A time rounded to the ms. Times of samples have all the digits that a division leaves.
pub(crate) fn to_ms(time_s: f64) -> f64 {
    (time_s * 1e3).round() / 1e3
}

impl Hold {
    /// Number of samples n.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.end - self.first
    }

    /// Standard deviation of single readings within holds, pooled over the holds.
    pub(crate) fn pooled_sd<'a>(holds: impl IntoIterator<Item = &'a Self>) -> Vector3<f64> {
        let (mut squares, mut degrees) = (Vector3::zeros(), 0.0_f64);
        for hold in holds {
            let own = (hold.samples() - 1) as f64;
            squares += hold.sd.component_mul(&hold.sd) * own;
            degrees += own;
        }
        (squares / degrees.max(1.0)).map(f64::sqrt)
    }

    /// Number (from 0) of the hold that lasts longest; `None` where there is no hold.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::motion::Hold;
    /// use nalgebra::Vector3;
    /// let hold = |start_s: f64, end_s: f64| Hold { first: 0, end: 2, start_s, end_s, mean: Vector3::z(), sd: Vector3::zeros() };
    /// assert_eq!(Hold::longest(&[hold(0.0, 2.0), hold(3.0, 9.0), hold(10.0, 11.0)]), Some(1));
    /// ```
    #[must_use]
    pub fn longest(holds: &[Self]) -> Option<usize> {
        let duration = |k: &usize| holds[*k].duration_s();
        (0..holds.len()).max_by(|one, other| duration(one).total_cmp(&duration(other)))
    }

    /// Duration, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.end_s - self.start_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_no_holds_none_is_the_longest() {
        assert_eq!(Hold::longest(&[]), None);
    }
}
