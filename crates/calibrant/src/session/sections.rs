//! What is known of the recording of an IMU: by the experiment, and by a list of sections.

use super::source::Source;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::settings::SettingUnused;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::{ImuSetup, Turn};
use calibrant_core::sensor::{ImuRecording, SensorKind};
use calibrant_io::{HoldsPlan, ImuPlan, Section, SectionKind};

/// The setup of this recording.
pub(crate) fn setup_of(
    plan: &ImuPlan,
    holds: &HoldsPlan,
    source: &Source,
    recording: &ImuRecording,
    notes: &mut Vec<Diagnostic>,
) -> Result<ImuSetup> {
    let mut setup = plan.setup(holds)?;
    if let Some(list) = &source.sections {
        let times =
            recording[SensorKind::Accelerometer].as_ref().map_or(&[][..], |recording| recording.times_s());
        let (sections, path) = list.read()?;
        if let Some(late) = sections.iter().find(|section| section.end > times.len()) {
            let message = format!("a section ends at sample {}, the recording at {}", late.end, times.len());
            let input_error = InputError::new(
                Refusal::RecordingsUnlike,
                message,
                "are the list and the recording of one session?",
            );
            return Err(Error::experiment(input_error.in_file(path)));
        }
        if setup.holds.intervals_s.is_some() {
            let keys = ["holds.intervals_s", "holds.directions"];
            notes.push(SettingUnused::of(&keys, "the list of sections gives the faces").into());
        }
        take_sections(&mut setup, &sections, times, plan);
    }
    if setup.directions.is_none() {
        notes.extend(unused_face_sd(setup.face_sd_rad));
    }
    Ok(setup)
}

/// The warning about a face alignment where no directions are given.
pub(crate) fn unused_face_sd(face_sd_rad: Option<f64>) -> Option<Diagnostic> {
    let unused = |_| SettingUnused::of(&["holds.face_sd_deg"], "no directions of the holds are given").into();
    face_sd_rad.map(unused)
}

/// Faces and turns from a list of sections.
fn take_sections(setup: &mut ImuSetup, sections: &[Section], times: &[f64], plan: &ImuPlan) {
    let (mut intervals, mut directions) = (Vec::new(), Vec::new());
    for section in sections {
        let (start_s, end_s) = (times[section.start], times[section.end - 1]);
        match section.kind {
            SectionKind::Face(direction) => {
                intervals.push((start_s, end_s));
                directions.push(direction);
            }
            SectionKind::Turn(axis) => setup.turns.push(Turn {
                name: Some(section.name.clone()),
                start_s,
                end_s,
                axis,
                angle_rad: plan.section_angle_rad,
                angle_sd_rad: plan.section_angle_sd_rad,
                axis_sd_rad: None,
            }),
        }
    }
    setup.holds.intervals_s = Some(intervals);
    setup.directions = Some(directions);
}
