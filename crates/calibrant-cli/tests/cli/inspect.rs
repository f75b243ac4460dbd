//! Tests of `calibrant inspect`.

use crate::bench::Bench;
use crate::data::shared_data;

/// Twelve poses of three seconds at 50 Hz, turns of half a second between them, and a gyroscope.
fn poses(header: &str, unit_per_g: f64) -> String {
    let mut text = header.to_owned() + "\n";
    let mut t = 0;
    for pose in 0..12 {
        let angle = |pose: usize| [0.7 * pose as f64, 1.9 * pose as f64];
        for k in 0..175 {
            let (from, to) = (angle(pose), angle(pose + 1));
            let share = if k < 150 { 0.0 } else { (k - 150) as f64 / 25.0 };
            let [a, b] = [0, 1].map(|i| from[i] + share * (to[i] - from[i]));
            // a little noise that is the same every time
            let noise = |axis: u64| 0.002 * (((t * 7919 + axis * 104_729) % 1013) as f64 / 1013.0 - 0.5);
            let f = [a.sin() * b.cos(), a.sin() * b.sin(), a.cos()];
            let rate = if share > 0.0 { 1.4 } else { 0.0 };
            text += &format!("{}", 20 * t);
            for (axis, f) in f.iter().enumerate() {
                text += &format!(",{:.6}", unit_per_g * (f + noise(axis as u64)));
            }
            for axis in 0..3 {
                text += &format!(",{:.6}", rate + noise(3 + axis));
            }
            text += "\n";
            t += 1;
        }
    }
    text
}

#[test]
fn a_recording_is_described_before_it_is_calibrated() {
    let bench = Bench::new();
    bench.write("imu.csv", poses("t_ms,ax_g,ay_g,az_g,gx_radps,gy_radps,gz_radps", 1.0));
    let outcome = bench.run("inspect imu.csv").done();
    for words in [
        "imu.csv: CSV, 2100 rows",
        "ax_g",
        "accelerometer x",
        "50.000 Hz",
        "no gaps",
        "12 holds found",
        "directions: the largest gap is",
        "gyroscope in the holds: mean ",
        "Expected standard deviations of the accelerometer",
        "matrix.yz",
    ] {
        assert!(outcome.printed().contains(words), "{words}\n{}", outcome.stdout);
    }
    bench.write("inspection.json", bench.run("inspect imu.csv --json").done().stdout);
    let json = bench.json("inspection.json");
    assert_eq!((json["format"].as_str(), json["rows"].as_u64()), (Some("csv"), Some(2100)));
    assert_eq!(json["holds"]["count"], 12);
    assert_eq!(json["sensors"][1]["unit"], "rad/s");
    assert_eq!(json["columns"][0]["meaning"], "time");
    let sd = json["holds"]["expected"]["parameters"][0]["sd"].as_f64().expect("a number");
    assert!(sd > 1e-5 && sd < 5e-3, "{sd}");
}

#[test]
fn seconds_since_1970_are_told_as_they_stand_and_durations_beside_them() {
    let bench = Bench::new();
    let text = poses("t_s,ax_g,ay_g,az_g,gx_radps,gy_radps,gz_radps", 1.0);
    let later = |row: &str| match row.split_once(',') {
        Some((t, rest)) if t != "t_s" => {
            let ms: u64 = t.parse().expect("ms");
            // a second is missing
            let ms = 1_700_000_000_250 + ms + if ms > 20_000 { 1000 } else { 0 };
            format!("{}.{:03},{rest}\n", ms / 1000, ms % 1000)
        }
        _ => format!("{row}\n"),
    };
    bench.write("imu.csv", text.lines().map(later).collect::<String>());
    let message = bench.run("inspect imu.csv").done().printed();
    // 2100 rows at 50 Hz and the second: 41.98 s + 1 s
    let sampling = "2100 samples from 1700000000.25 s on, over 42.98 s, 50.000 Hz; steps 20.00 to 20.00 ms, jitter none; 1 gap of 1 s";
    assert!(message.contains(sampling), "{message}");
    assert!(
        message.contains("gap of 1.02 s after t = 1700000020.25 s: about 50 samples are missing"),
        "{message}"
    );
}

#[test]
fn tabs_and_spaces_may_both_separate_columns() {
    let bench = Bench::new();
    let text = poses("t_ms,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps", 9.8).replace(',', "\t");
    let message = |name: &str, text: String| {
        bench.write(name, text);
        let stdout = bench.run(&format!("inspect {name}")).done().stdout;
        stdout.split_once('\n').expect("lines").1.to_owned()
    };
    let plain = message("tabs.txt", text.clone());
    // the second tab of each line, of the rows alone, and of the header alone
    let mix = |line: &str| {
        let at = line.match_indices('\t').nth(1).expect("columns").0;
        format!("{}  {}", &line[..at], &line[at + 1..])
    };
    for (header, rows) in [(true, true), (false, true), (true, false)] {
        let line = |(k, line): (usize, &str)| {
            if (k == 0 && header) || (k > 0 && rows) { mix(line) } else { line.to_owned() }
        };
        let mixed: Vec<String> = text.lines().enumerate().map(line).collect();
        assert_eq!(message("mixed.txt", mixed.join("\n") + "\n"), plain, "{header} {rows}");
    }
}

#[test]
fn holds_in_which_the_accelerometer_saturates_are_named() {
    let bench = Bench::new();
    let cut = |line: &str| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        if let Ok(x) = cells[1].parse::<f64>() {
            cells[1] = format!("{:.6}", x.min(0.3));
        }
        cells.join(",") + "\n"
    };
    let text = poses("t_ms,ax_g,ay_g,az_g,gx_radps,gy_radps,gz_radps", 1.0);
    bench.write("imu.csv", text.lines().map(cut).collect::<String>());
    let printed = bench.run("inspect imu.csv").done().printed();
    // sin(0.7 k) cos(1.9 k) is above 0.3 for k = 3, 5, 8 and 10
    for hold in [4, 6, 9, 11] {
        let told = printed.split("warning: ").find(|told| told.starts_with(&format!("hold {hold} (")));
        let told = told.unwrap_or_else(|| panic!("{hold}: {printed}"));
        let says = "is not used: axis x of the accelerometer saturates at";
        assert!(told.contains(says) && told.contains("[hold-left-out]"), "{told}");
    }
    bench.write("inspection.json", bench.run("inspect imu.csv --json").done().stdout);
    let table = &bench.json("inspection.json")["holds"]["table"];
    assert_eq!((table[3]["saturated_axis"].as_str(), table[4]["saturated_axis"].as_str()), (Some("x"), None));
}

#[test]
fn questions_are_answered_by_options_or_by_an_experiment() {
    let bench = Bench::new();
    bench.write("imu.csv", poses("time,ax,ay,az,gx,gy,gz", 9.81));
    bench.refuses(
        "inspect imu.csv",
        3,
        &[
            "the accelerometer's columns have no unit: magnitudes around 9.81 suggest m/s²",
            "the gyroscope's columns have no unit: magnitudes up to 1.4 may be rad/s, or deg/s of slow turns",
            "the time column `time` has no unit: steps of 20 suggest ms",
        ],
    );
    let options = "--accelerometer-unit m/s2 --gyroscope-unit rad/s --time-unit ms";
    let expected = bench.run(&format!("inspect imu.csv {options}")).done().stdout;
    bench.preset("static-poses", "experiment.toml", &[(
        "\n[holds]",
        "\n[columns]\ntime_unit = \"ms\"\naccelerometer_unit = \"m/s²\"\ngyroscope_unit = \"rad/s\"\n\n[holds]",
    )]);
    assert_eq!(bench.run("inspect imu.csv --columns experiment.toml").done().stdout, expected);
    bench.preset("static-poses", "none.toml", &[]);
    bench.refuses("inspect imu.csv --columns none.toml", 2, &["none.toml: there is no [columns] section"]);
    bench.refuses(
        "inspect imu.csv --gyroscope-unit g",
        2,
        &["the gyroscope is in rad/s, deg/s, mdps or counts"],
    );
    bench.refuses("inspect imu.csv --format text", 2, &["the formats are mt-manager, movella-dot"]);
    bench.refuses("inspect absent.csv", 3, &["cannot read the recording"]);
}

#[test]
fn the_pair_of_imu_tk_promises_what_a_calibration_then_finds() {
    let (Some(accelerometer), Some(gyroscope)) =
        (shared_data("xsens-mti-static/xsens_acc.mat"), shared_data("xsens-mti-static/xsens_gyro.mat"))
    else {
        return;
    };
    let bench = Bench::new();
    std::fs::copy(accelerometer, bench.path("acc.mat")).expect("copied");
    std::fs::copy(gyroscope, bench.path("gyr.mat")).expect("copied");
    let units = "--accelerometer-unit counts --gyroscope-unit counts";
    let outcome = bench.run(&format!("inspect acc.mat gyr.mat {units}")).done();
    assert!(outcome.printed().contains("38 holds found"), "{}", outcome.stdout);
    bench.write(
        "inspection.json",
        bench.run(&format!("inspect acc.mat gyr.mat {units} --json")).done().stdout,
    );
    let json = bench.json("inspection.json");
    let expected = &json["holds"]["expected"];
    assert_eq!(expected["parameters"].as_array().map(Vec::len), Some(9));
    // the calibration's own standard deviations follow from the scatter between holds: larger, but not by
    // orders of magnitude
    bench.preset("static-poses-counts", "experiment.toml", &[]);
    bench.run("calibrate experiment.toml acc.mat -o result").done();
    let found = bench.json("result/calibration.json");
    for k in 0..9 {
        let sd = |json: &serde_json::Value| json["parameters"][k]["sd"].as_f64().expect("a number");
        let ratio = sd(&found) / sd(expected);
        assert!((0.9..30.0).contains(&ratio), "{k}: {ratio}");
    }
}

#[test]
fn times_in_another_unit_and_a_format_that_it_is_not_are_asked_about() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.run("simulate imu.toml --seed 1 -o sim").done();
    let text = bench.read("sim/recording.csv");
    let milliseconds = |line: &str| {
        let (time, rest) = line.split_once(',').expect("columns");
        let time = time.parse::<f64>().map_or_else(|_| time.to_owned(), |t| format!("{:.0}", 1e3 * t));
        format!("{time},{rest}\n")
    };
    bench.write("ms.csv", text.lines().map(milliseconds).collect::<String>());
    let says =
        "the samples are 10 s apart: are the times in ms? at 100 Hz the name of their column ends in _ms";
    let inspected = bench.run("inspect ms.csv").done().printed();
    assert!(inspected.contains(says), "{inspected}");
    bench.refuses("calibrate imu.toml ms.csv -o out", 3, &[says, "is the time column in seconds?"]);
    bench.refuses(
        "inspect --format imucal sim/recording.csv",
        3,
        &["this file has no column acc_x or gyr_x", "leave --format away"],
    );
}

/// A spike, lost samples and coarse readings: each is listed once with its code, in the JSON too, and can be denied and allowed.
#[test]
fn what_is_noticed_has_a_code_and_can_be_denied_and_allowed() {
    let bench = Bench::new();
    let text = poses("t_ms,ax_g,ay_g,az_g,gx_radps,gy_radps,gz_radps", 1.0);
    let header_and = |row: &dyn Fn(usize, Vec<String>) -> Option<Vec<String>>| {
        let cells = |line: &str| line.split(',').map(str::to_owned).collect();
        let rows = text.lines().enumerate().filter_map(|(k, line)| match k {
            0 => Some(line.to_owned()),
            _ => Some(row(k, cells(line))?.join(",")),
        });
        rows.collect::<Vec<_>>().join("\n") + "\n"
    };
    let spike = |k: usize, mut cells: Vec<String>| {
        if k == 60 {
            cells[2] = "9".to_owned();
        }
        Some(cells)
    };
    let coarse = |_: usize, mut cells: Vec<String>| {
        let fine: f64 = cells[3].parse().expect("a number");
        cells[3] = format!("{}", (fine / 0.05).round() * 0.05);
        Some(cells)
    };
    bench.write("spikes.csv", header_and(&spike));
    bench.write("coarse-steps.csv", header_and(&coarse));
    bench.write("sampling-gap.csv", header_and(&|k, cells| (k / 40 != 20).then_some(cells)));
    for (code, severity) in [("spikes", "warning"), ("coarse-steps", "warning"), ("sampling-gap", "note")] {
        let inspect = format!("inspect {code}.csv");
        let plain = bench.run(&inspect).done();
        let times = |outcome: &crate::bench::Outcome| outcome.printed().matches(&format!("[{code}]")).count();
        assert!(times(&plain) == 1 && plain.stderr.is_empty(), "{plain:?}");
        assert!(plain.printed().contains(&format!("{severity}: ")), "{plain:?}");
        let denied = bench.run(&format!("{inspect} --deny {code}")).ends_with(1);
        denied.says(&format!("error: denied: {code}: "));
        assert_eq!(denied.stdout, plain.stdout, "the result is the same");
        let status = if severity == "warning" { 1 } else { 0 };
        bench.run(&format!("{inspect} --deny warnings")).ends_with(status);
        let allowed = bench.run(&format!("{inspect} --deny warnings --deny {code} --allow {code}")).done();
        assert!(times(&allowed) == 0 && allowed.stderr.is_empty(), "{allowed:?}");
        for (option, severity) in [("", severity), (&*format!("--allow {code}"), "allowed")] {
            let json = bench.run(&format!("{inspect} --json {option}")).done().json();
            let findings = json["findings"].as_array().expect("a list");
            let found: Vec<_> = findings.iter().filter(|found| found["code"] == code).collect();
            assert!(found.len() == 1 && found[0]["severity"] == severity, "{findings:?}");
        }
    }
}

#[test]
fn holds_that_determine_nothing_are_a_note() {
    let bench = Bench::new();
    let text = poses("t_ms,ax_g,ay_g,az_g,gx_radps,gy_radps,gz_radps", 1.0);
    let one_pose: Vec<&str> = text.lines().take(150).collect();
    bench.write("rest.csv", one_pose.join("\n") + "\n");
    let outcome = bench.run("inspect rest.csv --deny warnings").done();
    let says = "note: the holds do not determine the accelerometer: ";
    assert!(outcome.printed().contains(says), "{outcome:?}");
    assert!(outcome.printed().contains("[holds-undetermined]"), "{outcome:?}");
    bench.run("inspect rest.csv --deny holds-undetermined").ends_with(1);
}
