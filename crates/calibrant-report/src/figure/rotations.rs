//! The figure of the rotation errors of an IMU.

use super::panel::{Panel, Series, Shape};
use super::{Figure, colour};
use calibrant_core::estimate::RotationResult;

/// Above this ratio of the largest to the smallest error, the axis is logarithmic.
const WIDE: f64 = 10.0;

/// Errors before and after the calibration of each rotation that could be integrated, over time and over the path; `None` where there is none.
pub(crate) fn rotation_errors(rotations: &[RotationResult]) -> Option<Figure> {
    let shown: Vec<&RotationResult> = rotations.iter().filter(|rotation| rotation.is_integrated()).collect();
    if shown.is_empty() {
        return None;
    }
    let of = |label: &str, x: fn(&RotationResult) -> f64| {
        let pair =
            |r: &RotationResult| [r.error_before_rad, r.error_rad].map(|error| (x(r), error.to_degrees()));
        let mut panel = Panel::new("", label, "rotation error (°)");
        for rotation in &shown {
            panel = panel.with(Series::stroke("", colour::GREY, (0.8, ""), pair(rotation).to_vec()));
        }
        let before = shown.iter().map(|r| pair(r)[0]).collect();
        let errors = || shown.iter().flat_map(|r| pair(r)).map(|point| point.1).filter(|error| *error > 0.0);
        let (low, high) = errors().fold((f64::INFINITY, 0.0_f64), |(l, h), e| (l.min(e), h.max(e)));
        panel
            .with(Series::dots("before", colour::ORANGE, (Shape::Square, 3.0), before))
            .with_used(["after", "after, not used"], [3.2, 5.0], shown.iter().map(|r| (r.used, pair(r)[1])))
            .log_or_from_zero(high > WIDE * low)
    };
    let panels = vec![
        of("time (s)", |rotation| 0.5 * (rotation.start_s + rotation.end_s)),
        of("path of the rotation (°)", |rotation| rotation.path_rad.to_degrees()),
    ];
    let caption = "The gyroscope propagates gravity from the hold before a rotation to the hold after it. The rotation error is the angle to the gravity that \
                   the accelerometer measures there. Each rotation has a pair of markers. Before: with one bias and one gain for all axes, \
                   or the datasheet's. Good: the blue markers are far below the orange ones, without a trend. Errors that grow to the right come from the gyroscope's \
                   gains. Other errors come from noise and a wandering bias.";
    Some(Figure::new("Rotation errors", panels, caption).with_columns(2))
}
