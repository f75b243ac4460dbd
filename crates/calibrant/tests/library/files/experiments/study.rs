//! Cases of a broken `[study]` and its subsections, with their messages.

use super::Case;

/// The broken studies of an experiment with a motion.
pub(super) const CASES: &[Case] = &[
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study]⏎motions = 0"#,
        "line 17, column 11: `study.motions`: 0 is out of range (a whole number from 1 to 10000000)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study]⏎starts = 0"#,
        "line 17, column 10: `study.starts`: 0 is out of range (a whole number from 1 to 1000000)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study]⏎surface = 3"#,
        "line 17, column 11: `study.surface`: a table is needed here, not a whole number (write [study.surface] on a line of its own, its keys below)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study.unknwon]"#,
        "line 16, column 8: `study.unknwon`: unknown key (did you mean `unknown`?)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study.surface]⏎pionts = 3"#,
        "line 17, column 1: `study.surface.pionts`: unknown key (did you mean `points`?)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study.surface]⏎points = 1"#,
        "line 17, column 10: `study.surface.points`: 1 is out of range (a whole number from 2 to 1001)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study.surface]⏎jerk_mps3 = 0.0"#,
        "line 17, column 13: `study.surface.jerk_mps3`: 0.0 is out of range (a number above 0 m/s³, at most 1e9 m/s³)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study.surface]⏎start_acceleration_mps2 = inf"#,
        "line 17, column 27: `study.surface.start_acceleration_mps2`: a finite number is needed here (a number from -1e9 m/s², at most 1e9 m/s²)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study.surface]⏎interval_s = -1.0"#,
        "line 17, column 14: `study.surface.interval_s`: -1.0 is out of range (a number above 0 s, at most 1e6 s)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study.unknown]⏎sensors = 0"#,
        "line 17, column 11: `study.unknown.sensors`: 0 is out of range (a whole number from 1 to 10000000)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study.unknown]⏎rate_hz = 0.01"#,
        "line 17, column 11: `study.unknown.rate_hz`: the motion lasts 10 s, less than one sample step of 100 s (raise the rate, or lengthen the motion)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study.unknown]⏎acceleration_mps2 = -1.0"#,
        "line 17, column 21: `study.unknown.acceleration_mps2`: -1.0 is out of range (a number above 0 m/s², at most 1e9 m/s²)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study.noisy]⏎jerk_mps3 = 20.0"#,
        "line 16, column 1: `study.noisy.input_noise`: this required key is missing (write input_noise = { floor_mps3 = 0.01, ratio = 0.01 })",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study.noisy]⏎input_noise = { floor_mps3 = 0.01, ratio = -0.01 }"#,
        "line 17, column 44: `study.noisy.input_noise.ratio`: -0.01 is out of range (a number from 0, at most 1000)",
    ),
];

/// The broken studies of an experiment with holds.
pub(super) const HOLDS_CASES: &[Case] = &[(
    r#"gauge = "upper""#,
    r#"gauge = "upper"⏎[study.surface]"#,
    "line 12, column 1: `study.surface`: this needs a [motion] (take it out, or describe a motion)",
)];
