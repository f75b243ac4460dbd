//! Cases of a broken `[holds]` and prior, with their messages.

use super::Case;

/// The broken `[holds]`.
pub(super) const CASES: &[Case] = &[
    (
        r#"unit = "counts""#,
        r#"unit = "lsb""#,
        r#"line 7, column 8: `sensor.unit`: "lsb" is not known here (one of "mps2", "counts")"#,
    ),
    (
        r#"axes = 3⏎model = "full""#,
        r#"axes = 1⏎model = "scale-bias""#,
        "line 9, column 1: `holds`: [holds] needs a sensor of three axes (axes = 3, or [motion])",
    ),
    (
        "gravity_mps2 = 9.81⏎",
        "gravity_sd_mps2 = 1e-3⏎",
        "line 9, column 1: `holds.gravity_mps2`: this required key is missing (give gravity_mps2, or latitude_deg and height_m)",
    ),
    (
        "gravity_mps2 = 9.81",
        "height_m = 52.2",
        "line 9, column 1: `holds.latitude_deg`: this required key is missing (height_m goes with latitude_deg)",
    ),
    (
        "gravity_mps2 = 9.81",
        "gravity_mps2 = 9.81⏎latitude_deg = 52.2⏎height_m = 3",
        "line 11, column 16: `holds.latitude_deg`: gravity is given twice (give gravity_mps2, or latitude_deg and height_m, not both)",
    ),
    (
        "gravity_mps2 = 9.81",
        "latitude_deg = 152.2⏎height_m = 3",
        "line 10, column 16: `holds.latitude_deg`: 152.2 is out of range (a number from -90 degrees, at most 90 degrees)",
    ),
    (
        "gravity_mps2 = 9.81",
        "gravity_mps2 = 981",
        "line 10, column 16: `holds.gravity_mps2`: 981.0 is out of range (a number from 0.1 m/s², at most 100 m/s²)",
    ),
    (
        r#"gauge = "upper""#,
        r#"gauge = "uper""#,
        r#"line 11, column 9: `holds.gauge`: "uper" is not known here (did you mean "upper"? one of "lower", "upper", "symmetric")"#,
    ),
    (
        r#"gauge = "upper""#,
        r#"gauge = "upper"⏎intervals_s = 3"#,
        "line 12, column 15: `holds.intervals_s`: an array is needed here, not a whole number (start and end of each hold in seconds: [[0.0, 50.0], [52.0, 57.0]])",
    ),
    (
        r#"gauge = "upper""#,
        r#"gauge = "upper"⏎intervals_s = [[0.0, 1.0], [2.0]]"#,
        "line 12, column 28: `holds.intervals_s[1]`: a hold has two numbers, this has 1 (start and end of each hold in seconds: [[0.0, 50.0], [52.0, 57.0]])",
    ),
    (
        r#"gauge = "upper""#,
        r#"gauge = "upper"⏎intervals_s = [[0.0, 1.0], [2.0, 1.5]]"#,
        "line 12, column 28: `holds.intervals_s[1]`: the hold ends at 1.5 s, not after its start at 2 s (start and end of each hold in seconds: [[0.0, 50.0], [52.0, 57.0]])",
    ),
    (
        r#"gauge = "upper""#,
        r#"gauge = "upper"⏎intervals_s = [[0.0, 1.0], [0.5, 1.5]]"#,
        "line 12, column 28: `holds.intervals_s[1]`: the hold starts at 0.5 s, before the one above ends at 1 s (sort the holds by time; they must not overlap)",
    ),
    (
        r#"gauge = "upper""#,
        r#"gauge = "upper"⏎intervals_s = []"#,
        "line 12, column 15: `holds.intervals_s`: no hold is given (start and end of each hold in seconds: [[0.0, 50.0], [52.0, 57.0]]; without this key they are looked for)",
    ),
    (
        r#"gauge = "upper""#,
        r#"gauge = "upper"⏎poses = 0"#,
        "line 12, column 9: `holds.poses`: 0 is out of range (a whole number from 1 to 1000000)",
    ),
    (
        r#"gauge = "upper""#,
        r#"gauge = "upper"⏎[calibrate]⏎prior = "datasheet""#,
        r#"line 13, column 9: `calibrate.prior`: "datasheet" needs bias_sd_mps2, scale_sd, cross_axis_sd, gain_counts_per_mps2, offset_counts in [sensor] (spreads above 0) (add what is missing, or write "none")"#,
    ),
];
