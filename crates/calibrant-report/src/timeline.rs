//! The readings of a recording over time, with what is at rest, for a page.

use crate::figure::rest_and_motion;
use crate::sheet::Section;
use calibrant_core::estimate::refused_rests;
use calibrant_core::motion::Hold;
use calibrant_core::sensor::{ImuRecording, SensorKind};

/// A figure for each sensor: its readings, the holds of at least this duration, and the rests that are none, with the reason.
pub fn timeline_section<'a>(recording: &'a ImuRecording, holds: &'a [Hold], minimum_s: f64) -> Section<'a> {
    let mut section = Section::on_page("Timeline");
    for (sensor_kind, of) in recording.sensors() {
        section.figure(move || {
            let accelerometer = recording.sensor(SensorKind::Accelerometer);
            let refused = accelerometer.map_or_else(Vec::new, |of| refused_rests(of, holds, minimum_s));
            Some(rest_and_motion(sensor_kind, holds, &refused, of))
        });
    }
    section
}
