//! Tests of `convert`, `apply` and `compare`: from one program's file to another's, with messages on the way.

use crate::bench::Bench;

/// A whole IMU as imucal writes it.
pub(crate) const IMUCAL: &str = r#"{"acc_unit": "m/s^2", "gyr_unit": "deg/s", "from_acc_unit": "a.u.", "from_gyr_unit": "a.u.", "comment": null,
    "K_a": [[208.1, 0.0, 0.0], [0.0, 209.3, 0.0], [0.0, 0.0, 213.7]],
    "R_a": [[0.99986, -0.0148, -0.0075], [0.0086, 0.99996, 0.0018], [0.0133, 0.0020, 0.99991]],
    "b_a": [112.1, -128.6, 83.3],
    "K_g": [[16.84, 0.0, 0.0], [0.0, 16.10, 0.0], [0.0, 0.0, 16.36]],
    "R_g": [[0.99998, -0.00045, -0.0064], [-0.0002, 0.99999, -0.0028], [0.0097, 0.0076, 0.99992]],
    "K_ga": [[0.0064, -0.0075, -0.0005], [0.0071, 0.0080, 0.0101], [0.0016, -0.0015, 0.0039]],
    "b_g": [-9.8, -6.1, 1.0], "cal_type": "Ferraris", "_format_version": "2.0.0"}"#;

/// A bench with a static calibration in `out/calibration.json` of `sim/recording.csv`.
fn calibrated() -> Bench {
    let bench = Bench::new();
    bench.preset("static-poses", "poses.toml", &[]);
    bench.run("simulate poses.toml -o sim").done();
    bench.run("calibrate poses.toml sim/recording.csv -o out").done();
    bench
}

#[test]
fn one_file_goes_through_all_formats_and_stays_the_same_imu() {
    let bench = Bench::new();
    bench.write("shimmer.json", IMUCAL);
    let done = bench.run("convert shimmer.json imu.json").done();
    assert!(
        done.printed().contains(
            "imucal's JSON): accelerometer in counts, gyroscope in counts, g-sensitivity, no covariance"
        ),
        "{}",
        done.stdout
    );
    let message = bench.run("convert imu.json imu.yaml").done().stderr;
    assert!(message.contains("T_i_b holds the rotation"), "{message}");
    bench.run("convert imu.yaml imu.h").done();
    bench.run("convert imu.h back.json --to imucal").done();
    let json = bench.json("back.json");
    assert_eq!((json["cal_type"].as_str(), json["from_gyr_unit"].as_str()), (Some("Ferraris"), Some("a.u.")));
    let table = bench.run("compare shimmer.json back.json --json").done().json();
    for row in table["quantities"].as_array().expect("rows") {
        let difference = row["difference"].as_f64().expect("the same units");
        assert!(difference.abs() < 1e-9, "{row}");
    }
    assert!(table["notes"][0]["message"].as_str().expect("a note").contains("neither has a covariance"));
}

#[test]
fn what_a_format_cannot_carry_is_refused_or_said() {
    let bench = Bench::new();
    bench.write("shimmer.json", IMUCAL);
    bench.refuses(
        "convert shimmer.json imu.calib",
        2,
        &["imu_tk's .calib has no place for the gyroscope's g-sensitivity"],
    );
    let message =
        bench.run("convert shimmer.json imu.calib --drop-g-sensitivity --gauge upper").done().stderr;
    assert!(
        message.contains("warning: gyroscope: the g-sensitivity is omitted. Corrected values err by up to "),
        "{message}"
    );
    assert!(bench.read("imu_acc.calib").contains("# readings in: counts"));
    assert!(bench.read("imu_gyro.calib").contains("# sensor: gyroscope"));
    let done = bench.run("convert imu.calib pair.json").done();
    assert!(
        done.printed().contains("accelerometer in counts, gyroscope in counts, no covariance"),
        "{}",
        done.stdout
    );
    assert_eq!(bench.json("pair.json")["gauge"], "upper");
    bench.refuses(
        "convert shimmer.json imu.txt",
        2,
        &["imu.txt: the extension does not tell the format to write"],
    );
    bench.write("plain.calib", "1 0 0\n0 1 0\n0 0 1\n0.0024 0 0\n0 0.0024 0\n0 0 0.0024\n1\n2\n3\n");
    bench.refuses(
        "convert plain.calib x.json",
        2,
        &["plain.calib: is this the accelerometer's or the gyroscope's?"],
    );
    bench.refuses(
        "convert plain.calib x.json --sensor accelerometer",
        2,
        &["a scale of 0.0024 looks like counts: --unit counts"],
    );
    bench.run("convert plain.calib x.json --sensor accelerometer --unit counts").done();
}

#[test]
fn a_gauge_change_carries_the_covariance_and_compare_sees_one_sensor() {
    let bench = calibrated();
    bench.run("convert out/calibration.json lower.json --gauge lower").done();
    let lower = bench.json("lower.json");
    assert_eq!((lower["schema"].as_u64(), lower["gauge"].as_str()), (Some(2), Some("lower")));
    assert_eq!(lower["inputs"][0]["sha256"].as_str().map(str::len), Some(64));
    assert_eq!(lower["covariance"].as_array().map(Vec::len), Some(9));
    let done = bench.run("compare out/calibration.json lower.json").done();
    assert!(done.printed().contains("accelerometer.angle.xy"), "{}", done.stdout);
    assert!(done.printed().contains("their uncertainties explain the difference; χ² 0"), "{}", done.stdout);
    assert!(done.printed().contains("9 degrees of freedom, p-value > 0.9999"), "{}", done.stdout);
    // Kalibr's own files have no biases
    bench.run("convert out/calibration.json own.yaml --to kalibr --gauge lower").done();
    let text = bench.read("own.yaml");
    let own: Vec<&str> =
        text.lines().filter(|line| !(line.starts_with("    b: ") || line.contains("_bias: "))).collect();
    bench.write("own.yaml", own.join("\n"));
    let done = bench.run("compare out/calibration.json own.yaml").done();
    assert!(done.stderr.contains("B does not say the biases of the accelerometer"), "{}", done.stderr);
    assert!(done.printed().contains("χ² 0") && !done.printed().contains("bias"), "{}", done.stdout);
    assert!(done.printed().contains(" 6 degrees of freedom"), "{}", done.stdout);
    // another bias shows
    let text = bench.read("lower.json");
    let bias = lower["accelerometer"]["bias_mps2"][0].as_f64().expect("a number");
    bench.write("moved.json", text.replace(&format!("{bias:?}"), &format!("{:?}", bias + 1.0)));
    let done = bench.run("compare lower.json moved.json").done();
    assert!(
        done.printed().contains("they differ by more than their uncertainties explain"),
        "{}",
        done.stdout
    );
}

#[test]
fn apply_writes_true_values_with_their_uncertainty() {
    let bench = calibrated();
    let done = bench.run("apply out/calibration.json sim/recording.csv -o corrected.csv").done();
    assert!(done.printed().contains("largest standard uncertainty of the correction"), "{}", done.stdout);
    let text = bench.read("corrected.csv");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("t_s,ax_mps2,ay_mps2,az_mps2,ax_sd_mps2,ay_sd_mps2,az_sd_mps2"));
    let first: Vec<f64> =
        lines.next().expect("a row").split(',').map(|v| v.parse().expect("a number")).collect();
    assert!((first[1].hypot(first[2]).hypot(first[3]) - 9.80665).abs() < 0.05, "{first:?}");
    assert!(first[4] > 0.0 && first[4] < 0.1, "{first:?}");
    assert_eq!(text.lines().count(), bench.read("sim/recording.csv").lines().count());
    // without a covariance there is no uncertainty, and the program says so
    bench.run("convert out/calibration.json imu.h").done();
    let done = bench.run("apply imu.h sim/recording.csv -o plain.csv").done();
    assert!(done.printed().contains("its uncertainty is not known"), "{}", done.stdout);
    assert!(bench.read("plain.csv").starts_with("t_s,ax_mps2,ay_mps2,az_mps2\n"));
    // counts are no m/s²
    bench.write("counts.csv", "t_s,ax_counts,ay_counts,az_counts\n0,1,2,3\n0.1,2,3,4\n");
    bench.refuses(
        "apply imu.h counts.csv -o x.csv",
        3,
        &["counts.csv: the readings of the accelerometer are in counts"],
    );
}

#[test]
fn apply_writes_the_units_that_other_programs_take() {
    let bench = calibrated();
    bench.run("apply out/calibration.json sim/recording.csv -o si.csv").done();
    bench.run("apply out/calibration.json sim/recording.csv -o g.csv --output-accelerometer-unit g").done();
    let [si, g] = ["si.csv", "g.csv"].map(|name| bench.read(name));
    assert!(g.starts_with("t_s,ax_g,ay_g,az_g,ax_sd_g,ay_sd_g,az_sd_g\n"), "{g:.80}");
    let row = |text: &str| -> Vec<f64> {
        text.lines().nth(1).expect("a row").split(',').map(|v| v.parse().expect("a number")).collect()
    };
    for (si, g) in row(&si).iter().zip(row(&g)).skip(1) {
        assert_eq!(*si / 9.80665, g);
    }
    bench.refuses("apply out/calibration.json g.csv -o x.csv", 3, &["has been corrected already"]);
    bench.refuses(
        "apply out/calibration.json sim/recording.csv -o x.csv --output-gyroscope-unit g",
        2,
        &["corrected values of the gyroscope are in rad/s, deg/s or mdps"],
    );
}

/// One calibration for an autopilot, for basalt and for OpenVINS.
#[test]
fn other_programs_take_what_is_left_of_a_calibration() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.run("simulate imu.toml -o made").done();
    let convert = "convert made/truth.json";
    let says = "PX4's parameters has no place for the accelerometer's cross-axis sensitivity (up to";
    bench.refuses(&format!("{convert} imu.params"), 2, &[says, "--drop cross-axis,gyroscope-matrix"]);
    let drop = "--drop cross-axis,gyroscope-matrix,g-sensitivity";
    let message = bench.run(&format!("{convert} imu.params {drop}")).done().stderr;
    assert!(
        message.contains("cross-axis sensitivity is omitted. Corrected values err by up to "),
        "{message}"
    );
    assert!(bench.read("imu.params").contains("1\t1\tCAL_ACC0_XSCALE\t"));
    bench.run(&format!("{convert} imu.param {drop}")).done();
    assert!(bench.read("imu.param").contains("\nINS_GYROFFS_Z,"));
    bench.write("basalt.json", "{\"value0\": {\"resolution\": []}}");
    bench.run(&format!("{convert} --into basalt.json --drop g-sensitivity")).done();
    assert!(bench.json("basalt.json")["value0"]["calib_gyro_bias"].is_array());
    bench.refuses(&format!("{convert} --into basalt.json --to px4"), 2, &["--into is for files of basalt"]);
    bench.run(&format!("{convert} imu.yaml --to openvins --update-rate 200 --rostopic /imu")).done();
    bench.run("convert imu.yaml back.json").done();
    let table = bench.run("compare made/truth.json back.json --json").done().json();
    for row in table["quantities"].as_array().expect("rows") {
        assert!(row["difference"].as_f64().expect("the same units").abs() < 1e-9, "{row}");
    }
}

/// Two files of imu_tk that were swapped, and calibrations of different sensors.
#[test]
fn sensors_that_are_not_those_expected_are_refused() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.run("simulate imu.toml -o made").done();
    bench.run("convert made/truth.json a.calib --drop-g-sensitivity").done();
    bench.run("compare a.calib made/truth.json").done();
    let done = bench.run("compare a.calib made/truth.json --unit counts").done();
    let note = "the readings of the accelerometer are in m/s², as the file says: the unit counts is given for files that do not say it";
    assert!(done.stderr.contains(note), "{}", done.stderr);
    bench.write("x_acc.calib", bench.read("a_gyro.calib"));
    bench.write("x_gyro.calib", bench.read("a_acc.calib"));
    let says = "x_acc.calib: the file says that it is of the gyroscope, and it was given as that of the accelerometer";
    bench.refuses("compare x.calib made/truth.json", 2, &[says, "are the two files exchanged"]);
    let says = "a_acc.calib and a_gyro.calib have no sensor in common: accelerometer in m/s², no covariance; gyroscope in rad/s";
    for json in ["", " --json"] {
        bench.refuses(&format!("compare a_acc.calib a_gyro.calib{json}"), 2, &[says]);
    }
}

/// A result does not replace a file that was read.
#[test]
fn a_result_does_not_replace_what_it_is_made_from() {
    let bench = calibrated();
    for command in [
        "apply out/calibration.json sim/recording.csv -o sim/recording.csv",
        "apply out/calibration.json sim/recording.csv -o out/calibration.json",
        "convert out/calibration.json out/calibration.json",
    ] {
        bench.refuses(command, 2, &["this file is read, and would be replaced by the result"]);
    }
}
