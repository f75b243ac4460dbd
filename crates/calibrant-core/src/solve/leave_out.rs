//! Leaves bad residuals out, one change at a time: the worst that is too bad goes, or else the best that is not comes back.

/// What a fit says of the residuals.
pub(crate) struct Judged {
    /// Size of each in standard deviations, its own influence removed.
    pub(crate) studentised: Vec<f64>,
    /// The largest that chance explains.
    pub(crate) limit: f64,
    /// Are there enough to leave one more out?
    pub(crate) may_leave_out: bool,
}

/// Leaves out the worst residual beyond the limit, or takes back the best one within it, one at a time, until neither is there or `most` changes are made.
/// `weigh` fits those that are used, given the fit before.
pub(crate) fn leave_out<W, E>(
    is_usable: &[bool],
    mut used: Vec<bool>,
    most: usize,
    mut weigh: impl FnMut(&[bool], Option<&W>) -> Result<W, E>,
    judge: impl Fn(&[bool], &W) -> Judged,
) -> Result<(Vec<bool>, W), E> {
    let mut weighed = weigh(&used, None)?;
    for _ in 0..most {
        let Judged { studentised, limit, may_leave_out } = judge(&used, &weighed);
        let size = |k: &usize| studentised[*k].abs();
        let worst = (0..used.len())
            .filter(|k| used[*k] && size(k) > limit)
            .max_by(|one, other| size(one).total_cmp(&size(other)));
        let best = (0..used.len())
            .filter(|k| !used[*k] && is_usable[*k] && size(k) <= limit)
            .min_by(|one, other| size(one).total_cmp(&size(other)));
        match (worst, best) {
            (Some(k), _) if may_leave_out => used[k] = false,
            (_, Some(k)) => used[k] = true,
            _ => break,
        }
        weighed = weigh(&used, Some(&weighed))?;
    }
    Ok((used, weighed))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    /// Readings of standard deviation 1 about their mean.
    fn used_of(readings: &[f64], is_usable: &[bool], start: &[bool], least: usize) -> (Vec<bool>, usize) {
        let mut fits = 0;
        let count = |used: &[bool]| used.iter().filter(|used| **used).count();
        let mean = |used: &[bool], _: Option<&f64>| {
            fits += 1;
            let sum: f64 = readings.iter().zip(used).filter(|(_, used)| **used).map(|(y, _)| y).sum();
            Ok::<f64, Infallible>(sum / count(used) as f64)
        };
        let judge = |used: &[bool], mean: &f64| Judged {
            studentised: readings.iter().map(|y| y - mean).collect(),
            limit: 3.0,
            may_leave_out: count(used) > least,
        };
        let Ok((used, _)) = leave_out(is_usable, start.to_vec(), 20, mean, judge);
        (used, fits)
    }

    #[test]
    fn the_worst_goes_and_what_it_hid_comes_back() {
        let readings = [0.0, 0.5, -0.5, 0.2, 40.0, 30.0];
        // both outliers go one by one
        let (used, fits) = used_of(&readings, &[true; 6], &[true; 6], 2);
        assert_eq!(used, [true, true, true, true, false, false]);
        assert_eq!(fits, 3);
        // good ones that were left out at first come back, what cannot be used does not
        let start = [true, false, false, false, false, false];
        let (used, _) = used_of(&readings, &[true, true, false, true, true, true], &start, 2);
        assert_eq!(used, [true, true, false, true, false, false]);
        // too few to leave any out
        assert_eq!(used_of(&readings, &[true; 6], &[true; 6], 6).0, [true; 6]);
    }
}
