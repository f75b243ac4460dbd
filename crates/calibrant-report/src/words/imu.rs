//! What is said of a whole IMU.

use calibrant_core::diagnostic::{Diagnostic, UnitMistake, late, repair};

pub(super) fn message(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::TimeOffset { offset_s, offset_sd_s } => format!(
            "the gyroscope shows movements {} than the accelerometer (± {:.1} ms): a latency, or clocks that were set differently; holds and rotations are cut short by it: {}",
            late(*offset_s, 1),
            1e3 * offset_sd_s,
            repair(*offset_s, 0.0, 4)
        ),
        Diagnostic::ClockSkew { first_offset_s, last_offset_s, skew, skew_sd } => format!(
            "the clocks of the two sensors go at different rates: the gyroscope shows movements {} than the accelerometer at the beginning and {} at the end, {:+.4} ± {:.4} % of the time; its \
             gains are too {} by this share if the accelerometer's clock is right: {}",
            late(*first_offset_s, 1),
            late(*last_offset_s, 1),
            100.0 * skew,
            100.0 * skew_sd,
            if *skew > 0.0 { "large" } else { "small" },
            repair(*first_offset_s, *skew, 3)
        ),
        Diagnostic::HoldMoved { hold, rate_rms, unit } => format!(
            "the gyroscope turns in {hold}, by {rate_rms:.2e} {} rms: what it shows there is not taken for its bias; an accelerometer does not see a turn \
             about the vertical: correct holds.intervals_s, or leave them away so that holds are looked for",
            unit.symbol()
        ),
        Diagnostic::AxesInOtherOrder { order: [x, y, z], by_turns } => {
            let housing = if *by_turns {
                "; where both sensors share a housing, the turns or the gyroscope's columns are in another order than given"
            } else {
                ""
            };
            format!(
                "the gyroscope's axes are not the accelerometer's: along x, y and z of the accelerometer lie {x}, {y} and {z} of the gyroscope{housing}"
            )
        }
        Diagnostic::GyroscopeTurned { angle_rad, about_x, about_y, about_z, is_mirrored } => format!(
            "the gyroscope is turned by {:.0}° against the accelerometer, about the axis ({about_x:.2}, {about_y:.2}, {about_z:.2}){}",
            angle_rad.to_degrees(),
            if *is_mirrored { ", and its axes point the other way" } else { "" }
        ),
        Diagnostic::GravityMissedMore { after_rad, before_rad } => format!(
            "gravity after a rotation is missed by more than before the calibration, {:.2}° in place of {:.2}°: something that was given does not fit the rotations",
            after_rad.to_degrees(),
            before_rad.to_degrees()
        ),
        Diagnostic::GainImplausible { sensor_kind, axis, gain, unit } => format!(
            "the {sensor_kind} shows {gain:.3} of what there is along its axis {axis}, for readings in {} it should be near 1: are unit, sample rate, order and \
             direction of the axes right, and what was given of turns and faces?",
            unit.symbol()
        ),
        Diagnostic::LatitudeUnknown { earth_rate_radps, of_g_sensitivity, times } => {
            let (like, of_what) = match of_g_sensitivity {
                true => ("looks like g-sensitivity", "the latter's"),
                false => ("adds to turns of known angle", "the gyroscope's"),
            };
            format!(
                "the Earth turns about the vertical by {earth_rate_radps:.2e} rad/s times the sine of the latitude, which {like}: not knowing it makes {of_what} standard deviations \
                 up to {times:.1} times larger; give holds.latitude_deg"
            )
        }
        _ => return of_rotations(diagnostic).or_else(|| of_given(diagnostic)),
    })
}

fn of_rotations(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::RotationLeftOut { from_hold, to_hold, start_s, end_s, reason, .. } => format!(
            "the rotation from hold {from_hold} to hold {to_hold} ({start_s:.1} to {end_s:.1} s) was left out: {}",
            reason
        ),
        Diagnostic::RotationsLeftOutInARow { rotations, start_s, end_s } => format!(
            "the {rotations} rotations from {start_s:.1} to {end_s:.1} s were left out one after another, which is no chance: did the gyroscope saturate there, or one of the sensors change?"
        ),
        Diagnostic::TurnShare { share, mistake } => {
            let why = mistake.as_ref().map_or_else(
                || "are the angle of the turns, the sample rate and the gyroscope's unit right?".to_owned(),
                UnitMistake::to_string,
            );
            format!("the gyroscope shows {share:.3} of the angle of every turn: {why}")
        }
        Diagnostic::TurnUnlikeGiven { turn, mistake: Some(mistake) } => format!("{turn}, {mistake}"),
        Diagnostic::TurnUnlikeGiven { turn, mistake: None } => {
            format!("{turn}: correct its angle, its axis or its times")
        }
        Diagnostic::TurnContradicted { turn, angle_rad, deviations } => format!(
            "{turn}, {:.1}°, does not fit the other data, by {deviations:.0} standard deviations: are its times, axis and angle right?",
            angle_rad.to_degrees()
        ),
        _ => return None,
    })
}

fn of_given(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::KnownContradicted { known } => known.to_string(),
        Diagnostic::ChiSquaredLarge { chi2, degrees_of_freedom } => format!(
            "χ² is {chi2:.0} with {degrees_of_freedom:.0} degrees of freedom: the data contradict what was given (fixed terms and priors in [known], directions, turns, noise), and \
             the standard deviations are too small"
        ),
        Diagnostic::TemperatureExtrapolated { coldest_c, hottest_c, holds_coldest_c, holds_hottest_c } => {
            format!(
                "the recording goes from {coldest_c:.1} to {hottest_c:.1} °C, its holds from {holds_coldest_c:.1} to {holds_hottest_c:.1} °C only: beyond these the polynomials of temperature extrapolate"
            )
        }
        Diagnostic::ReferenceExtrapolated { reference_c, holds_coldest_c, holds_hottest_c } => format!(
            "biases and gains are given at the reference of {reference_c:.1} °C, beyond the {holds_coldest_c:.1} to {holds_hottest_c:.1} °C of the holds: there they are extrapolated"
        ),
        _ => return None,
    })
}
