//! Fewer points for the same picture.

/// At most this many columns of pixels are told apart in a panel.
const COLUMNS: usize = 400;

/// The smallest and the largest value of each column of pixels, in order of x: looks the same as all points.
pub(super) fn thinned(points: impl ExactSizeIterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    thinned_to(COLUMNS, points)
}

/// The same for dots, each of which is as wide as two columns.
pub(super) fn thinned_dots(points: impl ExactSizeIterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    thinned_to(COLUMNS / 2, points)
}

fn thinned_to(columns: usize, mut points: impl ExactSizeIterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    if points.len() <= 3 * columns {
        return points.collect();
    }
    let per_column = points.len().div_ceil(columns);
    let mut kept = Vec::with_capacity(2 * columns);
    while points.len() > 0 {
        let mut column = Column::default();
        let finite = |point: &(f64, f64)| point.0.is_finite() && point.1.is_finite();
        points.by_ref().take(per_column).filter(finite).for_each(|point| column.add(point));
        kept.extend(column.extremes());
    }
    kept
}

/// The extremes of a column of pixels.
#[derive(Default)]
struct Column {
    low: Option<(f64, f64)>,
    high: Option<(f64, f64)>,
}

impl Column {
    fn add(&mut self, point: (f64, f64)) {
        if self.low.is_none_or(|low| point.1 < low.1) {
            self.low = Some(point);
        }
        if self.high.is_none_or(|high| point.1 > high.1) {
            self.high = Some(point);
        }
    }

    /// In order of x; one where both are the same.
    fn extremes(self) -> impl Iterator<Item = (f64, f64)> {
        let (first, second) = match (self.low, self.high) {
            (Some(low), Some(high)) if high.0 < low.0 => (Some(high), Some(low)),
            (low, high) => (low, high.filter(|_| low != high)),
        };
        first.into_iter().chain(second)
    }
}

/// Is a series of this length shown thinned?
pub(super) fn is_thinned(len: usize) -> bool {
    len > 3 * COLUMNS
}

/// Evenly spread indices, at most `most` of them, with the first and the last.
pub(super) fn every(len: usize, most: usize) -> Vec<usize> {
    if len <= most || most < 2 {
        return (0..len.min(most.max(1))).collect();
    }
    (0..most).map(|i| i * (len - 1) / (most - 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_the_extremes_and_the_order() {
        let mut points: Vec<_> = (0..100_000).map(|i| (f64::from(i), f64::from(i % 7))).collect();
        points[54_321].1 = 99.0;
        points[12_345].1 = f64::NAN;
        let kept = thinned(points.into_iter());
        assert!(kept.len() <= 2 * COLUMNS);
        assert!(kept.contains(&(54_321.0, 99.0)));
        assert!(kept.windows(2).all(|pair| pair[0].0 < pair[1].0));
        assert!(kept.iter().all(|point| point.1.is_finite()));
    }

    #[test]
    fn a_subset_has_both_ends() {
        assert_eq!(every(3, 10), [0, 1, 2]);
        let chosen = every(1_000, 11);
        assert_eq!((chosen.len(), chosen[0], chosen[10]), (11, 0, 999));
        assert!(every(0, 10).is_empty());
    }
}
