//! Thinning of points: fewer points for the same picture.

use crate::number_format::count;

/// Largest number of columns of pixels in a panel.
const COLUMNS: usize = 400;

/// The smallest and the largest value of each column of pixels, in order of x. It looks the same as all
/// points.
pub(super) fn thinned(points: impl ExactSizeIterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    if !is_thinned(points.len()) {
        return points.collect();
    }
    let per_column = points.len().div_ceil(COLUMNS);
    let points: Vec<(f64, f64)> = points.collect();
    points.chunks(per_column).flat_map(extremes).collect()
}

/// The smallest and the largest finite value in order of x; one value where both are the same.
fn extremes(column: &[(f64, f64)]) -> impl Iterator<Item = (f64, f64)> {
    let finite = || column.iter().copied().filter(|point| point.0.is_finite() && point.1.is_finite());
    let low = finite().reduce(|low, point| if point.1 < low.1 { point } else { low });
    let high = finite().reduce(|high, point| if point.1 > high.1 { point } else { high });
    let (first, second) =
        if high.zip(low).is_some_and(|(h, l)| h.0 < l.0) { (high, low) } else { (low, high) };
    first.into_iter().chain(second.filter(|_| first != second))
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

/// That a figure draws so many of all sensors; nothing where it draws all.
pub(super) fn drawn_in_words(all: usize, drawn: usize) -> String {
    if drawn >= all {
        return String::new();
    }
    format!(" Of {} sensors, {drawn} spread evenly over the list are drawn.", count(all))
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
        // constant, and unknown in part
        let flat = (0..100_000).map(|i| (f64::from(i), if i < 50_000 { f64::NAN } else { 2.0 }));
        let kept = thinned(flat);
        assert_eq!((kept.len(), kept[0]), (COLUMNS / 2, (50_000.0, 2.0)));
    }

    #[test]
    fn a_subset_has_both_ends() {
        assert_eq!(every(3, 10), [0, 1, 2]);
        let chosen = every(1_000, 11);
        assert_eq!((chosen.len(), chosen[0], chosen[10]), (11, 0, 999));
        assert!(every(0, 10).is_empty());
    }
}
