//! What is said of holds, faces and recordings.

use super::change::change;
use super::spikes::spikes;
use calibrant_core::diagnostic::{Diagnostic, FacePointing};
use calibrant_core::estimate::CoarseAxis;
use calibrant_core::sensor::{ReadingUnit, SensorKind};

pub(super) fn message(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::NotConverged { status } => format!(
            "the iteration did not converge ({status}): the numbers are the best found, not the optimum"
        ),
        Diagnostic::Spikes { sensor_kind, unit, replaced, cut, axis, reading, time_s, deviations } => {
            spikes(*sensor_kind, *unit, (*replaced, *cut), *axis, (*reading, *time_s, *deviations))
        }
        Diagnostic::CoarseSteps { sensor_kind, axis, unit, step, noise, mean_sd } => {
            let found = CoarseAxis { axis: *axis, step: *step, noise: *noise, mean_sd: *mean_sd };
            let found = coarse_axis(*sensor_kind, *unit, &found);
            let known = match sensor_kind {
                SensorKind::Accelerometer => "",
                SensorKind::Gyroscope => "the standard deviations know of it; ",
            };
            format!("{found}; {known}choose a smaller range, or more digits in the file")
        }
        Diagnostic::GravityOffEarth { gravity_mps2, least_mps2, most_mps2 } => format!(
            "gravity is given as {gravity_mps2} m/s², and on the Earth's surface it is {least_mps2} to {most_mps2}: correct holds.gravity_mps2, or all gains of the accelerometer are off by as much"
        ),
        Diagnostic::GravityUnusual { gravity_mps2 } => {
            format!("gravity is given as {gravity_mps2} m/s²: results are in that unit")
        }
        Diagnostic::SensorChanged { change: found, coldest_c, hottest_c } => {
            change(found, coldest_c.zip(*hottest_c))
        }
        _ => return of_holds(diagnostic).or_else(|| of_faces(diagnostic)),
    })
}

fn of_holds(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::HoldLeftOut { hold, why } => format!("{hold} was left out: {why}"),
        Diagnostic::HoldsLeftOutInARow { holds, start_s, end_s } => format!(
            "the {holds} holds from {start_s:.1} to {end_s:.1} s were left out one after another, which is no chance: the sensor was another one there, or not still; calibrate them apart \
             (holds.intervals_s) and compare"
        ),
        Diagnostic::HoldBeyondRecording {
            hold,
            start_s,
            end_s,
            recording_start_s,
            recording_end_s,
            common_s,
        } => format!(
            "hold {hold} is given from {start_s} to {end_s} s, and the recording goes from {recording_start_s} to {recording_end_s} s: only {common_s:.1} s of it count; correct holds.intervals_s"
        ),
        Diagnostic::HoldsLostToFilter { lost } => lost.to_string(),
        Diagnostic::HoldsSpreadLittle { condition_number, parameters } => format!(
            "the holds do not spread enough (condition number {condition_number:.0}): {} can hardly be told apart",
            parameters.join(", ")
        ),
        Diagnostic::HoldsScatter { between_holds_sd_mps2 } => format!(
            "the holds scatter by {:.0} mm/s² beyond their noise: something moves, drifts, clips or is not gravity",
            1e3 * between_holds_sd_mps2
        ),
        Diagnostic::OrientationMissing { missing } => {
            let missing: Vec<String> = missing.iter().map(pointing).collect();
            format!("no hold has {}: add one there", missing.join(" or "))
        }
        Diagnostic::NothingToCheck { holds: Some(holds), parameters } => format!(
            "{holds} holds for {parameters} parameters leave nothing to check the fit with: the standard deviations rest on the noise within the holds \
             alone and are too small; add holds"
        ),
        Diagnostic::FewDegreesOfFreedom { degrees_of_freedom } => format!(
            "only {} than parameters: the standard deviations themselves are known to about {:.0} %",
            match degrees_of_freedom {
                1 => "one hold more".to_owned(),
                more => format!("{more} holds more"),
            },
            100.0 / (2.0 * *degrees_of_freedom as f64).sqrt()
        ),
        Diagnostic::NoiseNotAsGiven { sensor_kind: SensorKind::Accelerometer, axis, ratio } => format!(
            "the noise of axis {axis} within the holds is {ratio:.2} times the one in the experiment file (not used: the \
             recording's own is)"
        ),
        Diagnostic::NoiseNotAsGiven { sensor_kind: SensorKind::Gyroscope, axis, ratio } => format!(
            "the scatter of the gyroscope's axis {axis} within the holds is {ratio:.2} times the noise that was given"
        ),
        Diagnostic::ParameterImplausible { parameter, deviations } => format!(
            "{parameter} is {deviations:.0} datasheet standard deviations from its nominal value: check the unit of the recording, gravity, the order and \
             the direction of the axes"
        ),
        _ => return None,
    })
}

fn of_faces(diagnostic: &Diagnostic) -> Option<String> {
    Some(match diagnostic {
        Diagnostic::FacesTurned { faces } => {
            let faces: Vec<String> = faces.iter().map(ToString::to_string).collect();
            format!(
                "{}: all directions are turned alike; correct them, unless the sensor is mounted so that its axes are not those of the directions, whose frame all results are in",
                faces.join("; ")
            )
        }
        Diagnostic::FaceBrief { hold, samples } => {
            format!("{hold} has {samples} samples only: are its times right? A face is held for seconds")
        }
        Diagnostic::FacesScatter { tilt_rad, along_mps2, worst_rad, worst } => {
            let worst: Vec<String> = worst.iter().map(ToString::to_string).collect();
            format!(
                "the faces scatter by {:.1}° and {along_mps2:.2} m/s² along gravity beyond their noise; by {:.1}° and least of all fits {}: are directions and times of the holds right?",
                tilt_rad.to_degrees(),
                worst_rad.to_degrees(),
                worst.join(", or ")
            )
        }
        Diagnostic::TiltContradicted { shown_rad, given_rad } => {
            let [by, so] = match shown_rad > given_rad {
                true => ["by", "the standard deviations are too small"],
                false => [
                    "by only",
                    "the standard deviations are too large; leave the key out, and the scatter of the faces tells it",
                ],
            };
            format!(
                "the faces scatter {by} {:.2}° about each axis, and holds.face_sd_deg says {:.2}°: {so}",
                shown_rad.to_degrees(),
                given_rad.to_degrees()
            )
        }
        Diagnostic::TiltAssumed { faces, tilt_rad } => format!(
            "{faces} faces are too few to tell how well they were met: {:.1}° about each axis is assumed; add faces, or give holds.face_sd_deg",
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
        format!("its noise of about {:.1e} {unit}", found.noise)
    } else {
        "its noise, which hardly shows".to_owned()
    };
    format!(
        "the readings of axis {} of the {} come in steps of {:.3e} {unit}, coarser than twice {noise}: the mean of a hold is off by about {:.1e} {unit} however \
         long it is",
        found.axis,
        sensor_kind.name(),
        found.step,
        found.mean_sd
    )
}
