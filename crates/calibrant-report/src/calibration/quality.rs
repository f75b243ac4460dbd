//! From what data a calibration is, and how good it is, in words.

use crate::number_format;
use calibrant_core::estimate::{Calibration, FaceTilt, Recovered};

/// Below this, a probability counts as evidence against the model.
const SIGNIFICANT: f64 = 0.001;

/// The data that were used: `14 of 14 holds, 12 of 13 rotations between them and 1 turn of known angle`.
#[must_use]
pub fn used_in_words(calibration: &Calibration) -> String {
    let holds = match &calibration.recovered {
        Recovered::Motion(motion) => {
            let intervals = number_format::counted(motion.motion.intervals(), "interval");
            return format!(
                "{} samples of a motion of {intervals}",
                number_format::count(motion.residuals.len())
            );
        }
        Recovered::Holds(holds) => &holds.holds,
    };
    let used =
        |used: usize, all: usize, what: &str| format!("{used} of {}", number_format::counted(all, what));
    let mut from = vec![used(holds.iter().filter(|hold| hold.used).count(), holds.len(), "hold")];
    let (rotations, turns) = (calibration.rotations(), calibration.turns());
    if !rotations.is_empty() {
        let good = rotations.iter().filter(|rotation| rotation.used).count();
        from.push(used(good, rotations.len(), "rotation") + " between them");
    }
    if !turns.is_empty() {
        from.push(number_format::counted(turns.len(), "turn") + " of known angle");
    }
    let last = from.pop().unwrap_or_default();
    if from.is_empty() { last } else { format!("{} and {last}", from.join(", ")) }
}

/// How well gravity agrees after rotations and in holds, how well known turns agree, and whether the assumed
/// noise explains the data. The sentence names the errors before the calibration, too.
#[must_use]
pub fn calibration_quality(calibration: &Calibration) -> String {
    let mut parts = Vec::new();
    if calibration.rotations().iter().any(|rotation| rotation.used) {
        parts.push(format!(
            "after a rotation, gravity is {} ({} before)",
            agreement(calibration.rotation_rms_rad()),
            number_format::missed_angle(calibration.rotation_rms_before_rad())
        ));
    }
    if !calibration.turns().is_empty() && !calibration.turns_check_the_gains() {
        parts.push("the known turns determine the gains: nothing is left to check these with".into());
    } else if !calibration.turns().is_empty() {
        let squares =
            calibration.turns().iter().map(|turn| (turn.measured_rad - turn.angle_rad).norm_squared());
        let rms = (squares.sum::<f64>() / calibration.turns().len() as f64).sqrt();
        parts.push(format!("known turns are {}", agreement(rms)));
    }
    if let Some(holds) = calibration.holds() {
        parts.extend(holds.tilt.as_ref().map(face_alignment));
        parts.push(match holds.degrees_of_freedom {
            0 => "gravity in the holds determines the accelerometer: nothing is left to check it with".into(),
            _ => format!(
                "held still, the corrected magnitude is that of gravity within {} mm/s² rms",
                number_format::significant(1e3 * holds.magnitude_residual_rms_mps2, 2)
            ),
        });
    }
    parts.extend(calibration.fit.p_value.map(noise_explains));
    parts.join("; ")
}

/// How well the sensor was placed on its faces.
fn face_alignment(tilt: &FaceTilt) -> String {
    if tilt.sd_rad == 0.0 && tilt.degrees_of_freedom > 0 {
        return "the faces scatter no more than noise explains: no tilt shows".into();
    }
    let sd = number_format::significant(tilt.sd_rad.to_degrees(), 2);
    format!("the faces were met within {sd}° about each axis, {}", tilt.source_in_words())
}

/// Whether model and assumed noise explain the data.
fn noise_explains(p: f64) -> String {
    let p_value = number_format::probability(p);
    if p < SIGNIFICANT {
        format!(
            "model and assumed noise do not explain the data (χ² p-value {p_value}): the noise is larger than assumed, or the model misses something"
        )
    } else if p > 1.0 - SIGNIFICANT {
        format!(
            "the residuals are smaller than the assumed noise allows (χ² p-value {p_value}): the assumed noise and the standard deviations are too large"
        )
    } else {
        format!("model and assumed noise explain the data (χ² p-value {p_value})")
    }
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
