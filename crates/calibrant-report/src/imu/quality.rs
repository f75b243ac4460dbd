//! The quality of an IMU's calibration, in one sentence.

use crate::number_format;
use calibrant_core::estimate::ImuCalibration;

/// How well gravity agrees after rotations and in holds, and how well known turns agree. The sentence names
/// the errors before the calibration, too.
#[must_use]
pub fn imu_quality(calibration: &ImuCalibration) -> String {
    let mut parts = Vec::new();
    if calibration.rotations.iter().any(|rotation| rotation.used) {
        parts.push(format!(
            "after a rotation, gravity is {} ({} before)",
            agreement(calibration.rotation_rms_rad()),
            number_format::missed_angle(calibration.rotation_rms_before_rad())
        ));
    }
    if !calibration.turns.is_empty() && !calibration.turns_check_the_gains() {
        parts.push("the known turns determine the gains: nothing is left to check these with".into());
    } else if !calibration.turns.is_empty() {
        let squares =
            calibration.turns.iter().map(|turn| (turn.measured_rad - turn.angle_rad).norm_squared());
        let rms = (squares.sum::<f64>() / calibration.turns.len() as f64).sqrt();
        parts.push(format!("known turns are {}", agreement(rms)));
    }
    if let Some(tilt) = &calibration.holds.tilt {
        parts.push(match tilt.sd_rad {
            0.0 if tilt.degrees_of_freedom > 0 => {
                "the faces scatter no more than noise explains: no tilt shows".into()
            }
            sd => {
                let sd = number_format::significant(sd.to_degrees(), 2);
                format!("the faces were met within {sd}° about each axis, {}", tilt.source_in_words())
            }
        });
    }
    parts.push(match calibration.holds.degrees_of_freedom {
        0 => "gravity in the holds determines the accelerometer: nothing is left to check it with".into(),
        _ => format!(
            "held still, the corrected magnitude is that of gravity within {} mm/s² rms",
            number_format::significant(1e3 * calibration.holds.magnitude_residual_rms_mps2, 2)
        ),
    });
    parts.join("; ")
}

/// The agreement with its rms, or the words that there is none.
fn agreement(rms_rad: f64) -> String {
    let how = if rms_rad > std::f64::consts::PI { "missed by" } else { "met within" };
    format!("{how} {} rms", number_format::missed_angle(rms_rad))
}

#[cfg(test)]
mod tests {
    use super::agreement;

    #[test]
    fn what_is_not_met_is_not_called_met() {
        assert_eq!(agreement(0.12_f64.to_radians()), "met within 0.12° rms");
        assert_eq!(agreement(98_966_f64.to_radians()), "missed by more than 180° rms");
    }
}
