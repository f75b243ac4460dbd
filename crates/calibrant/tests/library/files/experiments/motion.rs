//! Cases of a broken `[motion]`, `[limits]`, `[design]` and `[study]`, with their messages.

use super::Case;

/// The broken motions, limits, designs and studies.
pub(super) const CASES: &[Case] = &[
    (
        "interval_s = 1.0⏎",
        "",
        "line 11, column 1: `motion.interval_s`: this required key is missing (the duration of an interval in seconds, for example interval_s = 1.0)",
    ),
    (
        "interval_s = 1.0",
        r#"interval_s = "1.0""#,
        "line 13, column 14: `motion.interval_s`: a number is needed here, not a string (write it without the quotes)",
    ),
    (
        "interval_s = 1.0",
        r#"interval_s = "a second""#,
        "line 13, column 14: `motion.interval_s`: a number is needed here, not a string (a number above 0 s, at most 1e6 s)",
    ),
    (
        "interval_s = 1.0",
        "interval_s = nan",
        "line 13, column 14: `motion.interval_s`: a finite number is needed here (a number above 0 s, at most 1e6 s)",
    ),
    (
        "interval_s = 1.0",
        "interval_s = -inf",
        "line 13, column 14: `motion.interval_s`: a finite number is needed here (a number above 0 s, at most 1e6 s)",
    ),
    (
        "interval_s = 1.0",
        "interval_s = 1e400",
        "line 13, column 14: `motion.interval_s`: a finite number is needed here (a number above 0 s, at most 1e6 s)",
    ),
    (
        "interval_s = 1.0",
        "interval_s = 0",
        "line 13, column 14: `motion.interval_s`: 0.0 is out of range (a number above 0 s, at most 1e6 s)",
    ),
    (
        "intervals = 10",
        "intervals = 10.0",
        "line 12, column 13: `motion.intervals`: a whole number is needed here, not a number with a decimal point (a whole number from 1 to 10000000)",
    ),
    (
        "intervals = 10",
        "intervals = -3",
        "line 12, column 13: `motion.intervals`: -3 is out of range (a whole number from 1 to 10000000)",
    ),
    (
        "intervals = 10",
        "intervals = 99999999999999999999",
        "line 12, column 13: `motion.intervals`: 99999999999999999999 is out of range (a whole number from 1 to 10000000)",
    ),
    (
        "intervals = 10",
        "intervals = 20_000_000",
        "line 12, column 13: `motion.intervals`: 20000000 is out of range (a whole number from 1 to 10000000)",
    ),
    (
        "rate_hz = 10.0",
        "rate_hz = 0.01",
        "line 14, column 11: `motion.rate_hz`: the motion lasts 10 s, less than one sample step of 100 s (raise the rate, or lengthen the motion)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "knwon""#,
        r#"line 15, column 9: `motion.trust`: "knwon" is not known here (did you mean "known"? one of "known", "noisy", "unknown")"#,
    ),
    (
        r#"trust = "known""#,
        "trust = true",
        r#"line 15, column 9: `motion.trust`: a string is needed here, not true or false (one of "known", "noisy", "unknown")"#,
    ),
    (
        r#"trust = "known""#,
        r#"trust = "noisy""#,
        r#"line 11, column 1: `motion.input_noise`: this required key is missing (trust "noisy" needs it: input_noise = { floor_mps3 = 0.01, ratio = 0.01 })"#,
    ),
    (
        r#"trust = "known""#,
        r#"trust = "noisy"⏎input_noise = { floor_mps3 = 0.01 }"#,
        "line 16, column 15: `motion.input_noise.ratio`: this required key is missing (the noise relative to the jerk; 0.01 is one percent)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "noisy"⏎input_noise = 0.01"#,
        "line 16, column 15: `motion.input_noise`: a table is needed here, not a number with a decimal point (write [motion.input_noise] on a line of its own, its keys below)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "noisy"⏎input_noise = { floor_mps3 = -1, ratio = 0.01 }"#,
        "line 16, column 30: `motion.input_noise.floor_mps3`: -1.0 is out of range (a number from 0 m/s³, at most 1e9 m/s³)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "unknown"⏎known_ends = "start""#,
        r#"line 16, column 14: `motion.known_ends`: trust "unknown" needs the acceleration at both ends of the motion (known_ends = "both", or leave the key away)"#,
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[holds]⏎gravity_mps2 = 9.8⏎gauge = "upper""#,
        "line 16, column 1: `holds`: [motion] and [holds] are both there (an experiment is one or the other: take one of them out)",
    ),
    (
        r#"[motion]⏎intervals = 10⏎interval_s = 1.0⏎rate_hz = 10.0⏎trust = "known"⏎"#,
        "",
        "line 1, column 1: neither [motion] nor [holds] nor [machine] is there (say how the sensor is moved: [motion] for a commanded motion, [holds] for still poses, [machine] for a machine whose motion is logged)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[limits]⏎velocity_mps = 0.0"#,
        "line 17, column 16: `limits.velocity_mps`: 0.0 is out of range (a number above 0 m/s, at most 1e9 m/s)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[limits]⏎rest = "end""#,
        r#"line 17, column 8: `limits.rest`: "end" is not known here (one of "none", "start", "both")"#,
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[design]⏎criterion = "B""#,
        r#"line 17, column 13: `design.criterion`: "B" is not known here (one of "A", "D", "E", "M", "c", "I")"#,
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[design]⏎criterion = "c""#,
        r#"line 16, column 1: `design.weights`: this required key is missing (criterion c needs a weight above 0: weights = { "scale.x" = 1.0 })"#,
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[design]⏎criterion = "I""#,
        "line 16, column 1: `design.range_mps2`: this required key is missing (criterion I needs the operating range: range_mps2 = 20.0)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[design]⏎weights = { "scal.x" = 1.0 }"#,
        r#"line 17, column 24: `design.weights.scal.x`: this sensor has no parameter "scal.x" (did you mean "scale.x"? its parameters are bias.x, bias.y, bias.z, scale.x, scale.y, scale.z)"#,
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[design]⏎weights = { scale.x = 1.0 }"#,
        "line 17, column 13: `design.weights.scale`: a number is needed here, not a table: a name with a dot needs quotes (a number from 0, at most 1e30)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[design]⏎certificate = "yes""#,
        "line 17, column 15: `design.certificate`: true or false is needed here, not a string (without quotes)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study]⏎sensors = 0"#,
        "line 17, column 11: `study.sensors`: 0 is out of range (a whole number from 1 to 10000000)",
    ),
    (
        r#"trust = "known""#,
        r#"trust = "known"⏎[study]⏎seed = -1"#,
        "line 17, column 8: `study.seed`: -1 is out of range (a whole number from 0)",
    ),
    (
        "scale_sd = 0.005⏎",
        r#"[calibrate]⏎prior = "datasheet"⏎"#,
        r#"line 10, column 9: `calibrate.prior`: "datasheet" needs scale_sd in [sensor] (spreads above 0) (add what is missing, or write "none")"#,
    ),
];
