//! A quantile of values in any order.

/// The value that this share of all is below; `None` of none.
pub(crate) fn quantile(mut values: Vec<f64>, share: f64) -> Option<f64> {
    let place = (share * values.len() as f64) as usize;
    (place < values.len()).then(|| *values.select_nth_unstable_by(place, f64::total_cmp).1)
}
