//! The figure of the criterion over the jerks of two intervals, as a map in bands: the thesis's Figure 7.

use super::panel::{Map, Panel, Points, Series, Shape};
use super::{Figure, colour};
use crate::number_format::short;
use calibrant_design::TraceSurface;

/// Largest number of bands: each makes the page longer.
const MOST_BANDS: f64 = 12.0;

/// The map; dark is good.
pub(crate) fn trace_map(surface: &TraceSurface) -> Figure {
    let (settings, jerks) = (&surface.settings, &surface.jerk_mps3);
    let known = |i: usize, j: usize| {
        surface.log10_trace.get(i)?.get(j).copied().flatten().filter(|value| value.is_finite())
    };
    let places = || (0..jerks.len()).flat_map(|i| (0..jerks.len()).map(move |j| (i, j)));
    let values = || places().filter_map(|(i, j)| known(i, j));
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    let mut panel = Panel::new("", "jerk u₁ of the first interval (m/s³)", "jerk u₂ of the second (m/s³)");
    if low <= high {
        let row = |j: usize| (0..jerks.len()).map(|i| known(i, j).unwrap_or(high)).collect();
        panel.map = Some(Map {
            label: "log₁₀ trace",
            x: jerks.clone(),
            y: jerks.clone(),
            values: (0..jerks.len()).map(row).collect(),
            levels: levels(low, high),
        });
        let unknown: Points =
            places().filter(|(i, j)| known(*i, *j).is_none()).map(|(i, j)| (jerks[i], jerks[j])).collect();
        if !unknown.is_empty() {
            let label = "not determined: the sensor does not move";
            panel = panel.with(Series::dots(label, colour::BLACK, (Shape::Cross, 4.5), unknown));
        }
    }
    let caption = format!(
        "A uniaxial sensor and two intervals of {} s, at {} Hz, starting at {} m/s²: decimal logarithm of the sum of the variances of bias \
         and scale factor (in SI units) over the jerks of both intervals. The peak lies where both jerks vanish: a sensor \
         that hardly moves does not determine its scale factor. The smallest values lie in corners, \
         where the jerks are largest, so the optimum lies on the limits. A cell is one pair of jerks. The thesis estimates at each \
         point, draws a surface in space, and does not name its logarithm. The trace needs no estimation: it follows from \
         the motion alone.",
        short(settings.interval_s),
        short(settings.rate_hz),
        short(settings.start_mps2),
    );
    let title = "Figure 7 of the thesis: logarithm of the trace over the two jerks";
    Figure::new(title, vec![panel], caption)
}

/// Edges of bands of equal height: round numbers between these ends.
fn levels(low: f64, high: f64) -> Vec<f64> {
    let steps = [0.01, 0.02, 0.05, 0.1, 0.2, 0.25, 0.5, 1.0, 2.0, 5.0];
    let fits = |step: &f64| (high - low) / step <= MOST_BANDS - 1.0;
    let step = steps.into_iter().find(fits).unwrap_or(50.0);
    let (first, last) = ((low / step).floor() as i64, (high / step).ceil() as i64);
    (first..=last).map(|k| k as f64 * step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_hold_all_values_between_round_numbers() {
        for (low, high) in [(-9.43, -6.21), (-9.4, -9.39), (-3.0, -3.0), (-12.0, 55.0)] {
            let levels = levels(low, high);
            assert!(levels.len() <= 14 && levels[0] <= low + 1e-12, "{low} {high}: {levels:?}");
            assert!(levels[levels.len() - 1] >= high - 1e-12, "{low} {high}: {levels:?}");
            let step = levels.windows(2).map(|pair| pair[1] - pair[0]);
            assert!(step.clone().all(|step| (step - (levels[1] - levels[0])).abs() < 1e-9), "{levels:?}");
        }
    }
}
