//! Tests of `[temperature]` and of the known values of its terms.

use calibrant::estimate::ThermalModel;
use calibrant::io::{Experiment, preset};

fn with(section: &str) -> calibrant::Result<Experiment> {
    let text = preset("imu").expect("known");
    let (before, after) = text.split_once("[temperature]").expect("there");
    // what follows the header on its line is a comment
    let rest = after.split_once('\n').expect("lines").1;
    Experiment::parse(&format!("{before}[temperature]\n{section}\n{rest}"), None)
}

#[test]
fn orders_and_reference_are_read() {
    let thermal = with("").expect("orders of 0").imu.expect("an IMU").thermal;
    assert!(thermal.is_none() && thermal == ThermalModel::default());
    let experiment = with("reference_c = -5\naccelerometer_scale = 1\ngyroscope_bias = 2").expect("valid");
    let expected = ThermalModel {
        reference_c: Some(-5.0),
        accelerometer_scale: 1,
        gyroscope_bias: 2,
        ..ThermalModel::default()
    };
    assert_eq!(experiment.imu.expect("an IMU").thermal, expected);
}

#[test]
fn what_is_not_there_or_out_of_range_is_said() {
    for (section, says) in [
        ("gyroscope_bias = 6", "`temperature.gyroscope_bias`"),
        ("gyroscope_bias = 6", "from 0 to 5"),
        ("reference_c = 3000.0", "`temperature.reference_c`"),
        ("gyroscope_bais = 1", "did you mean `gyroscope_bias`?"),
        (
            "accelerometer_bias = 1\n[known]\n\"gyroscope.bias_per_k.x\" = 0.0",
            "\"gyroscope.bias_per_k.x\" is known, and no such term is asked for",
        ),
        (
            "gyroscope_bias = 1\n[known]\n\"gyroscope.bias_per_k6.x\" = 0.0",
            "did you mean \"gyroscope.bias_per_k",
        ),
    ] {
        // the preset's own [known] is removed
        let section = section.to_owned();
        let text = preset("imu").expect("known").replace("\n[known] ", "\n# [known] ");
        let at = text.find("[temperature]").expect("there");
        let line = text[at..].find('\n').expect("lines") + at;
        let text = format!("{}[temperature]\n{section}{}", &text[..at], &text[line..]);
        let error = Experiment::parse(&text, None).expect_err(says);
        assert!(error.is_invalid_experiment() && error.to_string().contains(says), "{section}: {error}");
    }
    let alone = format!("{}\n[temperature]\n", super::HOLDS);
    let error = Experiment::parse(&alone, None).expect_err("no IMU").to_string();
    assert!(error.contains("[temperature] is read for an IMU, or with [campaign]"), "{error}");
}
