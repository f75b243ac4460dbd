//! Tests of `calibrant apply`: it reports what it reads wrongly or not at all, and asks for units.

use crate::bench::Bench;

/// The columns of a recording in SI units.
const NAMES: &str = "t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps";

/// A bench with an IMU in `truth.json`, m/s² and rad/s, and a file of its readings.
fn imu() -> Bench {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.run("simulate imu.toml -o sim").done();
    bench.write("truth.json", bench.read("sim/truth.json"));
    bench.write("good.csv", rows(NAMES, 1.0));
    bench
}

/// Four samples, the accelerometer's in a unit that is this many m/s².
fn rows(names: &str, unit_mps2: f64) -> String {
    let up = 9.8 / unit_mps2;
    let row = |k: i32| format!("{:.2},{:.5},0.001,{:.5},0.1,0.2,0.3\n", f64::from(k) / 100.0, 0.01 * up, up);
    format!("{names}\n{}", (0..4).map(row).collect::<String>())
}

/// The mean magnitude that the summary gives for a sensor.
fn mean(message: &str, sensor: &str) -> f64 {
    let line = message.lines().find(|line| line.trim_start().starts_with(sensor) && line.contains("samples"));
    let number = line.and_then(|line| line.split("mean magnitude ").nth(1)?.split(' ').next());
    number.expect("a mean").parse().expect("a number")
}

/// A recording whose gyroscope cannot be read is an error, not one without gyroscope.
#[test]
fn a_sensor_that_cannot_be_read_is_not_left_out() {
    let bench = imu();
    let done = bench.run("apply truth.json good.csv -o corrected.csv").done();
    assert!((mean(&done.stdout, "gyroscope") - 0.14_f64.sqrt()).abs() < 0.05, "{}", done.stdout);
    let good = bench.read("good.csv");
    for (name, text, says) in [
        ("cell.csv", good.replacen(",0.2,", ",oops,", 1), "oops"),
        ("mixed.csv", good.replace("gz_radps", "gz_degps"), "the axes of the gyroscope have different units"),
        ("named.csv", good.replace("gz_radps", "gq_radps"), "the gyroscope has no column for axis z"),
        ("g.csv", rows(NAMES, 9.80665), "is it in g?"),
        ("empty.csv", good.replace(",0.2,", ",,"), "the gyroscope has columns, but they cannot be used"),
        ("four.csv", "0 0 0 9.8\n0.1 0 0 9.8\n0.2 0 0 9.8\n".into(), "this one does not say which it is"),
    ] {
        bench.write(name, text);
        bench.refuses(&format!("apply truth.json {name} -o x.csv"), 3, &[name, says]);
    }
    bench.refuses(
        "apply truth.json good.csv --gyroscope-unit deg/s -o x.csv",
        3,
        &["the gyroscope's columns are in rad/s, but the unit was given as deg/s"],
    );
    bench.refuses("apply truth.json good.csv --gyroscope none.mat -o x.csv", 3, &["none.mat"]);
    // without its columns there is no gyroscope, and the program says so
    let alone = "t_s,ax_mps2,ay_mps2,az_mps2\n0,0,0,9.8\n0.1,0,0,9.8\n0.2,0,0,9.8\n";
    bench.write("alone.csv", alone);
    bench
        .run("apply truth.json alone.csv -o corrected.csv")
        .done()
        .says("the recording has no gyroscope; only the other sensor is corrected");
}

/// Readings in deg/s are not corrected as rad/s because the calibration is in rad/s.
#[test]
fn a_unit_that_the_file_does_not_state_is_asked_for() {
    let bench = imu();
    bench.write("plain.csv", rows("t_s,ax,ay,az,gx,gy,gz", 1.0));
    bench.refuses(
        "apply truth.json plain.csv -o x.csv",
        3,
        &["the gyroscope's columns have no unit", "--accelerometer-unit", "--gyroscope-unit"],
    );
    bench.refuses(
        "apply truth.json plain.csv --accelerometer-unit m/s2 -o x.csv",
        3,
        &["the gyroscope's columns have no unit", "--gyroscope-unit"],
    );
    let units = "--accelerometer-unit m/s2 --gyroscope-unit";
    let of = |unit| bench.run(&format!("apply truth.json plain.csv {units} {unit} -o x.csv")).done().stdout;
    let (radps, degps) = (mean(&of("rad/s"), "gyroscope"), mean(&of("deg/s"), "gyroscope"));
    assert!((radps - 0.14_f64.sqrt()).abs() < 0.05 && degps < 0.05, "{radps} {degps}");

    // [columns] of an experiment file answers as well
    let columns = "accelerometer_unit = \"m/s2\"\ngyroscope_unit = \"rad/s\"\n# time = ";
    bench.write("columns.toml", bench.read("imu.toml").replacen("# time = ", columns, 1));
    bench.run("apply truth.json plain.csv --columns columns.toml -o columns.csv").done();
    bench.run(&format!("apply truth.json plain.csv {units} rad/s -o options.csv")).done();
    assert_eq!(bench.read("columns.csv"), bench.read("options.csv"));
    bench.refuses(
        "apply truth.json plain.csv --columns imu.toml -o x.csv",
        2,
        &["imu.toml: there is no [columns] section"],
    );
}

/// For a calibration in counts, the readings are counts unless the file states another unit.
#[test]
fn a_calibration_in_counts_corrects_counts() {
    let bench = Bench::new();
    bench.write("shimmer.json", crate::conventions::IMUCAL);
    let names = "ax,ay,az,gx,gy,gz";
    let write = |file: &str, names: &str| {
        bench.write(file, format!("t_s,{names}\n0,112,-128,2179,-9,-6,1\n0.1,112,-128,2179,-9,-6,1\n"));
    };
    write("plain.csv", names);
    write("stated.csv", "ax_counts,ay_counts,az_counts,gx_counts,gy_counts,gz_counts");
    write("half.csv", "ax_counts,ay_counts,az_counts,gx,gy,gz");
    // (2179 − 83.3) / 213.7
    let message = bench.run("apply shimmer.json plain.csv -o plain.out").done().stdout;
    assert!((mean(&message, "accelerometer") - 9.807).abs() < 0.02, "{message}");
    for file in ["stated", "half"] {
        bench.run(&format!("apply shimmer.json {file}.csv -o {file}.out")).done();
        assert_eq!(bench.read(&format!("{file}.out")), bench.read("plain.out"), "{file}");
    }
    // the message names the fault of the file, not a missing unit
    let bad = bench.read("plain.csv").replace(",-6,", ",oops,");
    bench.write("bad.csv", bad);
    bench.refuses("apply shimmer.json bad.csv -o x.csv", 3, &["bad.csv", "oops"]);
    bench.write("four.mat", "0 112 -128 2179\n0.1 112 -128 2179\n");
    bench.refuses("apply shimmer.json four.mat --gyroscope none.mat -o x.csv", 3, &["none.mat"]);
    bench.write("si.csv", rows(NAMES, 1.0));
    bench.refuses("apply shimmer.json si.csv -o x.csv", 3, &["si.csv: the readings of the accelerometer"]);
}

/// A calibration of one sensor corrects it in a file of its own, and in one of a whole IMU.
#[test]
fn a_calibration_of_one_sensor_reads_one_sensor() {
    let bench = imu();
    bench.write("acc.calib", "1 0 0\n0 1 0\n0 0 1\n2 0 0\n0 2 0\n0 0 2\n0.1\n0.2\n0.3\n");
    bench.run("convert acc.calib acc.json --sensor accelerometer --unit si").done();
    bench.write("four.mat", "0.0 0.1 0.2 5.3\n0.1 0.1 0.2 5.3\n0.2 0.1 0.2 5.3\n");
    bench.refuses("apply acc.json four.mat -o x.csv", 3, &["four.mat", "--accelerometer-unit"]);
    let message = bench.run("apply acc.json four.mat --accelerometer-unit m/s2 -o x.csv").done().stdout;
    assert!((mean(&message, "accelerometer") - 10.0).abs() < 1e-9, "{message}");
    // the other sensor's unit does not matter where that sensor is ignored
    bench.write("whole.csv", rows("t_s,ax_mps2,ay_mps2,az_mps2,gx,gy,gz", 1.0));
    let done = bench.run("apply acc.json whole.csv -o x.csv").done();
    done.says("the calibration has no gyroscope; its readings are not written");
    assert!(bench.read("x.csv").starts_with("t_s,ax_mps2,ay_mps2,az_mps2\n"));
}

/// A file with `[columns]` alone serves as well as an experiment file.
#[test]
fn columns_need_no_experiment() {
    let bench = imu();
    bench.write("plain.csv", rows("t_s,ax,ay,az,gx,gy,gz", 1.0));
    let units = "accelerometer_unit = \"m/s2\"\ngyroscope_unit = \"rad/s\"\n";
    bench.write("columns.toml", format!("[columns]\n{units}"));
    bench.write("schema.toml", format!("schema = 1\n[columns]\n{units}"));
    let options = "--accelerometer-unit m/s2 --gyroscope-unit rad/s";
    bench.run(&format!("apply truth.json plain.csv {options} -o options.csv")).done();
    for file in ["columns", "schema"] {
        bench.run(&format!("apply truth.json plain.csv --columns {file}.toml -o {file}.csv")).done();
        assert_eq!(bench.read(&format!("{file}.csv")), bench.read("options.csv"), "{file}");
    }
    bench.run("inspect plain.csv --columns columns.toml").done();
    for (text, says) in [
        ("[columns]\ngyroscope_units = \"rad/s\"\n", "did you mean `gyroscope_unit`?"),
        ("", "there is no [columns] section"),
        (
            "[columns]\ngyroscope_unit = \"rad/s\"\n[holds]\n",
            "the first line of an experiment file is schema = 1",
        ),
    ] {
        bench.write("bad.toml", text);
        bench.refuses("apply truth.json plain.csv --columns bad.toml -o x.csv", 2, &["bad.toml", says]);
    }
}

/// Files of a sensor each: `(time, x, y, z)` every 10 ms.
fn sensor(names: &str, count: u32, shift_s: f64, value: [f64; 3]) -> String {
    let row = |k: u32| {
        let [x, y, z] = value;
        format!("{:.9},{x},{y},{z}\n", f64::from(k) / 100.0 + shift_s)
    };
    format!("{names}\n{}", (0..count).map(row).collect::<String>())
}

#[test]
fn times_that_differ_in_the_last_digit_share_a_row() {
    let bench = imu();
    bench.write("acc.csv", sensor("t_s,ax_mps2,ay_mps2,az_mps2", 50, 0.0, [0.0, 0.1, 9.8]));
    for (shift_s, rows) in [(0.0, 50), (2e-9, 50), (-5e-6, 50), (1e-3, 100)] {
        bench.write("gyr.csv", sensor("t_s,gx_radps,gy_radps,gz_radps", 50, shift_s, [0.1, 0.2, 0.3]));
        bench.run("apply truth.json acc.csv --gyroscope gyr.csv -o x.csv").done();
        let written = bench.read("x.csv");
        assert_eq!(written.lines().count(), 1 + rows, "{shift_s}");
        assert_eq!(written.contains(",,"), rows == 100, "{shift_s}");
    }
}

/// Where the accelerometer ends before the gyroscope, the force on the gyroscope is not known.
#[test]
fn a_sensor_that_ends_before_the_other_or_pauses_is_named() {
    let bench = imu();
    bench.write("acc.csv", sensor("t_s,ax_mps2,ay_mps2,az_mps2", 50, 0.0, [0.0, 0.1, 9.8]));
    bench.write("gyr.csv", sensor("t_s,gx_radps,gy_radps,gz_radps", 200, 0.0, [0.1, 0.2, 0.3]));
    let done = bench.run("apply truth.json acc.csv --gyroscope gyr.csv -o x.csv").done();
    done.says("acc.csv: accelerometer: it was recorded from 0 to 0.49 s, the gyroscope from 0 to 1.99 s: 0.49 s of both");
    bench.write("gyr.csv", sensor("t_s,gx_radps,gy_radps,gz_radps", 50, 0.0, [0.1, 0.2, 0.3]));
    let done = bench.run("apply truth.json acc.csv --gyroscope gyr.csv -o x.csv").done();
    assert!(!done.stderr.contains("recorded from"), "{}", done.stderr);
    // one file's gap is not the other's
    let gyroscope = sensor("t_s,gx_radps,gy_radps,gz_radps", 50, 0.0, [0.1, 0.2, 0.3]);
    let gap: Vec<&str> = gyroscope.lines().filter(|line| !line.starts_with("0.2")).collect();
    bench.write("gyr.csv", gap.join("\n"));
    let done = bench.run("apply truth.json acc.csv --gyroscope gyr.csv -o x.csv").done();
    done.says("gyr.csv: line 22: gyroscope: gap of 0.11 s");
    assert!(!done.stderr.contains("acc.csv: gyroscope"), "{}", done.stderr);
    let inspected = bench.run("inspect acc.csv --gyroscope gyr.csv").done().stdout;
    assert_eq!(inspected, bench.run("inspect acc.csv gyr.csv").done().stdout);
}

#[test]
fn a_bag_of_ros_1_that_was_cut_off_is_called_so() {
    let bench = imu();
    bench.write("imu.bag", b"#ROSBAG V2.0\nE\0\0\0\x0c\0\0\0chunk_count");
    let said = ["imu.bag: the bag is damaged: it ends before any message", "rosbag reindex FILE.bag"];
    bench.refuses("apply truth.json imu.bag -o x.csv", 3, &said);
    bench.refuses("inspect imu.bag", 3, &said);
}

/// A truth.json that `simulate` would not write.
#[test]
fn what_is_wrong_with_a_truth_is_named() {
    let bench = imu();
    let truth = bench.json("truth.json");
    let edited = |edit: &dyn Fn(&mut serde_json::Value)| {
        let mut edited = truth.clone();
        edit(&mut edited);
        edited.to_string()
    };
    let first = |value: serde_json::Value, key: &'static str| {
        move |truth: &mut serde_json::Value| truth["parameters"][0][key] = value.clone()
    };
    for (text, says) in [
        (edited(&first(serde_json::json!([1, 2]), "value")), "invalid type: sequence, expected f64"),
        (edited(&first("K".into(), "unit")), "accelerometer.bias.x is in \"K\", and m/s² is expected"),
        (edited(&first("accelerometer.bias.y".into(), "name")), "accelerometer.bias.y stands twice"),
        (edited(&first("speed".into(), "name")), "\"speed\" is no parameter of a sensor"),
        (edited(&|truth| truth["gauge"] = "skew".into()), "the gauge \"skew\" is none that is known"),
        (
            edited(&|truth| truth["parameters"] = serde_json::json!([])),
            "neither an accelerometer nor a gyroscope",
        ),
    ] {
        bench.write("odd.json", text);
        let outcome = bench.run("compare odd.json truth.json");
        assert_ne!(outcome.status, 0, "{outcome:?}");
        outcome.says("odd.json");
        outcome.says(says);
    }
}

#[test]
fn a_negative_seed_is_refused_as_a_number() {
    let bench = imu();
    for option in ["--seed -5", "--seed=-5", "--recording -1"] {
        let outcome = bench.run(&format!("simulate imu.toml {option} -o x"));
        assert_eq!(outcome.status, 2, "{outcome:?}");
        outcome.says("invalid value '-");
    }
}
