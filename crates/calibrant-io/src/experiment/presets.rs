//! The presets: commented experiment files to start from.

/// A commented experiment file to start from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Preset {
    /// Its name, for `calibrant init`.
    pub name: &'static str,
    /// What it is for, in one line.
    pub summary: &'static str,
    /// The text of the experiment file.
    pub text: &'static str,
}

/// A preset, whose text is in the file of its name.
macro_rules! preset {
    ($name:literal, $summary:literal) => {
        Preset {
            name: $name,
            summary: $summary,
            text: include_str!(concat!("../../presets/", $name, ".toml")),
        }
    };
}

/// All presets.
pub const PRESETS: &[Preset] = &[
    preset!("report", "accelerometer on an arm, its motion known exactly"),
    preset!("report-unknown", "accelerometer on an arm, only the ends of its motion known"),
    preset!("report-noisy", "accelerometer on an arm, motion known up to process noise"),
    preset!("stage", "accelerometer on a linear stage, from rest to rest"),
    preset!("static-poses", "accelerometer held by hand, in two dozen orientations"),
    preset!("faces", "accelerometer on faces of known direction, 12 parameters"),
    preset!("static-poses-counts", "accelerometer held still by hand, in counts of unknown gain"),
    preset!("imu", "whole IMU, held and rotated by hand"),
    preset!("imu-counts", "whole IMU, held and rotated by hand, in unknown counts"),
    preset!("ferraris", "whole IMU, six faces and three turns, in a list of sections"),
    preset!("campaign", "whole IMU over temperature, in a chamber or a freezer"),
    preset!("arm", "whole IMU on a robot arm, with the log of its joints"),
    preset!("rate-table", "whole IMU on a rate table, with the log of its joints"),
    preset!("gantry", "accelerometer on a gantry, with the log of its axes"),
    preset!("mocap", "whole IMU moved by hand, with the log of a tracker"),
];

/// The text of the preset of this name.
///
/// # Examples
/// ```
/// assert!(calibrant_io::preset("static-poses").expect("known").contains("[holds]"));
/// assert!(calibrant_io::preset("nonsense").is_none());
/// ```
#[must_use]
pub fn preset(name: &str) -> Option<&'static str> {
    PRESETS.iter().find(|preset| preset.name == name).map(|preset| preset.text)
}
