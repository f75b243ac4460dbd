//! Sentences about a whole IMU: clocks, axes, rotations, turns, given values.

use calibrant_core::diagnostic::{Diagnostic, UnitMistake, late, repair};
use calibrant_core::sensor::ReadingUnit;

/// The gain of an accelerometer whose readings in g are taken for m/s².
const GAIN_IN_G: f64 = 0.102;

pub(super) fn message(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::TimeOffset { offset_s, offset_sd_s } => format!(
            "the gyroscope shows movements {} than the accelerometer (± {:.1} ms). Either one sensor has a latency, or the clocks differ. The offset shortens holds and rotations. To correct it, {}.",
            late(*offset_s, 1),
            1e3 * offset_sd_s,
            repair(*offset_s, 0.0, 4)
        ),
        Diagnostic::ClockSkew { first_offset_s, last_offset_s, skew, skew_sd } => format!(
            "the clocks of the two sensors run at different rates, by {2:+.4} ± {3:.4} %. The gyroscope shows movements {0} than the accelerometer at the beginning, and {1} at the end. \
             If the accelerometer's clock is right, the gyroscope's gains are too {4} by this percentage. To correct it, {5}.",
            late(*first_offset_s, 1),
            late(*last_offset_s, 1),
            100.0 * skew,
            100.0 * skew_sd,
            if *skew > 0.0 { "large" } else { "small" },
            repair(*first_offset_s, *skew, 3)
        ),
        Diagnostic::HoldMoved { holds, rate_rms, unit, are_given } => {
            let holds: Vec<String> = holds.iter().map(ToString::to_string).collect();
            format!(
                "the gyroscope turns in {}, by up to {rate_rms:.2e} {} rms. Its readings there are not used for its bias. An accelerometer does not see a rotation \
                 about the vertical. {}",
                holds.join(", "),
                unit.symbol(),
                if *are_given {
                    "Correct holds.intervals_s, or remove that key: the program then finds the holds."
                } else {
                    "Put the sensor down for each hold."
                }
            )
        }
        Diagnostic::AxesInOtherOrder { order: [x, y, z], by_turns } => {
            let housing = if *by_turns {
                " If both sensors share a housing, correct the order of the turns or of the gyroscope's columns."
            } else {
                ""
            };
            format!(
                "the gyroscope's axes are in another order than the accelerometer's: along x, y and z of the accelerometer lie {x}, {y} and {z} of the gyroscope.{housing}"
            )
        }
        Diagnostic::GyroscopeTurned { angle_rad, about_x, about_y, about_z, is_mirrored } => format!(
            "the gyroscope is mounted with a rotation of {:.0}° against the accelerometer, about the axis ({about_x:.2}, {about_y:.2}, {about_z:.2}){}",
            angle_rad.to_degrees(),
            if *is_mirrored { ". Its axes point the opposite way" } else { "" }
        ),
        Diagnostic::GainImplausible { sensor_kind, axis, gain, unit } => format!(
            "the gain of the {sensor_kind}'s axis {axis} is {gain:.3}. For readings in {} it should be near 1.{} Check unit, sample rate, order and \
             direction of the axes, and the given turns and faces.",
            unit.symbol(),
            if *unit == ReadingUnit::MetrePerSecondSquared && (gain.abs() / GAIN_IN_G - 1.0).abs() < 0.1 {
                " Readings in g have a gain of 0.102."
            } else {
                ""
            }
        ),
        _ => return of_rotations(diagnostic).or_else(|| of_given(diagnostic)),
    })
}

fn of_rotations(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::RotationLeftOut { from_hold, to_hold, start_s, end_s, reason, .. } => format!(
            "the rotation from hold {from_hold} to hold {to_hold} ({start_s:.1} to {end_s:.1} s) is not used: {}",
            reason
        ),
        Diagnostic::SamplesLost { lost_share, jumps } => format!(
            "about {:.1} % of the samples are lost, and the times do not show it: in motion, {jumps} steps of the gyroscope are twice as long as their neighbours. Its gains are too small \
             by that share. Record without losses, or with times of the sensor's own clock.",
            100.0 * lost_share
        ),
        Diagnostic::RotationsLeftOutInARow { rotations, start_s, end_s } => format!(
            "the {rotations} consecutive rotations from {start_s:.1} to {end_s:.1} s are not used. This is not by chance. Did the gyroscope saturate there, or did a sensor change?"
        ),
        Diagnostic::TurnShare { share, mistake } => {
            let why = mistake.as_ref().map_or_else(
                || "check the angle of the turns, the sample rate and the gyroscope's unit.".to_owned(),
                UnitMistake::to_string,
            );
            format!("the gyroscope shows {share:.3} of the angle of every turn: {why}")
        }
        Diagnostic::TurnUnlikeGiven { turn, mistake: Some(mistake) } => format!("{turn}, {mistake}"),
        Diagnostic::TurnUnlikeGiven { turn, mistake: None } => {
            format!("{turn}. Correct its angle, its axis or its times.")
        }
        Diagnostic::TurnContradicted { turn, angle_rad, deviations } => format!(
            "{turn} of {:.1}° contradicts the other data, by {deviations:.0} standard deviations. Check its times, axis and angle.",
            angle_rad.to_degrees()
        ),
        _ => return None,
    })
}

fn of_given(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::KnownContradicted { known } => {
            format!("{known}. Correct the value or its unit, or remove it.")
        }
        Diagnostic::ChiSquaredLarge { chi2, degrees_of_freedom } => format!(
            "χ² is {chi2:.0} with {degrees_of_freedom:.0} degrees of freedom. The data contradict a given value, and the standard deviations are too small. Check fixed terms and priors in [known], directions, turns and noise."
        ),
        Diagnostic::TemperatureExtrapolated { coldest_c, hottest_c, holds_coldest_c, holds_hottest_c } => {
            format!(
                "the recording goes from {coldest_c:.1} to {hottest_c:.1} °C, but its holds only from {holds_coldest_c:.1} to {holds_hottest_c:.1} °C. Beyond these, the temperature polynomials extrapolate."
            )
        }
        Diagnostic::ReferenceExtrapolated { reference_c, holds_coldest_c, holds_hottest_c } => format!(
            "biases and gains are stated at the reference temperature of {reference_c:.1} °C. The holds cover {holds_coldest_c:.1} to {holds_hottest_c:.1} °C, and the values are extrapolated. Choose a reference within the holds."
        ),
        _ => return None,
    })
}
