//! How well the axis of a turn of known angle is known.

/// An axis set by hand, rad: half a degree.
const BY_HAND_RAD: f64 = 0.5 * std::f64::consts::PI / 180.0;

/// Standard deviation of the direction of a turn's axis, rad: as it is stated, or by that of its angle.
///
/// Without a statement it is that of the angle. Over many turns the angle's error grows, and the axis stays the same: then it is that of the angle for each full turn, but half
/// a degree at least.
#[must_use]
pub(crate) fn turn_axis_sd_rad(angle_rad: f64, angle_sd_rad: f64, stated: Option<f64>) -> f64 {
    let turns = (angle_rad.abs() / std::f64::consts::TAU).max(1.0);
    stated.unwrap_or_else(|| angle_sd_rad.min(BY_HAND_RAD.max(angle_sd_rad / turns)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_turns_have_the_axis_of_one() {
        let degrees = |angle: f64, sd: f64| {
            (turn_axis_sd_rad(angle.to_radians(), sd.to_radians(), None).to_degrees() * 1e6).round() / 1e6
        };
        assert_eq!([degrees(-360.0, 0.5), degrees(360.0, 3.0), degrees(90.0, 0.01)], [0.5, 3.0, 0.01]);
        assert_eq!(turn_axis_sd_rad(6.0, 0.1, Some(0.3)), 0.3);
        // sixteen turns of a record player, known to 0.1 %
        assert_eq!([degrees(6000.0, 6.0), degrees(-6000.0, 0.1), degrees(3600.0, 60.0)], [0.5, 0.1, 6.0]);
    }
}
