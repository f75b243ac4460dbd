//! Linear interpolation between the samples of a recording.

use std::ops::{Add, Mul};

/// A value at a time, linear between samples, the nearest one outside; `None` where there is no sample.
/// `near` is the sample at which the search starts: the times of two sensors are mostly the same.
pub fn interpolated<T>(times_s: &[f64], value: impl Fn(usize) -> T, time_s: f64, near: usize) -> Option<T>
where
    T: Mul<f64, Output = T> + Add<Output = T>,
{
    if times_s.get(near) == Some(&time_s) {
        return Some(value(near));
    }
    let after = times_s.partition_point(|&t| t < time_s);
    match (after.checked_sub(1), times_s.get(after)) {
        (None, None) => None,
        (Some(last), None) => Some(value(last)),
        (None, Some(_)) => Some(value(0)),
        (Some(before), Some(&t1)) => {
            let t0 = times_s[before];
            let part = (time_s - t0) / (t1 - t0);
            Some(value(before) * (1.0 - part) + value(after) * part)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_linear_between_samples_and_constant_outside() {
        let (times, values) = ([0.0, 1.0, 3.0], [20.0, 22.0, 30.0]);
        for near in [0, 1, 7] {
            let at = |t: f64| interpolated(&times, |k| values[k], t, near).expect("samples");
            assert_eq!([-1.0, 0.5, 1.0, 1.5, 3.0, 9.0].map(at), [20.0, 21.0, 22.0, 24.0, 30.0, 30.0]);
        }
        assert_eq!(interpolated(&[], |_| 0.0, 1.0, 0), None);
    }
}
