//! Tests of broken experiment files: every message word for word.

mod columns;
mod datasheet;
mod holds;
mod machine;
mod motion;
mod study;
mod temperature;

use calibrant::io::Experiment;

/// A good experiment file with a motion.
const MOTION: &str = r#"schema = 1

[sensor]
kind = "accelerometer"
axes = 3
model = "scale-bias"
noise_mps2 = 2e-4
bias_sd_mps2 = 0.1
scale_sd = 0.005

[motion]
intervals = 10
interval_s = 1.0
rate_hz = 10.0
trust = "known"
"#;

/// A good experiment file with holds.
const HOLDS: &str = r#"schema = 1

[sensor]
kind = "accelerometer"
axes = 3
model = "full"
unit = "counts"

[holds]
gravity_mps2 = 9.81
gauge = "upper"
"#;

/// A change to a good file (old, new; `⏎` stands for a line end) and the message about it.
type Case = (&'static str, &'static str, &'static str);

#[test]
fn unknown_keys_and_the_datasheet() {
    refuse(MOTION, datasheet::CASES);
}

#[test]
fn motion_limits_design_and_study() {
    refuse(MOTION, motion::CASES);
}

#[test]
fn the_experiments_of_a_study() {
    refuse(MOTION, study::CASES);
    refuse(HOLDS, study::HOLDS_CASES);
}

#[test]
fn gravity_gauge_and_given_holds() {
    refuse(HOLDS, holds::CASES);
}

#[test]
fn columns_of_recordings() {
    refuse(HOLDS, columns::CASES);
}

fn refuse(good: &str, cases: &[Case]) {
    assert!(Experiment::parse(good, None).is_ok());
    for (old, new, expected) in cases {
        let (old, new) = (old.replace('⏎', "\n"), new.replace('⏎', "\n"));
        assert!(good.contains(&old), "{old}");
        let text = good.replacen(&old, &new, 1);
        let error = Experiment::parse(&text, None).expect_err(expected);
        assert_eq!(error.to_string(), *expected);
        assert!(error.is_invalid_experiment() && !error.is_invalid_recording());
        let input_error = error.input_error().expect("a complaint");
        let (excerpt, range) = input_error.excerpt.as_ref().expect("the text");
        assert_eq!(*excerpt, text);
        let before = &text[..range.start];
        assert_eq!(input_error.line, Some(before.matches('\n').count() + 1), "{error}");
        let column = before.rsplit('\n').next().map_or(0, |line| line.chars().count()) + 1;
        assert_eq!(input_error.column, Some(column), "{error}");
    }
}
