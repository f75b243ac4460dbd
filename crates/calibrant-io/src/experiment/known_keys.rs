//! The keys that an experiment file may have: one list, which decides what is unknown and what is suggested.

/// Each section and its keys; the first is the top of the file.
const KEYS: &[(&str, &[&str])] = &[
    (
        "",
        &[
            "schema",
            "sensor",
            "motion",
            "holds",
            "machine",
            "gyroscope",
            "known",
            "temperature",
            "columns",
            "calibrate",
            "accept",
            "limits",
            "design",
            "study",
        ],
    ),
    (
        "sensor",
        &[
            "kind",
            "axes",
            "model",
            "unit",
            "gain_counts_per_mps2",
            "offset_counts",
            "noise_mps2",
            "noise_counts",
            "bias_sd_mps2",
            "scale_sd",
            "cross_axis_sd",
            "range_mps2",
        ],
    ),
    (
        "motion",
        &[
            "intervals",
            "interval_s",
            "rate_hz",
            "trust",
            "known_ends",
            "input_noise",
            "gravity",
            "gravity_mps2",
            "gravity_sd_mps2",
            "latitude_deg",
            "height_m",
            "tilt_sd_deg",
        ],
    ),
    ("motion.input_noise", &["floor_mps3", "ratio"]),
    (
        "holds",
        &[
            "gravity_mps2",
            "gravity_sd_mps2",
            "latitude_deg",
            "height_m",
            "gauge",
            "intervals_s",
            "directions",
            "face_sd_deg",
            "bias_drift_sd_mps2",
            "between_holds_sd_mps2",
            "minimum_hold_s",
            "poses",
            "hold_s",
            "rate_hz",
        ],
    ),
    (
        "machine",
        &[
            "urdf",
            "base",
            "tip",
            "packages",
            "trust",
            "up",
            "gravity_mps2",
            "gravity_sd_mps2",
            "latitude_deg",
            "height_m",
            "tilt_sd_deg",
            "sensor_noise",
            "mount",
            "clock",
            "geometry",
            "log",
            "simulate",
        ],
    ),
    ("machine.mount", &["lever_m", "lever_sd_m", "rotation", "rotation_sd_deg"]),
    ("machine.clock", &["delay_s", "delay_sd_s", "delay_difference_sd_s", "rate_sd_ppm"]),
    ("machine.geometry", &["translation_sd_m", "rotation_sd_rad", "zero_sd"]),
    ("machine.log", &["noise", "position_noise_m", "orientation_noise_rad", "knot_step_s", "topic"]),
    (
        "machine.simulate",
        &["duration_s", "rate_hz", "log_rate_hz", "acceleration", "resolution", "vibration"],
    ),
    (
        "gyroscope",
        &[
            "unit",
            "model",
            "gain_counts_per_radps",
            "noise_radps",
            "noise_counts",
            "g_sensitivity",
            "turns",
            "turn_angle_deg",
            "turn_sd_deg",
        ],
    ),
    ("gyroscope.turns", &["start_s", "end_s", "axis", "angle_deg", "angle_sd_deg"]),
    ("known.term", &["value", "sd"]),
    (
        "temperature",
        &["reference_c", "accelerometer_bias", "accelerometer_scale", "gyroscope_bias", "gyroscope_scale"],
    ),
    (
        "columns",
        &[
            "format",
            "time",
            "time_unit",
            "times",
            "rate_hz",
            "rate_sd_ppm",
            "accelerometer",
            "accelerometer_unit",
            "gyroscope",
            "gyroscope_unit",
            "temperature",
            "topic",
        ],
    ),
    ("calibrate", &["prior"]),
    ("accept.limit", &["range", "sd"]),
    (
        "limits",
        &[
            "acceleration_mps2",
            "jerk_mps3",
            "intercept_mps2",
            "velocity_mps",
            "displacement_m",
            "rest",
            "start_acceleration_mps2",
            "end_acceleration_mps2",
        ],
    ),
    (
        "design",
        &[
            "criterion",
            "weights",
            "range_mps2",
            "scale_by",
            "starts",
            "seed",
            "certificate",
            "directions",
            "allowed",
            "within_deg",
        ],
    ),
    ("study", &["sensors", "seed", "motions", "starts", "surface", "unknown", "noisy"]),
    ("study.surface", &["jerk_mps3", "points", "start_acceleration_mps2", "interval_s", "rate_hz"]),
    (
        "study.unknown",
        &[
            "sensors",
            "intervals",
            "interval_s",
            "rate_hz",
            "detail_rate_hz",
            "acceleration_mps2",
            "jerk_mps3",
            "intercept_mps2",
            "velocity_mps",
            "displacement_m",
            "rest",
            "start_acceleration_mps2",
            "end_acceleration_mps2",
        ],
    ),
    (
        "study.noisy",
        &[
            "input_noise",
            "acceleration_mps2",
            "jerk_mps3",
            "intercept_mps2",
            "velocity_mps",
            "displacement_m",
            "rest",
            "start_acceleration_mps2",
            "end_acceleration_mps2",
        ],
    ),
    ("study.noisy.input_noise", &["floor_mps3", "ratio"]),
];

/// The keys of a section.
pub(super) fn allowed(section: &str) -> &'static [&'static str] {
    KEYS.iter().find(|(name, _)| *name == section).map_or(&[], |(_, keys)| keys)
}

/// The help for an unknown key: the section where it belongs, the nearest key, or all keys.
pub(super) fn suggest(section: &str, unknown: &str) -> String {
    let unknown = shorten(unknown);
    let near = nearest(&unknown, allowed(section).iter().copied());
    if let Some(key) = near.filter(|key| strsim::damerau_levenshtein(key, &unknown) <= 2) {
        return format!("did you mean `{key}`?");
    }
    if let Some((home, _)) =
        KEYS.iter().find(|(name, keys)| *name != section && keys.contains(&unknown.as_str()))
    {
        return if home.is_empty() {
            format!("`{unknown}` belongs at the top of the file, before the first [section]")
        } else {
            format!("`{unknown}` belongs in [{home}]")
        };
    }
    match near {
        Some(key) => format!("did you mean `{key}`?"),
        None => format!("the keys here are {}", allowed(section).join(", ")),
    }
}

/// The word most like this one, if any is.
#[must_use]
pub fn nearest<'w>(unknown: &str, words: impl Iterator<Item = &'w str>) -> Option<&'w str> {
    const ALIKE: f64 = 0.75; // least Jaro–Winkler similarity: 1 is equal, 0 nothing in common
    let unknown = shorten(unknown).to_lowercase();
    words
        .map(|word| (strsim::jaro_winkler(&word.to_lowercase(), &unknown), word))
        .filter(|(alike, _)| *alike >= ALIKE)
        .max_by(|one, other| one.0.total_cmp(&other.0))
        .map(|(_, word)| word)
}

/// The beginning of a text that may be very long.
pub(crate) fn shorten(text: &str) -> String {
    /// Longest shortened text, characters.
    const LONGEST: usize = 60;
    if text.chars().count() <= LONGEST {
        return text.to_owned();
    }
    text.chars().take(LONGEST).chain(['…']).collect()
}
