//! The distance of ticks, and ranges that end at them: the axes reach the data.

/// Room beyond the outermost ticks, as a share of the range.
const ROOM: f64 = 0.02;

/// Data this close to a tick, as a share of a step, reach it.
const NEAR: f64 = 0.01;

/// The range of a linear axis, and the distance of its ticks: from the last tick that is not above `low` to the first that is not below `high`, with a little room. Between
/// them are at most `most` steps; of the steps that fit, the one that adds least to the range is chosen. `step`: the
/// distance of the ticks, where it is given.
pub(super) fn ticked((low, high): (f64, f64), most: usize, step: Option<f64>) -> Option<((f64, f64), f64)> {
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) {
        return None;
    }
    let decade = 10f64.powf(span.log10().floor());
    let steps = [0.1, 0.2, 0.25, 0.5, 1.0, 2.0].map(|of| of * decade);
    let choices = step.as_slice().iter().chain(step.is_none().then_some(&steps).into_iter().flatten());
    let ended = choices.map(|&step| {
        // rounding of the data must not add a step, and there is room beyond the ticks
        let (first, last) = ((low / step + NEAR).floor(), (high / step - NEAR).ceil());
        (step, first, last)
    });
    let fits =
        ended.filter(|(_, first, last)| step.is_some() || ((3.0..=most as f64).contains(&(last - first))));
    let (step, first, last) = fits.min_by(|a, b| (a.0 * (a.2 - a.1)).total_cmp(&(b.0 * (b.2 - b.1))))?;
    let room = ROOM * step * (last - first);
    Some(((first * step - room, last * step + room), step))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_end_at_ticks_beyond_the_data() {
        for (low, high) in [
            (0.0, 117.99),
            (-0.21, 0.265),
            (1.0, 24.0),
            (-30.0, 30.0),
            (9.798, 9.8021),
            (1.7e9, 1.7e9 + 166.0),
        ] {
            let (range, step) = ticked((low, high), 7, None).expect("a range");
            let steps = (range.1 - range.0) / step;
            assert!(
                range.0 <= low && high <= range.1 && (3.0..=7.3).contains(&steps),
                "{low} {high}: {range:?} {step}"
            );
            assert!(range.1 - range.0 < 1.5 * (high - low), "{low} {high}: {range:?}");
        }
        assert_eq!(ticked((0.0, 40.0), 7, Some(10.0)).expect("a range").1, 10.0);
        assert!(ticked((2.0, 2.0), 7, None).is_none());
    }
}
