//! Machines to start from.

/// The machines that are built in: name, and the text of the URDF file.
pub const MACHINE_PRESETS: &[(&str, &str)] = &[
    ("arm", include_str!("../../presets/machines/arm.urdf")),
    ("rate-table", include_str!("../../presets/machines/rate-table.urdf")),
    ("gantry", include_str!("../../presets/machines/gantry.urdf")),
];

/// The URDF text of the machine of this name.
///
/// # Examples
/// ```
/// assert!(calibrant_io::machine_preset("gantry").expect("known").contains("prismatic"));
/// assert!(calibrant_io::machine_preset("nonsense").is_none());
/// ```
#[must_use]
pub fn machine_preset(name: &str) -> Option<&'static str> {
    MACHINE_PRESETS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
