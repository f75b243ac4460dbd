//! The presets: commented experiment files to start from.

/// The presets: name, and the text of the experiment file.
pub const PRESETS: &[(&str, &str)] = &[
    ("report", include_str!("../presets/report.toml")),
    ("report-unknown", include_str!("../presets/report-unknown.toml")),
    ("report-noisy", include_str!("../presets/report-noisy.toml")),
    ("stage", include_str!("../presets/stage.toml")),
    ("static-poses", include_str!("../presets/static-poses.toml")),
    ("faces", include_str!("../presets/faces.toml")),
    ("static-poses-counts", include_str!("../presets/static-poses-counts.toml")),
    ("imu", include_str!("../presets/imu.toml")),
    ("imu-counts", include_str!("../presets/imu-counts.toml")),
    ("ferraris", include_str!("../presets/ferraris.toml")),
    ("arm", include_str!("../presets/arm.toml")),
    ("rate-table", include_str!("../presets/rate-table.toml")),
    ("gantry", include_str!("../presets/gantry.toml")),
    ("mocap", include_str!("../presets/mocap.toml")),
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
    PRESETS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
