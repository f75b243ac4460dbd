//! Tests of a whole IMU: simulated, calibrated, and compared with its truth.

use crate::bench::{Bench, assert_close_to_truth, names};
use serde_json::Value;

#[test]
fn a_simulated_imu_is_found_again_and_its_noise_in_a_long_hold() {
    let bench = Bench::new();
    let long = "minimum_hold_s = 1.0         # duration";
    bench.preset("imu", "imu.toml", &[(long, &format!("poses = 14\nhold_s = 25.0\nrate_hz = 50.0\n{long}"))]);
    bench.run("simulate imu.toml --seed 8 -o sim").done();
    let outcome = bench.run("calibrate imu.toml sim/recording.csv -o out").done();
    assert!(outcome.printed().contains("rad/s, from: Allan deviation of hold "), "{}", outcome.stdout);
    let calibration = bench.json("out/calibration.json");
    assert_close_to_truth(&calibration, &bench.json("sim/truth.json"));
    let noise = calibration["still_gyroscope"]["noise_per_sample_radps"].as_array().expect("axes").clone();
    // 1200 samples give the white noise to 4 % at best
    assert!(noise.iter().all(|sd| (sd.as_f64().expect("a number") / 2e-3 - 1.0).abs() < 0.15), "{noise:?}");
    // a given noise takes precedence
    let given = bench.read("imu.toml").replacen("# noise_radps = 2e-3 ", "noise_radps = 2e-3 ", 1);
    bench.write("given.toml", given);
    let outcome = bench.run("calibrate given.toml sim/recording.csv -o given").done();
    assert!(
        outcome.printed().contains("0.00200, 0.00200, 0.00200 rad/s, from: datasheet"),
        "{}",
        outcome.stdout
    );
}

#[test]
fn counts_are_simulated_with_gains_alone_and_turns_do_not_overlap() {
    let bench = Bench::new();
    bench.preset("imu-counts", "counts.toml", &[]);
    let wrote = bench.run("init imu-counts -o written.toml").done();
    let next = "with your recording.csv: calibrant calibrate written.toml recording.csv -o result";
    assert!(wrote.printed().contains(next), "{}", wrote.stdout);
    bench.refuses(
        "simulate counts.toml -o sim",
        2,
        &["a simulation of counts needs `sensor.gain_counts_per_mps2`"],
    );
    let gains = bench
        .read("counts.toml")
        .replacen(
            "unit = \"counts\" ",
            "gain_counts_per_mps2 = 415.0\noffset_counts = 32768.0\nunit = \"counts\" ",
            1,
        )
        .replacen("# gain_counts_per_radps", "gain_counts_per_radps", 1);
    bench.write("gains.toml", gains);
    bench.run("simulate gains.toml --seed 4 -o sim").done();
    assert!(bench.read("sim/recording.csv").starts_with("t_s,ax_counts,ay_counts,az_counts,gx_counts,"));
    bench.run("calibrate gains.toml sim/recording.csv -o out").done();
    assert_close_to_truth(&bench.json("out/calibration.json"), &bench.json("sim/truth.json"));

    let table = include_str!("../../../../examples/06_whole_imu/table.toml");
    bench.write("table.toml", table.replacen("start_s = 7.0", "start_s = 5.0", 1));
    bench.refuses(
        "simulate table.toml -o table",
        2,
        &["begins at 5 s begins before what is done until 6 s is over"],
    );
}

/// Values far from those that are drawn otherwise: 0.1 m/s² around 0, 0.02 rad/s around 0, 1 % around 1.
#[test]
fn what_the_experiment_knows_is_true_of_the_simulated_imu() {
    let bench = Bench::new();
    let known = r#"[known]
"gyroscope.bias.x" = 0.25
"gyroscope.scale.y" = { value = 1.3, sd = 1e-3 }
"accelerometer.bias.z" = { value = 3.0, sd = 0.01 }"#;
    bench.preset("imu", "hand.toml", &[("[known] ", &format!("{known} "))]);
    let table = include_str!("../../../../examples/06_whole_imu/table.toml");
    bench.write("table.toml", format!("{table}\n{known}\n"));
    for name in ["hand", "table"] {
        bench.run(&format!("simulate {name}.toml --seed 5 -o {name}")).done();
        bench.run(&format!("calibrate {name}.toml {name}/recording.csv -o {name}/out")).done();
        let (truth, found) =
            (bench.json(&format!("{name}/truth.json")), bench.json(&format!("{name}/out/calibration.json")));
        let of = |file: &Value, parameter: &str, field: &str| -> Option<f64> {
            let list = file["parameters"].as_array().expect("an array");
            list.iter().find(|entry| entry["name"] == parameter)?[field].as_f64()
        };
        let truth_of = |parameter: &str| of(&truth, parameter, "value").expect("drawn");
        assert!((truth_of("gyroscope.bias.x") - 0.25).abs() < 1e-15);
        for (parameter, value, sd) in [("gyroscope.scale.y", 1.3, 1e-3), ("accelerometer.bias.z", 3.0, 0.01)]
        {
            let error = (truth_of(parameter) - value) / sd;
            assert!(error != 0.0 && error.abs() < 4.0, "{name}: {parameter} {error}");
        }
        let all: Vec<&str> = names(&truth["parameters"]);
        assert_eq!(names(&found["parameters"]).len() + 1, all.len(), "one is fixed");
        for parameter in all.into_iter().filter(|parameter| *parameter != "gyroscope.bias.x") {
            let (value, sd) = (of(&found, parameter, "value"), of(&found, parameter, "sd"));
            let (value, sd) = (value.expect("estimated"), sd.expect("estimated"));
            assert!((value - truth_of(parameter)).abs() < 5.0 * sd, "{name}: {parameter} {value} ± {sd}");
        }
    }
}

#[test]
fn without_a_report_the_calibration_is_the_same() {
    let bench = Bench::new();
    for (preset, recording) in [("imu", "imu/recording.csv"), ("static-poses", "static-poses/recording.csv")]
    {
        let file = format!("{preset}.toml");
        bench.preset(preset, &file, &[]);
        bench.run(&format!("simulate {file} --seed 3 -o {preset}")).done();
        bench.run(&format!("calibrate {file} {recording} -o {preset}/with")).done();
        let outcome =
            bench.run(&format!("calibrate {file} {recording} --no-report -o {preset}/without")).done();
        assert!(outcome.stdout.trim_end().ends_with("calibration.json"), "{}", outcome.stdout);
        assert!(!bench.path(&format!("{preset}/without/report.html")).exists());
        let read = |of: &str| bench.read(&format!("{preset}/{of}/calibration.json"));
        assert_eq!(read("with"), read("without"));
        let outcome = bench.run(&format!("calibrate {file} {recording} --no-report -o {preset}/with")).done();
        assert!(outcome.stderr.contains("report.html is that of an earlier run"), "{}", outcome.stderr);
    }
}

#[test]
fn faces_whose_directions_the_readings_contradict_are_named() {
    let bench = Bench::new();
    let table = include_str!("../../../../examples/06_whole_imu/table.toml");
    bench.write("table.toml", table);
    bench.run("simulate table.toml --seed 3 -o table").done();
    let given = |directions: &str| {
        bench.write("given.toml", table.replacen(r#""x", "-x", "y", "-y", "z", "-z""#, directions, 1));
        "calibrate given.toml table/recording.csv -o out"
    };
    let second = "hold 2 (19.0 to 24.0 s) is given with x up, but the accelerometer shows -x up";
    bench.refuses(given(r#""x", "x", "y", "-y", "z", "-z""#), 2, &[second, "correct the directions"]);
    // whatever face alignment is given
    let met = table.replacen("[holds]", "[holds]\nface_sd_deg = 0.1", 1);
    bench.write("met.toml", met.replacen(r#""x", "-x""#, r#""x", "x""#, 1));
    bench.refuses("calibrate met.toml table/recording.csv -o out", 2, &[second]);
    let first = "hold 1 (1.0 to 6.0 s) is given with -x up, but the accelerometer shows x up";
    bench.refuses(given(r#""-x", "x", "y", "-y", "z", "-z""#), 2, &[first, second]);
    let third = "hold 3 (27.0 to 32.0 s) is given with z up, but the accelerometer shows y up";
    bench.refuses(given(r#""x", "-x", "z", "-y", "y", "-z""#), 2, &[third, "hold 5 (53.0 to 58.0 s)"]);
    let opposite = "every direction is the opposite";
    bench.refuses(given(r#""-x", "x", "-y", "y", "-z", "z""#), 2, &[opposite, "gravity in place of"]);
    // a direction that is wrong by 20°: with two faces for each axis, either may be the wrong one
    let tilted = bench.run(given(r#"[0.94, 0.34, 0.0], "-x", "y", "-y", "z", "-z""#));
    tilted.says("in hold 1 (1.0 to 6.0 s), or hold 2 (19.0 to 24.0 s)");
    // all faces turned together: the sensor sits otherwise in its housing, and the program says so
    bench
        .run(given(r#""y", "-y", "z", "-z", "x", "-x""#))
        .ends_with(5)
        .says("All directions are rotated in the same way");
}

/// A spike in the hold whose Allan deviation gives the noise of the gyroscope's samples.
#[test]
fn an_outlier_of_the_gyroscope_is_not_taken_for_its_noise() {
    let bench = Bench::new();
    let hand =
        include_str!("../../../../examples/06_whole_imu/hand.toml").replace("hold_s = 3.0", "hold_s = 25.0");
    bench.write("hand.toml", &hand);
    bench.run("simulate hand.toml --seed 3 -o hand").done();
    let noise = |file: &str| {
        let outcome = bench.run(&format!("calibrate hand.toml {file} --no-report -o out")).done();
        let printed = outcome.printed();
        let message = printed.split("gyroscope's noise x, y, z ").nth(1).unwrap_or_default().to_owned();
        let first: f64 = message.split(',').next().and_then(|n| n.parse().ok()).unwrap_or(f64::NAN);
        (first, message, outcome.stderr)
    };
    let (clean, message, _) = noise("hand/recording.csv");
    assert!(message.contains("Allan deviation of hold"), "{message}");
    let number = message.split("hold ").nth(1).and_then(|n| n.split(' ').next()).expect("a number");
    let number: f64 = number.parse().expect("a number");
    // turns between holds are shorter than half a hold: the middle of this one
    let text = bench.read("hand/recording.csv");
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let period = lines.len() as f64 / 24.0;
    let at = 1 + ((number - 0.5) * period) as usize;
    let mut fields: Vec<String> = lines[at].split(',').map(str::to_owned).collect();
    // fifteen standard deviations: one that is larger ends the hold
    fields[4] = (fields[4].parse::<f64>().expect("a number") + 0.03).to_string();
    lines[at] = fields.join(",");
    bench.write("spark.csv", lines.join("\n") + "\n");
    let (spiked, message, stderr) = noise("spark.csv");
    assert!((spiked / clean - 1.0).abs() < 0.01, "{spiked} {clean}: {message}");
    assert!(
        stderr.contains("gyroscope: 1 sample is a spike and was replaced")
            && stderr.contains("15 standard deviations"),
        "{stderr}"
    );
}

#[test]
fn turns_that_are_missing_and_values_that_are_absurd_are_named() {
    let bench = Bench::new();
    let table = include_str!("../../../../examples/06_whole_imu/table.toml");
    bench.write("table.toml", table);
    bench.run("simulate table.toml --seed 3 -o table").done();
    let about_x: Vec<&str> = table
        .lines()
        .filter(|line| !line.contains("axis = \"y\"") && !line.contains("axis = \"z\""))
        .collect();
    bench.write("x.toml", about_x.join("\n"));
    bench.refuses(
        "calibrate x.toml table/recording.csv -o out",
        4,
        &[
            "the 2 turns of known angle are about x only",
            "add a turn about y and z",
            "y_rot and z_rot in the list of sections",
        ],
    );

    // a turn that is given twice would count twice
    bench.write(
        "twice.toml",
        table.replacen("start_s = 12.0, end_s = 16.0", "start_s = 7.0, end_s = 11.0", 1),
    );
    bench.refuses(
        "calibrate twice.toml table/recording.csv -o out",
        2,
        &["turn 2 (7 to 11 s) is turn 1 (7 to 11 s) once more", "give each turn once"],
    );

    // the gyroscope shows which turn was made
    bench.write(
        "sign.toml",
        table.replacen("axis = \"x\", angle_deg = 360.0", "axis = \"x\", angle_deg = -360.0", 1),
    );
    let first = "turn 1 (7.0 to 11.0 s) is given as -360.0° about x, but the gyroscope shows 360° about x";
    let sign = "calibrate sign.toml table/recording.csv -o out";
    bench.refuses(sign, 2, &[first, "correct axis, angle or times of the turn"]);
    let outcome = bench.run(sign);
    assert!(!outcome.stderr.contains("turn 2"), "{}", outcome.stderr);
    bench.write("axis.toml", table.replacen("end_s = 11.0, axis = \"x\"", "end_s = 11.0, axis = \"y\"", 1));
    let first = "turn 1 (7.0 to 11.0 s) is given as 360.0° about y, but the gyroscope shows 360° about x";
    bench.refuses("calibrate axis.toml table/recording.csv -o out", 2, &[first]);

    // a fault of all turns is not the fault of each
    bench.write(
        "double.toml",
        table
            .replace("angle_deg = 360.0", "angle_deg = 720.0")
            .replace("angle_deg = -360.0", "angle_deg = -720.0"),
    );
    let double = "calibrate double.toml table/recording.csv -o out";
    let share = "the gyroscope shows 0.500 of the angle of every turn";
    bench.refuses(double, 3, &[share, "the sample rate, or the angle of the turns"]);
    let outcome = bench.run(double);
    assert!(!outcome.stderr.contains("turn 1"), "{}", outcome.stderr);
    // radians in place of degrees, in all turns and in one
    let radians = |count: usize| {
        let of = |table: String, degrees: &str, radians: &str| table.replacen(degrees, radians, count);
        let table = of(table.to_owned(), "angle_deg = 360.0", "angle_deg = 6.283");
        of(table, "angle_deg = -360.0", if count > 1 { "angle_deg = -6.283" } else { "angle_deg = -360.0" })
    };
    for (name, count, status, says) in [
        (
            "radians.toml",
            99,
            3,
            "of the angle of every turn: a ratio of about 180/π. Is the angle in radians where degrees are expected",
        ),
        (
            "one.toml",
            1,
            2,
            "turn 1 (7.0 to 11.0 s) is given as 6.3° about x, but the gyroscope shows 360° about x, a ratio of about 180/π. Is the angle in radians",
        ),
    ] {
        bench.write(name, radians(count));
        bench.refuses(&format!("calibrate {name} table/recording.csv -o out"), status, &[says]);
    }

    let hand = include_str!("../../../../examples/06_whole_imu/hand.toml");
    bench.write("hand.toml", hand);
    bench.run("simulate hand.toml --seed 3 -o hand").done();
    let known = |what: &str| {
        bench.write("known.toml", format!("{hand}\n[known]\n{what}\n"));
        "calibrate known.toml hand/recording.csv -o out"
    };
    // the recording is not to blame
    for (what, value) in [
        ("gyroscope.scale.x", "0.0"),
        ("gyroscope.bias.x", "1000.0"),
        ("gyroscope.matrix.xy", "100000000000.0"),
        ("accelerometer.bias.x", "100.0"),
        ("accelerometer.scale.x", "0.0"),
    ] {
        let says = format!("the recording contradicts {what} in [known]: the given value is {value}");
        bench.refuses(
            known(&format!("\"{what}\" = {value}")),
            2,
            &[&says, "but the recording alone gives", "correct the value in [known]"],
        );
    }
    let prior = known("\"gyroscope.scale.x\" = { value = 1.0, sd = 1e-200 }");
    bench.refuses(prior, 2, &["`known.gyroscope.scale.x.sd`: 1e-200 is out of range", "from 1e-12"]);
    // by hundreds of standard deviations: nothing of the result is right
    let outcome = bench.run(known("\"accelerometer.bias.x\" = 0.5")).ends_with(5);
    outcome.says("warning: the recording contradicts accelerometer.bias.x in [known]");
    outcome.says("the data refute a given value");

    // a gyroscope that senses no turn about two axes
    let dead: Vec<String> = bench
        .read("hand/recording.csv")
        .lines()
        .enumerate()
        .map(|(k, line)| {
            let words: Vec<&str> = line.split(',').collect();
            let noise = |shift: usize| 1e-3 * ((k * 7919 + shift) % 13) as f64;
            match k {
                0 => line.to_owned(),
                _ => format!("{},{},{},{}", words[..4].join(","), noise(0), noise(5), words[6]),
            }
        })
        .collect();
    bench.write("dead.csv", dead.join("\n"));
    bench.refuses(
        "calibrate hand.toml dead.csv -o out",
        3,
        &[
            "the gyroscope hardly turns about its axes x and y: by less than 1° between two holds",
            "while gravity turns by up to",
            "is each axis connected?",
        ],
    );
}

#[test]
fn a_simulation_fits_into_memory() {
    let bench = Bench::new();
    let hand = include_str!("../../../../examples/06_whole_imu/hand.toml");
    bench.write("many.toml", hand.replacen("poses = 24", "poses = 1000000000", 1));
    bench.refuses(
        "simulate many.toml -o out",
        2,
        &["`holds.poses`: 1000000000 is out of range", "from 1 to 1000000"],
    );
    bench.write("large.toml", hand.replacen("poses = 24", "poses = 1000000", 1));
    bench.refuses("simulate large.toml -o out", 2, &["5.0e8 samples (5000000 s at 100 Hz) would"]);
    let table = include_str!("../../../../examples/06_whole_imu/table.toml");
    bench.write("late.toml", table.replacen("[71.0, 76.0]", "[71.0, 7.6e6]", 1));
    bench.refuses(
        "simulate late.toml -o out",
        2,
        &["7.6e8 samples (7600000 s at 100 Hz) would take about 71 GiB of memory"],
    );
}

#[test]
fn turns_give_the_gain_of_a_gyroscope_in_counts() {
    /// Gain of the gyroscope.
    const GAIN: f64 = 940.0;
    let bench = Bench::new();
    let table = include_str!("../../../../examples/06_whole_imu/table.toml");
    bench.write("table.toml", table);
    bench.run("simulate table.toml --seed 3 -o sim").done();
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let counts = |field: &str| (GAIN * field.parse::<f64>().expect("a number")).round().to_string();
        [fields[..4].join(","), fields[4..].iter().map(|field| counts(field)).collect::<Vec<_>>().join(",")]
            .join(",")
    };
    let recording = bench.read("sim/recording.csv");
    let rows: Vec<String> = recording.lines().skip(1).map(row).collect();
    bench.write(
        "counts.csv",
        format!("t_s,ax_mps2,ay_mps2,az_mps2,gx_counts,gy_counts,gz_counts\n{}\n", rows.join("\n")),
    );
    let counts = table.replacen("unit = \"radps\"", "unit = \"counts\"", 1);
    bench.write("counts.toml", counts);
    bench.run("calibrate counts.toml counts.csv -o out").done();
    let (found, truth) = (bench.json("out/calibration.json"), bench.json("sim/truth.json"));
    let value = |json: &Value, name: &str| {
        let parameters = json["parameters"].as_array().expect("parameters");
        let of = parameters.iter().find(|of| of["name"] == name).unwrap_or_else(|| panic!("{name}"));
        ["estimate", "value"].iter().find_map(|key| of[key].as_f64()).unwrap_or_else(|| panic!("{of}"))
    };
    for axis in ["x", "y", "z"] {
        let name = format!("gyroscope.scale.{axis}");
        let ratio = value(&found, &name) / (GAIN * value(&truth, &name));
        // the angles are within 0.1° of 360°
        assert!((ratio - 1.0).abs() < 1e-3, "{name}: {ratio}");
    }
}

/// The message names the key of the experiment file that the recording contradicts, not an option that was
/// not given.
#[test]
fn a_unit_that_the_recording_contradicts_is_named_by_its_key() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.run("simulate imu.toml -o sim").done();
    let preset = bench.read("imu.toml");
    let gyroscope = preset.replacen("# unit = \"degps\"", "unit = \"degps\"", 1);
    bench.write("gyroscope.toml", &gyroscope);
    bench.write("columns.toml", preset.replacen("# gyroscope_unit = ", "gyroscope_unit = ", 1));
    for (experiment, key) in [("gyroscope", "gyroscope.unit"), ("columns", "columns.gyroscope_unit")] {
        let command = format!("calibrate {experiment}.toml sim/recording.csv -o out");
        let says = format!("{experiment}.toml: `{key}` is deg/s, but the recording states another unit");
        bench.refuses(&command, 2, &[&says]);
    }
    // an option is named as one; other faults get their own message
    bench.refuses(
        "calibrate gyroscope.toml sim/recording.csv --gyroscope-unit deg/s -o out",
        3,
        &["leave --gyroscope-unit (or --unit) away"],
    );
    bench.refuses("calibrate gyroscope.toml none.csv -o out", 3, &["none.csv"]);
}

#[test]
fn without_a_gyroscope_the_accelerometer_is_calibrated_and_the_result_says_so() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.run("simulate imu.toml -o sim").done();
    let alone = |line: &str| line.split(',').take(4).collect::<Vec<_>>().join(",") + "\n";
    bench.write("alone.csv", bench.read("sim/recording.csv").lines().map(alone).collect::<String>());
    let outcome = bench.run("calibrate imu.toml alone.csv -o out").done();
    assert!(outcome.stdout.starts_with("verdict: doubtful (gyroscope-missing)"), "{outcome:?}");
    let calibration = bench.json("out/calibration.json");
    assert!(calibration.get("gyroscope").is_none_or(Value::is_null), "{calibration}");
    let mut truth = bench.json("sim/truth.json");
    let of_accelerometer =
        |of: &Value| of["name"].as_str().is_some_and(|name| name.starts_with("accelerometer."));
    truth["parameters"].as_array_mut().expect("a list").retain(of_accelerometer);
    assert_close_to_truth(&calibration, &truth);
    // it is tried on its like, and on a recording of both sensors
    bench.run("simulate imu.toml --seed 7 -o other").done();
    bench.write("other.csv", bench.read("other/recording.csv").lines().map(alone).collect::<String>());
    for other in ["other.csv", "other/recording.csv"] {
        let outcome =
            bench.run(&format!("calibrate imu.toml alone.csv --validate {other} -o validated")).done();
        assert!(outcome.printed().contains("validation"), "{outcome:?}");
    }
    // in a batch it stands among the others
    let outcome = bench.run("calibrate imu.toml alone.csv sim/recording.csv --no-report -o batch").done();
    assert!(
        outcome
            .stdout
            .starts_with("Yield 50 %: 1 of 2 sensors ok.\n\n  0 bad, 1 doubtful, 0 without a result."),
        "{outcome:?}"
    );
    // the table is wide: the row continues below
    let rows = outcome.stdout.lines().filter(|line| line.trim_start().starts_with("alone "));
    let rows: Vec<Vec<&str>> =
        rows.map(|row| row.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect()).collect();
    assert_eq!(rows.len(), 2, "{outcome:?}");
    assert_eq!(rows[0][..4], ["alone", "doubtful", "24 of 24", "–"], "{rows:?}");
    assert_eq!(rows[0][5..], ["–"], "{rows:?}");
    assert_eq!(rows[1], ["alone", "gyroscope-missing"], "{rows:?}");
}

/// A gain that is far off is asked about, and stated with a standard deviation it is not.
#[test]
fn an_unusual_gain_may_be_stated() {
    let bench = Bench::new();
    bench.preset("imu", "hand.toml", &[]);
    bench.run("simulate hand.toml -o hand").done();
    let larger = |line: &str| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if let Ok(value) = cells[1].parse::<f64>() {
            cells[1] = (1.12 * value).to_string();
        }
        cells.join(",")
    };
    let text: Vec<String> = bench.read("hand/recording.csv").lines().map(larger).collect();
    bench.write("larger.csv", text.join("\n") + "\n");
    let codes = |experiment: &str| {
        bench.run(&format!("calibrate {experiment} larger.csv --no-report -o out"));
        bench.json("out/calibration.json")["verdict"]["codes"].to_string()
    };
    assert!(codes("hand.toml").contains("gain-unusual"));
    let known = r#"[known]
"accelerometer.scale.x" = { value = 1.1, sd = 0.03 }
"#;
    bench.preset("imu", "stated.toml", &[("[known] ", &format!("{known} "))]);
    let stated = codes("stated.toml");
    assert!(!stated.contains("gain-unusual"), "{stated}");
}
