//! The keys of Kalibr's `imu.yaml` and of its relatives.

use super::words::invalid;
use calibrant_recording::text::decoding::Checked;
use serde_json::Value;

/// The keys of an IMU, and those below its sensors, which Kalibr, calibrant and other programs write.
const KEYS: [(&str, &[&str]); 3] = [
    (
        "",
        &[
            "model",
            "T_i_b",
            "accelerometer_noise_density",
            "accelerometer_random_walk",
            "gyroscope_noise_density",
            "gyroscope_random_walk",
            "update_rate",
            "rostopic",
            "time_offset",
            "accelerometers",
            "gyroscopes",
            "calibrant",
        ],
    ),
    ("accelerometers", &["M", "b", "rx_i", "ry_i", "rz_i"]),
    ("gyroscopes", &["M", "b", "A", "C_gyro_i"]),
];

/// Refuses numbers under a key that is not known: without them the correction could be another.
pub(super) fn refuse_unknown_numbers(text: &str) -> Checked<()> {
    // what is no YAML was refused before
    let Ok(Value::Object(mut keys)) = serde_saphyr::from_str(text) else { return Ok(()) };
    let imu = keys.keys().find(|key| key.starts_with("imu")).cloned();
    if let Some(Value::Object(below)) = imu.and_then(|imu| keys.remove(&imu)) {
        keys = below;
    }
    for (part, known) in KEYS {
        let below = if part.is_empty() { Some(&keys) } else { keys.get(part).and_then(Value::as_object) };
        let holds_numbers =
            |value: &Value| matches!(value, Value::Array(_) | Value::Object(_)) && has_number(value);
        let is_unknown =
            |(key, value): &(&String, &Value)| !known.contains(&key.as_str()) && holds_numbers(value);
        if let Some((key, _)) = below.into_iter().flatten().find(is_unknown) {
            let place = if part.is_empty() { key.clone() } else { format!("{part}.{key}") };
            return Err(invalid(
                format!("`{place}` has numbers, and this program does not know what they mean"),
                "biases are `b` beside `M`: y = M C s + b, in the unit of the readings. Rename it to what it is; remove \
                 it if no correction needs it",
            ));
        }
    }
    Ok(())
}

fn has_number(value: &Value) -> bool {
    match value {
        Value::Number(_) => true,
        Value::Array(values) => values.iter().any(has_number),
        Value::Object(entries) => entries.values().any(has_number),
        _ => false,
    }
}
