//! The readings of a recording over time, with what is at rest, for a page.

use crate::figure::rest_and_motion;
use crate::sheet::Section;
use calibrant_core::estimate::RefusedRest;
use calibrant_core::motion::Hold;
use calibrant_core::sensor::ImuRecording;

/// A figure for each sensor: its readings, the holds, and the rests that are none, with the reason.
pub fn timeline_section<'a>(
    recording: &'a ImuRecording,
    holds: &'a [Hold],
    refused: Vec<RefusedRest>,
) -> Section<'a> {
    let mut section = Section::on_page("Timeline");
    for (sensor_kind, of) in recording.sensors() {
        let refused = refused.clone();
        section.figure(move || Some(rest_and_motion(sensor_kind, holds, &refused, of)));
    }
    section
}
