//! Tests of validation: calibrations on data that they did not use.

use crate::bench::Bench;
use crate::data::shared_data;

/// An experiment with holds, and two recordings of one sensor.
fn poses() -> Bench {
    let bench = Bench::new();
    bench.preset("static-poses", "poses.toml", &[("poses = 24 ", "poses = 48 ")]);
    bench.run("simulate poses.toml -o one").done();
    bench.write("recording.csv", bench.read("one/recording.csv"));
    bench
}

#[test]
fn an_accelerometer_is_validated_by_folds_and_on_another_recording() {
    let bench = poses();
    // each half has 24 poses of its own
    let text = bench.read("recording.csv");
    let lines: Vec<&str> = text.lines().collect();
    let half = 1 + (lines.len() - 1) / 2;
    bench.write("first.csv", lines[..half].join("\n") + "\n");
    bench.write("second.csv", format!("{}\n{}\n", lines[0], lines[half..].join("\n")));
    let outcome =
        bench.run("calibrate poses.toml first.csv --validate second.csv --folds 3 -o result").done();
    for says in ["Validation On second.csv", "3 blocks of holds", "the gravity residual is", "ratio (99 %)"] {
        assert!(outcome.printed().contains(says), "{says}: {}", outcome.stdout);
    }
    let json = bench.json("result/calibration.json");
    for (source, place) in [("recording", "file"), ("folds", "folds")] {
        let found = &json["validation"][source];
        assert!(!found[place].is_null(), "{found}");
        let errors = &found["magnitude"];
        assert_eq!(errors["unit"], "m/s²");
        let counted = errors["counted"].as_u64().expect("a number");
        assert!(counted > 2 && errors["degrees_of_freedom"].as_u64() == Some(counted), "{errors}");
        assert!(errors["rms"].as_f64().expect("a number") < 0.05, "{errors}");
        assert_eq!(errors["verdict"], "believed", "{errors}");
        assert_eq!(errors["table"].as_array().map(Vec::len), errors["errors"].as_u64().map(|n| n as usize));
    }
    let report = bench.read("result/report.html");
    for says in ["> Validation</h2>", "On second.csv", "Errors on unused data", "±2 sd predicted"] {
        assert!(report.contains(says), "{says}");
    }
    // the same data under another name, or a part of them, are no other recording
    bench.write("copy.csv", format!("{}\n", bench.read("first.csv")));
    bench.write("part.csv", lines[..half / 2].join("\n") + "\n");
    for same in ["first.csv", "copy.csv", "part.csv"] {
        let says = [
            &format!("{same}: it has the data that were calibrated from"),
            "--folds 5 in place of --validate",
        ];
        bench.refuses(&format!("calibrate poses.toml first.csv --validate {same} -o same"), 2, &says);
    }
}

/// One hold is not conclusive, and a factor of hundreds shows something else than the size of the covariance.
#[test]
fn one_hold_is_too_few_to_tell_and_another_sensor_is_asked_about() {
    let bench = poses();
    // calibrated from the second half, validated on the first
    let text = bench.read("recording.csv");
    let (header, rows) = text.split_once('\n').expect("a header");
    let rows: Vec<[f64; 4]> = rows
        .lines()
        .map(|row| {
            let numbers: Vec<f64> = row.split(',').map(|number| number.parse().expect("a number")).collect();
            numbers.try_into().expect("four columns")
        })
        .collect();
    let half = rows.len() / 2;
    let write = |name: &str, rows: &[[f64; 4]], gain: f64, cross: f64| {
        let row =
            |[t, x, y, z]: &[f64; 4]| format!("{t},{},{},{}\n", gain * x + cross * y, gain * y, gain * z);
        bench.write(name, format!("{header}\n{}", rows.iter().map(row).collect::<String>()));
    };
    write("half.csv", &rows[half..], 1.0, 0.0);
    write("one-hold.csv", &rows[..400], 1.0, 0.0);
    write("other-gain.csv", &rows[..half], 1.05, 0.0);
    write("other-axes.csv", &rows[..half], 1.05, 0.05);
    let validate = |file: &str| {
        let outcome = bench.run(&format!("calibrate poses.toml half.csv --validate {file} -o result")).done();
        let json = bench.json("result/calibration.json");
        (outcome.printed(), json["validation"]["recording"]["magnitude"]["verdict"].clone())
    };
    let (message, verdict) = validate("one-hold.csv");
    assert!(message.contains("In 1 unused hold,") && message.contains("too few for a verdict"), "{message}");
    assert_eq!(verdict, "too_few");
    // bias and gains that are all 5 % larger
    let (message, _) = validate("other-gain.csv");
    assert!(message.contains("its gains by 5."), "{message}");
    assert!(!message.contains("covariance explains") && !message.contains("ultiply"), "{message}");
    let (message, verdict) = validate("other-axes.csv");
    assert!(message.contains("No covariance explains that. Is it the same sensor"), "{message}");
    assert!(!message.contains("ultiply"), "{message}");
    assert_eq!(verdict, "too_small");
}

#[test]
fn too_few_holds_for_folds_are_calibrated_still() {
    let bench = Bench::new();
    bench.preset("static-poses", "poses.toml", &[("poses = 24 ", "poses = 12 ")]);
    bench.run("simulate poses.toml -o one").done();
    let outcome = bench.run("calibrate poses.toml one/recording.csv --folds 2 -o result").done();
    assert!(outcome.stderr.contains("not validated by folds: none of the 2 folds"), "{}", outcome.stderr);
    assert!(bench.json("result/calibration.json")["validation"].is_null());
}

#[test]
fn what_cannot_be_validated_is_refused() {
    let bench = poses();
    let calibrate = "calibrate poses.toml recording.csv -o result";
    bench.refuses(&format!("{calibrate} --folds 1"), 2, &["1 folds cannot be made of"]);
    bench.refuses(&format!("{calibrate} --folds 1000"), 2, &["choose between 2 and"]);
    bench.refuses(&format!("{calibrate} --validate-gyroscope g.csv"), 2, &["--validate <FILE>"]);
    bench.refuses(&format!("{calibrate} --validate missing.csv"), 3, &["missing.csv: cannot read"]);
    bench.write("other.csv", bench.read("recording.csv"));
    bench.refuses(
        &format!("{calibrate} other.csv --folds 3"),
        2,
        &["one calibration is validated at a time"],
    );
    let short: String = (0..60)
        .map(|k| {
            format!(
                "{},{},{},{}\n",
                f64::from(k) * 0.01,
                (f64::from(k) * 0.7).sin() * (1.0 + f64::from(k)),
                1,
                2
            )
        })
        .collect();
    bench.write("short.csv", format!("t_s,ax_mps2,ay_mps2,az_mps2\n{short}"));
    bench.refuses(
        &format!("{calibrate} --validate short.csv"),
        3,
        &["short.csv: it has no holds of at least"],
    );
    bench.preset("report", "report.toml", &[]);
    bench.run("simulate report.toml -o moved").done();
    let moved = "calibrate report.toml moved/recording.csv --motion moved/motion.csv -o result";
    bench.refuses(&format!("{moved} --folds 3"), 2, &["only a calibration from holds can be validated"]);
}

#[test]
fn the_imu_of_imu_tk_is_validated_by_folds_and_its_file_is_still_read() {
    let Some(accelerometer) = shared_data("xsens-mti-static/xsens_acc.mat") else { return };
    let Some(gyroscope) = shared_data("xsens-mti-static/xsens_gyro.mat") else { return };
    let bench = Bench::new();
    std::fs::copy(accelerometer, bench.path("acc.mat")).expect("copied");
    std::fs::copy(gyroscope, bench.path("gyro.mat")).expect("copied");
    bench.preset("imu-counts", "imu.toml", &[]);
    // the first half calibrates, the second validates; one that overlaps with the first is no other recording
    for name in ["acc.mat", "gyro.mat"] {
        let text = bench.read(name);
        let lines: Vec<&str> = text.lines().collect();
        let (first, second) = lines.split_at(lines.len() / 2);
        bench.write(&format!("half-{name}"), first.join("\n") + "\n");
        bench.write(&format!("other-{name}"), second.join("\n") + "\n");
        bench.write(&format!("overlapping-{name}"), lines[lines.len() / 5..].join("\n") + "\n");
    }
    let calibrate = "calibrate imu.toml half-acc.mat --gyroscope half-gyro.mat";
    for (accelerometer, gyroscope, which) in [
        (
            "overlapping-acc.mat",
            "other-gyro.mat",
            "overlapping-acc.mat: it has the data that were calibrated",
        ),
        ("other-acc.mat", "overlapping-gyro.mat", "overlapping-gyro.mat: its gyroscope has the data"),
    ] {
        bench.refuses(
            &format!("{calibrate} --validate {accelerometer} --validate-gyroscope {gyroscope} -o result"),
            2,
            &[which],
        );
    }
    // the other recording's gyroscope has an option of its own
    bench.refuses(
        &format!("{calibrate} --validate other-acc.mat -o result"),
        3,
        &["other-acc.mat", "imu_tk keeps each sensor in a file of its own", "with --validate-gyroscope"],
    );
    let command = format!(
        "{calibrate} --folds 5 --validate other-acc.mat --validate-gyroscope other-gyro.mat -o result"
    );
    let command = command.as_str();
    let outcome = bench.run(command).done();
    assert!(outcome.printed().contains("gravity after rotations"), "{}", outcome.stdout);
    let json = bench.json("result/calibration.json");
    for kind in ["magnitude", "rate", "rotation"] {
        for source in ["folds", "recording"] {
            assert_eq!(json["validation"][source][kind]["verdict"], "believed", "{source} {kind}");
        }
    }
    let shift = &json["validation"]["recording"]["gyroscope_bias_shift"]["shift_radps"];
    assert!(
        shift
            .as_array()
            .is_some_and(|shift| shift.iter().all(|of| of.as_f64().is_some_and(|of| of.abs() < 3e-4))),
        "{shift}"
    );
    bench.run("convert result/calibration.json imu.h").done();
}

/// Two sessions of one sensor on a turntable: the seed draws the sensor, the rate changes the noise.
#[test]
fn a_calibration_from_faces_and_turns_is_validated_on_another_session() {
    let bench = Bench::new();
    // on an Earth that does not turn: six holds are too few to show how its rate about the north scatters
    let placed = ("latitude_deg = 52.0\nheight_m = 30.0", "gravity_mps2 = 9.8127");
    let table = include_str!("../../../../examples/06_whole_imu/table.toml").replacen(placed.0, placed.1, 1);
    assert!(table.contains(placed.1));
    bench.write("table.toml", &table);
    let other = table.replacen("rate_hz = 100.0", "rate_hz = 80.0", 1);
    assert_ne!(other, table);
    bench.write("other.toml", other);
    bench.run("simulate table.toml --seed 6 -o one").done();
    bench.run("simulate other.toml --seed 6 -o two").done();
    assert_eq!(bench.read("one/truth.json"), bench.read("two/truth.json"));
    let outcome =
        bench.run("calibrate table.toml one/recording.csv --validate two/recording.csv -o result").done();
    assert!(outcome.printed().contains("Validation On recording.csv"), "{}", outcome.stdout);
    let json = bench.json("result/calibration.json");
    let found = &json["validation"]["recording"];
    for (kind, unit) in [("magnitude", "m/s²"), ("rate", "rad/s"), ("rotation", "rad")] {
        let errors = &found[kind];
        assert_eq!(errors["unit"], unit, "{found}");
        // five rotations are few; what the angles of a box add is the same in both sessions
        let is_fine =
            ["believed", "too_few", "larger_than_needed"].iter().any(|verdict| errors["verdict"] == *verdict);
        assert!(is_fine, "{errors}");
        assert!(errors["counted"].as_u64().is_some_and(|counted| counted > 3), "{errors}");
    }
    assert!(bench.read("result/report.html").contains("On recording.csv"));
    // a face that is not used shows the face alignment
    bench.refuses(
        "calibrate table.toml one/recording.csv --folds 3 -o folds",
        2,
        &["folds say nothing where the directions of the holds are known"],
    );
}

/// Files of an IMU whose gyroscope has additional white noise: another range.
#[test]
fn another_recordings_noise_is_said_and_its_gyroscope_is_no_copy() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.run("simulate imu.toml --seed 5 -o one").done();
    bench.run("simulate imu.toml --seed 6 -o two").done();
    let (one, two) = (bench.read("one/recording.csv"), bench.read("two/recording.csv"));
    let (header, rows) = one.split_once('\n').expect("a header");
    let names: Vec<&str> = header.split(',').collect();
    let place = |name: &str| {
        names.iter().position(|column| column.starts_with(name)).unwrap_or_else(|| panic!("{name}: {header}"))
    };
    let rows: Vec<Vec<&str>> = rows.lines().map(|row| row.split(',').collect()).collect();
    let others: Vec<Vec<&str>> = two.lines().skip(1).map(|row| row.split(',').collect()).collect();
    let write = |name: &str, rows: &[Vec<String>]| {
        let text: String = rows.iter().map(|row| row.join(",") + "\n").collect();
        bench.write(name, format!("{header}\n{text}"));
    };
    let (first, last) = (place("gx"), place("gz"));
    let times = place("t");
    let owned = |row: &[&str]| -> Vec<String> { row.iter().map(|field| (*field).to_owned()).collect() };
    // its own gyroscope beside another accelerometer
    let beside = |(row, other): (&Vec<&str>, &Vec<&str>)| {
        let mut row = owned(row);
        for k in (0..row.len()).filter(|k| *k != times && !(first..=last).contains(k)) {
            row[k] = other[k].to_owned();
        }
        row
    };
    write("beside.csv", &rows.iter().zip(&others).map(beside).collect::<Vec<_>>());
    let at_other_times = |order: &dyn Fn(usize) -> usize| -> Vec<Vec<String>> {
        (0..rows.len())
            .map(|k| {
                let mut row = owned(&rows[order(k)]);
                row[times] = rows[k][times].to_owned();
                row
            })
            .collect()
    };
    let n = rows.len();
    write("exchanged.csv", &at_other_times(&|k| (k + n / 2) % n));
    let calibrate = "calibrate imu.toml one/recording.csv -o result";
    for (name, says) in [
        ("beside.csv", "beside.csv: its gyroscope has the data that were calibrated from"),
        ("exchanged.csv", "exchanged.csv: it has the data that were calibrated from"),
    ] {
        bench.refuses(&format!("{calibrate} --validate {name}"), 2, &[says, "--folds 5"]);
    }
    // the same sensor, its gyroscope five times as noisy: the seed draws the sensor, the rate changes the
    // noise
    let changes =
        [("# noise_radps = 2e-3 ", "noise_radps = 1e-2 "), ("gauge = ", "rate_hz = 80.0\ngauge = ")];
    bench.preset("imu", "noisy.toml", &changes);
    bench.run("simulate noisy.toml --seed 5 -o noisy").done();
    assert_eq!(bench.read("one/truth.json"), bench.read("noisy/truth.json"));
    let message = bench.run(&format!("{calibrate} --validate noisy/recording.csv")).done().stdout;
    assert!(
        message.contains("The gyroscope's noise is 5.0 times that of the calibration's recording"),
        "{message}"
    );
    let found = &bench.json("result/calibration.json")["validation"]["recording"];
    for kind in ["magnitude", "rate", "rotation"] {
        assert_eq!(found[kind]["verdict"], "believed", "{found}");
    }
    let ratio = &found["noise_ratio"]["gyroscope"][0];
    assert!(ratio.as_f64().is_some_and(|ratio| (ratio - 5.0).abs() < 0.3), "{found}");
}

#[test]
fn the_gyroscopes_columns_that_a_file_of_their_own_replaces_are_said() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.run("simulate imu.toml -o one").done();
    let command = "calibrate imu.toml one/recording.csv --gyroscope one/recording.csv -o result";
    let outcome = bench.run(command).done();
    for says in [
        "accelerometer: its own columns of the gyroscope, gx_radps, gy_radps, gz_radps, are left aside: the gyroscope is that of the other file",
        "gyroscope: its own columns of the accelerometer, ax_mps2, ay_mps2, az_mps2, are left aside",
    ] {
        assert!(outcome.stderr.contains(says), "{}", outcome.stderr);
    }
    let inspected = bench.run("inspect one/recording.csv one/recording.csv").done().printed();
    assert!(inspected.contains("its own columns of the gyroscope"), "{inspected}");
}
