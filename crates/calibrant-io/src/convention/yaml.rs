//! What the writers of Kalibr's `imu.yaml` and of its relatives share: numbers, matrices, noise, and our own key.

use super::imu_noise::ImuNoise;
use calibrant_core::diagnostic::Phrase;
use calibrant_core::sensor::{CalibratedImu, SensorKind};
use nalgebra::Matrix3;
use std::fmt::Write;

/// The topic that is written where none is known.
const TOPIC: &str = "/imu0";

/// How to give what the noise lacks.
pub(super) fn how() -> Phrase {
    Phrase("give an imu.yaml or a noise.json with the densities with option `noise`, the topic with option `rostopic`, the rate with option `update_rate`".into())
}

/// The lines of noise, rate and topic; returns what is missing.
pub(super) fn noise(out: &mut String, noise: &ImuNoise, program: &str) -> Vec<String> {
    let mut absent = Vec::new();
    for (name, value) in noise.fields() {
        match value {
            Some(value) => put(out, format_args!("  {name}: {}\n", number(value))),
            None => {
                let known = match noise.limit(name) {
                    Some(limit) => format!("not determined, at most {}", number(limit)),
                    None => "not known".into(),
                };
                put(out, format_args!("  # {name}: {known}, and {program} needs it\n"));
                absent.push(name.to_owned());
            }
        }
    }
    match &noise.rostopic {
        Some(topic) => put(out, format_args!("  rostopic: {}\n", quoted(topic))),
        None => {
            put(out, format_args!("  rostopic: {TOPIC} # a placeholder\n"));
            absent.push(format!("rostopic ({TOPIC} stands in its place)"));
        }
    }
    absent
}

/// Where what the format has no place for is kept.
pub(super) const UNDER_OWN_KEY: &str = "under the key `calibrant`, which only calibrant reads";

/// Our own key, with what the format has no place for; with the biases of these sensors.
pub(super) fn beside(out: &mut String, imu: &CalibratedImu, has_bias: impl Fn(SensorKind) -> bool) {
    out.push_str("  calibrant: # for calibrant alone\n");
    for (sensor_kind, unit) in imu.units.present() {
        put(out, format_args!("    {sensor_kind}_unit: {}\n", unit.symbol()));
        if has_bias(sensor_kind) {
            bias(out, &format!("    {sensor_kind}_bias: "), imu, sensor_kind);
        }
    }
    put(out, format_args!("    frame: {}\n", quoted(&imu.frame)));
}

/// The bias of a sensor, in a line that begins like this.
pub(super) fn bias(out: &mut String, before: &str, imu: &CalibratedImu, sensor_kind: SensorKind) {
    let bias: Vec<f64> = imu.parameters.sensor(sensor_kind).bias.iter().copied().collect();
    line(out, before, &bias);
}

/// A matrix under a key, whose rows begin like this.
pub(super) fn matrix(out: &mut String, (key, before): (&str, &str), matrix: &Matrix3<f64>) {
    put(out, format_args!("{key}:\n"));
    for row in matrix.row_iter() {
        line(out, before, &row.iter().copied().collect::<Vec<_>>());
    }
}

/// A list of numbers in a line that begins like this.
pub(super) fn line(out: &mut String, before: &str, values: &[f64]) {
    let values: Vec<_> = values.iter().map(|&value| number(value)).collect();
    put(out, format_args!("{before}[{}]\n", values.join(", ")));
}

/// Adds to a text.
pub(super) fn put(out: &mut String, text: std::fmt::Arguments<'_>) {
    // writing into memory does not fail
    let _ = out.write_fmt(text);
}

/// A number in a form that YAML 1.1 takes, too: with a point, and a sign in the exponent. YAML 1.1 reads
/// `1e-7` as a word.
pub(super) fn number(value: f64) -> String {
    let text = format!("{value:?}");
    let Some((mantissa, exponent)) = text.split_once('e') else { return text };
    let point = if mantissa.contains('.') { "" } else { ".0" };
    let sign = if exponent.starts_with('-') { "" } else { "+" };
    format!("{mantissa}{point}e{sign}{exponent}")
}

/// A word in double quotes, with JSON's escapes, which are also YAML's.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_are_numbers_in_every_yaml() {
        for (value, text) in
            [(1e-7, "1.0e-7"), (1.5e-9, "1.5e-9"), (1e20, "1.0e+20"), (-0.25, "-0.25"), (3.0, "3.0")]
        {
            assert_eq!(number(value), text);
        }
    }
}
