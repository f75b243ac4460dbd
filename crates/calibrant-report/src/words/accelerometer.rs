//! Sentences about holds, faces and readings.

use super::change::change;
use super::spikes::spikes;
use calibrant_core::diagnostic::{Diagnostic, FacePointing};
use calibrant_core::estimate::CoarseAxis;
use calibrant_core::sensor::{ReadingUnit, SensorKind};

/// A ratio with two decimals, or with two digits where it would read 0.00.
fn times(ratio: f64) -> String {
    if ratio < 0.01 { format!("{ratio:.1e}") } else { format!("{ratio:.2}") }
}

pub(super) fn message(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::NotConverged { status } => format!(
            "the iteration did not converge ({status}). The numbers are the best that it found, not the optimum."
        ),
        Diagnostic::Spikes { sensor_kind, unit, replaced, cut, axis, reading, time_s, deviations } => {
            spikes(*sensor_kind, *unit, (*replaced, *cut), *axis, (*reading, *time_s, *deviations))
        }
        Diagnostic::GyroscopeMissing {} => "the recording has no gyroscope, so only the accelerometer is calibrated. Give the gyroscope's file with --gyroscope, or name its columns in [columns].".into(),
        Diagnostic::CoarseSteps { sensor_kind, axis, unit, step, noise, mean_sd } => {
            let found = CoarseAxis { axis: *axis, step: *step, noise: *noise, mean_sd: *mean_sd };
            let coarse = coarse_axis(*sensor_kind, *unit, &found);
            let included = match sensor_kind {
                SensorKind::Accelerometer => "",
                SensorKind::Gyroscope => " The standard deviations include this error.",
            };
            format!("{coarse}{included} Choose a smaller range, or write more digits to the file.")
        }
        Diagnostic::GravityOffEarth { gravity_mps2, least_mps2, most_mps2 } => format!(
            "gravity is given as {gravity_mps2} m/s², but on the Earth's surface it is {least_mps2} to {most_mps2}. Correct holds.gravity_mps2. Otherwise all gains of the accelerometer are wrong by this ratio."
        ),
        Diagnostic::GravityUnusual { gravity_mps2 } => {
            format!(
                "gravity is given as {gravity_mps2} m/s². The results are in the unit that makes this true."
            )
        }
        Diagnostic::SensorChanged { change: found, coldest_c, hottest_c } => {
            change(found, coldest_c.zip(*hottest_c))
        }
        _ => return of_holds(diagnostic).or_else(|| of_faces(diagnostic)),
    })
}

fn of_holds(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::HoldLeftOut { hold, why } => format!("{hold} is not used: {why}"),
        Diagnostic::HoldsLeftOutInARow { holds, start_s, end_s } => format!(
            "the {holds} consecutive holds from {start_s:.1} to {end_s:.1} s are not used. This is not by chance: the sensor changed there, or it was not at rest. \
             Calibrate these holds separately (holds.intervals_s), and compare."
        ),
        Diagnostic::HoldBeyondRecording {
            hold,
            start_s,
            end_s,
            recording_start_s,
            recording_end_s,
            common_s,
        } => format!(
            "hold {hold} is given from {start_s} to {end_s} s, but the recording lasts from {recording_start_s} to {recording_end_s} s. Only {common_s:.1} s of the hold count. Correct holds.intervals_s."
        ),
        Diagnostic::HoldsLostToFilter { lost } => lost.to_string(),
        Diagnostic::HoldsSpreadLittle { condition_number, parameters } => format!(
            "the directions of the holds are too similar (condition number {condition_number:.0}). The data hardly separate {}. Add holds in other directions.",
            parameters.join(", ")
        ),
        Diagnostic::HoldsScatter { between_holds_sd_mps2 } => format!(
            "the holds scatter by {:.0} mm/s² beyond their noise. Look for movement, drift, saturation, or a force other than gravity.",
            1e3 * between_holds_sd_mps2
        ),
        Diagnostic::OrientationMissing { missing } => {
            let missing: Vec<String> = missing.iter().map(pointing).collect();
            format!("no hold has {}. Add one.", missing.join(" or "))
        }
        Diagnostic::NothingToCheck { holds: Some(holds), parameters } => format!(
            "{holds} holds for {parameters} parameters leave no data to check the fit. The standard deviations come from the noise within the holds \
             alone, and are too small. Add holds."
        ),
        Diagnostic::FewDegreesOfFreedom { degrees_of_freedom } => format!(
            "the recording has only {} than parameters. The standard deviations themselves are uncertain by about {:.0} %. Add holds.",
            match degrees_of_freedom {
                1 => "one hold more".to_owned(),
                more => format!("{more} holds more"),
            },
            100.0 / (2.0 * *degrees_of_freedom as f64).sqrt()
        ),
        Diagnostic::NoiseNotAsGiven { sensor_kind: SensorKind::Accelerometer, axis, ratio } => format!(
            "the noise within the holds is {} times the noise in the experiment file (axis {axis}). The noise of the recording is used.",
            times(*ratio)
        ),
        Diagnostic::NoiseNotAsGiven { sensor_kind: SensorKind::Gyroscope, axis, ratio } => format!(
            "the gyroscope scatters within the holds by {} times the given noise (axis {axis}). Check the noise and its unit.",
            times(*ratio)
        ),
        Diagnostic::ParameterImplausible { parameter, deviations } => format!(
            "{parameter} is {deviations:.0} standard deviations of the datasheet from its nominal value. Check the unit of the recording, gravity, and the order and \
             direction of the axes."
        ),
        _ => return None,
    })
}

fn of_faces(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::FacesTurned { faces } => {
            let faces: Vec<String> = faces.iter().map(ToString::to_string).collect();
            format!(
                "{}. All directions are rotated in the same way. Correct them, unless the sensor is mounted that way: the results are in the frame of the given directions.",
                faces.join("; ")
            )
        }
        Diagnostic::FaceBrief { hold, samples } => {
            format!(
                "{hold} has only {samples} samples. A face is held for seconds. Check the times of the hold."
            )
        }
        Diagnostic::FacesScatter { tilt_rad, along_mps2, worst_rad, worst } => {
            let worst: Vec<String> = worst.iter().map(ToString::to_string).collect();
            format!(
                "beyond their noise, the faces scatter by {:.1}° in direction and by {along_mps2:.2} m/s² along gravity. The largest error is {:.1}°, in {}. Check the directions and the times of the holds.",
                tilt_rad.to_degrees(),
                worst_rad.to_degrees(),
                worst.join(", or ")
            )
        }
        Diagnostic::TiltContradicted { shown_rad, given_rad } => {
            let (by, remedy) = if shown_rad > given_rad {
                ("by", "The standard deviations are too small. Correct holds.face_sd_deg.")
            } else {
                (
                    "by only",
                    "The standard deviations are too large. Remove the key: the scatter of the faces then gives the value.",
                )
            };
            format!(
                "the faces scatter {by} {:.2}° about each axis, but holds.face_sd_deg says {:.2}°. {remedy}",
                shown_rad.to_degrees(),
                given_rad.to_degrees()
            )
        }
        Diagnostic::TiltAssumed { faces, tilt_rad } => format!(
            "{faces} faces are too few to estimate the face alignment. The program assumes {:.1}° about each axis. Add faces, or give holds.face_sd_deg.",
            tilt_rad.to_degrees()
        ),
        _ => return None,
    })
}

fn pointing(face: &FacePointing) -> String {
    format!("the {} axis pointing {}", face.axis, if face.is_up { "up" } else { "down" })
}

/// Coarse steps of an axis in words: `the readings of axis x of the gyroscope come in steps of …`.
#[must_use]
pub fn coarse_axis(sensor_kind: SensorKind, unit: ReadingUnit, found: &CoarseAxis) -> String {
    let unit = unit.symbol();
    let noise = if found.noise > 0.0 {
        format!("the noise of about {:.1e} {unit}", found.noise)
    } else {
        "the noise, which hardly shows".to_owned()
    };
    format!(
        "the readings of axis {} of the {} come in steps of {:.3e} {unit}, more than twice {noise}. The mean of a hold has an error of about {:.1e} {unit}, however \
         long the hold is.",
        found.axis,
        sensor_kind.name(),
        found.step,
        found.mean_sd
    )
}
