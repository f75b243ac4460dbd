//! Fewer points for the same picture.

/// At most this many columns of pixels are told apart in a panel.
const COLUMNS: usize = 400;

/// The smallest and the largest value of each column of pixels, in order of x: looks the same as all points.
pub(super) fn thinned(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    if points.len() <= 3 * COLUMNS {
        return points;
    }
    let per_column = points.len().div_ceil(COLUMNS);
    let mut kept = Vec::with_capacity(2 * COLUMNS);
    for column in points.chunks(per_column) {
        let finite = || column.iter().enumerate().filter(|(_, p)| p.0.is_finite() && p.1.is_finite());
        let low = finite().min_by(|(_, a), (_, b)| a.1.total_cmp(&b.1));
        let high = finite().max_by(|(_, a), (_, b)| a.1.total_cmp(&b.1));
        if let (Some((i, &low)), Some((j, &high))) = (low, high) {
            match i.cmp(&j) {
                std::cmp::Ordering::Less => kept.extend([low, high]),
                std::cmp::Ordering::Equal => kept.push(low),
                std::cmp::Ordering::Greater => kept.extend([high, low]),
            }
        }
    }
    kept
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
        let kept = thinned(points);
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
