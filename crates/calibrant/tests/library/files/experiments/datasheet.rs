//! Cases of unknown keys, a wrong schema and a broken `[sensor]`, with their messages.

use super::Case;

/// The broken datasheets.
pub(super) const CASES: &[Case] = &[
    (
        "schema = 1",
        "schema = 1234567890123456789012345678901234567890123456789012345678901234567890",
        "line 1, column 10: `schema`: 123456789012345678901234567890123456789012345678901234567890… is out of range \
         (a whole number from 0)",
    ),
    (
        "schema = 1⏎",
        "",
        "line 1, column 1: `schema`: this required key is missing (the first line of an experiment file is schema = 1)",
    ),
    (
        "schema = 1",
        "schema = 2",
        "line 1, column 10: `schema`: schema 2 is not known to this version (schema = 1)",
    ),
    (
        "schema = 1",
        r#"schema = "1""#,
        "line 1, column 10: `schema`: a whole number is needed here, not a string (write it without the quotes)",
    ),
    (
        "schema = 1",
        "schema =",
        "line 1, column 9: not valid TOML: string values must be quoted, expected literal string (see https://toml.io)",
    ),
    (
        "schema = 1",
        "schema = 1⏎noise_mps2 = 1.0",
        "line 2, column 1: `noise_mps2`: unknown key (`noise_mps2` belongs in [sensor])",
    ),
    (
        "interval_s = 1.0",
        "intervall_s = 1.0",
        "line 13, column 1: `motion.intervall_s`: unknown key (did you mean `interval_s`?)",
    ),
    (
        "interval_s = 1.0",
        "interval_s = 1.0⏎scale_sd = 0.1",
        "line 14, column 1: `motion.scale_sd`: unknown key (`scale_sd` belongs in [sensor])",
    ),
    ("[motion]", "[motoin]", "line 11, column 2: `motoin`: unknown key (did you mean `motion`?)"),
    (
        "[motion]",
        "[zebra]",
        "line 11, column 2: `zebra`: unknown key (the keys here are schema, sensor, motion, holds, machine, gyroscope, known, temperature, campaign, columns, calibrate, accept, limits, design, study)",
    ),
    (
        r#"kind = "accelerometer""#,
        r#"kind = "gyroscope""#,
        r#"line 4, column 8: `sensor.kind`: an accelerometer can be calibrated, alone or with a gyroscope (kind = "accelerometer", or "imu" for both)"#,
    ),
    (
        r#"kind = "accelerometer""#,
        r#"kind = "acelerometer""#,
        r#"line 4, column 8: `sensor.kind`: "acelerometer" is not known here (did you mean "accelerometer"? one of "accelerometer", "imu")"#,
    ),
    (
        "axes = 3",
        "axes = 2",
        "line 5, column 8: `sensor.axes`: 2 axes are not supported (axes = 3, or axes = 1 for a sensor of one axis)",
    ),
    (
        "axes = 3",
        "axes = 7",
        "line 5, column 8: `sensor.axes`: 7 axes are not supported (axes = 3, or axes = 1 for a sensor of one axis)",
    ),
    (
        r#"axes = 3⏎model = "scale-bias""#,
        r#"axes = 1⏎model = "full""#,
        r#"line 6, column 9: `sensor.model`: a sensor of one axis has no cross-axis terms (model = "scale-bias")"#,
    ),
    (
        "noise_mps2 = 2e-4⏎",
        "",
        "line 3, column 1: `sensor.noise_mps2`: this key is required with [motion] (noise_mps2 = 2e-4, for example: the noise of one sample)",
    ),
    (
        "noise_mps2 = 2e-4",
        "noise_mps2 = -2e-4",
        "line 7, column 14: `sensor.noise_mps2`: -0.0002 is out of range (a number from 1e-7 m/s², at most 1e6 m/s²)",
    ),
    (
        "noise_mps2 = 2e-4",
        "noise_mps2 = [1e-4, 2e-4]",
        "line 7, column 14: `sensor.noise_mps2`: 2 numbers for 3 axes (give one number for all axes, or one per axis)",
    ),
    (
        "noise_mps2 = 2e-4",
        r#"noise_mps2 = [1e-4, 2e-4, "x"]"#,
        "line 7, column 27: `sensor.noise_mps2[2]`: a number is needed here, not a string (a number from 1e-7 m/s², at most 1e6 m/s²)",
    ),
    (
        "noise_mps2 = 2e-4",
        "noise_mps2 = 2e-4⏎noise_counts = 3",
        r#"line 8, column 16: `sensor.noise_counts`: readings in m/s² have no counts (write unit = "counts" in [sensor], or leave this key away)"#,
    ),
    (
        "noise_mps2 = 2e-4",
        "noise_mps2 = 2e-4⏎noise_mps2 = 3",
        "line 8, column 1: the key `noise_mps2` is there twice (keep one of them)",
    ),
    (
        "[motion]",
        "motion = 3⏎[limits]",
        "line 11, column 1: `sensor.motion`: unknown key (`motion` belongs at the top of the file, before the first [section])",
    ),
];
