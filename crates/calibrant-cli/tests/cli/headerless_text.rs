//! Tests of files without a header: the questions, and that the advice gives a result at once.

use crate::bench::{Bench, Outcome};

/// Twenty-four holds by hand and the turns between them, a row for each sample without a header. `columns`
/// selects from t, the accelerometer and the gyroscope, in units `gain` times finer than SI.
fn rows(bench: &Bench, columns: &[usize], gain: f64) -> String {
    let recording = bench.read("made/recording.csv");
    let cell = |cells: &[&str], column: usize| match cells[column].parse::<f64>().expect("a number") {
        t if column == 0 => format!("{t}"),
        reading if gain == 1.0 => format!("{reading}"),
        reading => format!("{}", (gain * reading).round() + 32768.0),
    };
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        columns.iter().map(|&column| cell(&cells, column)).collect::<Vec<_>>().join(" ") + "\n"
    };
    recording.lines().skip(1).map(row).collect()
}

fn bench() -> Bench {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    bench.preset("imu-counts", "counts.toml", &[]);
    bench.run("simulate imu.toml -o made").done();
    bench
}

/// The text with plain spaces between thousands.
fn plain(text: &str) -> String {
    text.replace(['\u{202f}', '\u{a0}'], " ")
}

/// The lines of [columns] that the message proposes.
fn proposed(outcome: &Outcome) -> String {
    assert_eq!(outcome.status, 3, "{outcome:?}");
    let (_, keys) = outcome.stderr.split_once("a line each, such as ").expect("keys");
    let keys = keys.rsplit_once(')').expect("an end").0;
    let line = |text: &str| text.replace("\", \"", "\",\"").replace(", ", "\n");
    format!("[columns]\n{}\n", line(keys))
}

#[test]
fn what_is_proposed_answers_every_question() {
    let bench = bench();
    for (columns, gain) in [
        (&[0, 1, 2, 3][..], 1.0),
        (&[0, 1, 2, 3], 500.0),
        (&[0, 1, 2, 3, 4], 1.0),
        (&[1, 2, 3], 500.0),
        (&[1, 2, 3, 4, 5, 6], 1.0),
        (&[0, 1, 2, 3, 4, 5, 6], 1.0),
        (&[0, 1, 2, 3, 4, 5, 6], 500.0),
    ] {
        bench.write("rows.txt", rows(&bench, columns, gain));
        bench.write("columns.toml", proposed(&bench.run("inspect rows.txt")));
        let message = bench.run("inspect rows.txt --columns columns.toml").done().stdout;
        assert!(message.contains("24 holds found"), "{columns:?}: {message}");
    }
    for (experiment, gain) in [("imu.toml", 1.0), ("counts.toml", 500.0)] {
        bench.write("rows.txt", rows(&bench, &[0, 1, 2, 3, 4, 5, 6], gain));
        let keys = proposed(&bench.run(&format!("calibrate {experiment} rows.txt -o out")));
        let text = bench.read(experiment);
        let with = match text.contains("[columns] ") {
            true => text.replace("[columns] ", &format!("{keys}# ")),
            false => text + &keys,
        };
        bench.write("with.toml", with);
        bench.run("calibrate with.toml rows.txt --no-report -o out").done();
    }
}

#[test]
fn a_pair_is_asked_for_both_units_at_once_and_told_file_by_file() {
    let bench = bench();
    bench.write("acc.mat", rows(&bench, &[0, 1, 2, 3], 500.0));
    let gyroscope = rows(&bench, &[0, 4, 5, 6], 5000.0);
    bench.write("gyro.mat", gyroscope.lines().skip(10).map(|row| format!("{row}\n")).collect::<String>());
    let asked = bench.run("inspect acc.mat --gyroscope gyro.mat");
    asked.says("acc.mat: the accelerometer's columns have no unit");
    asked.says("gyro.mat: the gyroscope's columns have no unit");
    asked.says("(say --accelerometer-unit m/s², mm/s², g, mg or counts (accelerometer_unit in [columns]; counts of a sensitivity");
    asked.says("--gyroscope-unit rad/s, deg/s, mdps or counts");
    let units = "--accelerometer-unit counts --gyroscope-unit counts";
    let message = bench.run(&format!("inspect acc.mat --gyroscope gyro.mat {units}")).done();
    assert_eq!(message.stderr, "", "nothing to warn of");
    for (file, rows, sensor) in [("acc.mat", "16 600", "accelerometer"), ("gyro.mat", "16 590", "gyroscope")]
    {
        let message = plain(&message.stdout);
        let from = message.find(&format!("{file}: imu_tk text, t x y z, {rows} rows\n")).expect("a heading");
        let table: Vec<&str> = message[from..].lines().skip(1).take(6).collect();
        assert!(table[3].contains(&format!("{sensor} x")), "{table:?}");
    }
    let json = bench.run(&format!("inspect acc.mat --gyroscope gyro.mat {units} --json")).done().json();
    assert_eq!((json["rows"].as_u64(), json["second_file"]["rows"].as_u64()), (Some(16_600), Some(16_590)));
    // another clock
    let later = |row: &str| {
        let (t, rest) = row.split_once(' ').expect("columns");
        format!("{} {rest}\n", t.parse::<f64>().expect("a time") + 1000.0)
    };
    bench.write("later.mat", gyroscope.lines().map(later).collect::<String>());
    let says = "no time of both; are they of one recording, and their times of one clock?";
    let warning = format!(
        "warning: acc.mat: accelerometer: it was recorded from 0 to 165.99 s, the gyroscope from 1000 to 1165.99 s: {says} [files-apart]"
    );
    let printed = bench.run(&format!("inspect acc.mat --gyroscope later.mat {units}")).done().printed();
    assert!(printed.contains(&warning), "{printed}");
    bench.refuses(
        "calibrate counts.toml acc.mat --gyroscope later.mat -o out",
        3,
        &[says, "the gyroscope has no samples in the holds of the accelerometer (both need the same clock"],
    );
}

#[test]
fn exchanged_files_are_asked_about() {
    let bench = bench();
    bench.write("acc.mat", rows(&bench, &[0, 1, 2, 3], 500.0));
    bench.write("gyro.mat", rows(&bench, &[0, 4, 5, 6], 5000.0));
    let says = "the accelerometer does not: are their files or columns exchanged?";
    let units = "--accelerometer-unit counts --gyroscope-unit counts";
    for (one, other, expected) in [("acc.mat", "gyro.mat", false), ("gyro.mat", "acc.mat", true)] {
        let message = bench.run(&format!("inspect {one} --gyroscope {other} {units}")).done().printed();
        assert_eq!(message.contains(says), expected, "{message}");
        let outcome =
            bench.run(&format!("calibrate counts.toml {one} --gyroscope {other} --no-report -o out"));
        assert_eq!(
            (outcome.status, outcome.stderr.contains(says)),
            (if expected { 4 } else { 0 }, expected),
            "{outcome:?}"
        );
    }
}

#[test]
fn a_table_of_many_columns_with_long_names_stays_legible() {
    let bench = Bench::new();
    let more: Vec<String> = (0..5000).map(|k| format!("{k}{}", "x".repeat(300))).collect();
    let row = |t: usize| format!("{},{t},{},9.8,1", vec!["7"; 5000].join(","), t % 2);
    let rows: Vec<String> = (0..3).map(row).collect();
    bench.write("wide.csv", format!("{},t_s,ax_mps2,ay_mps2,az_mps2\n{}\n", more.join(","), rows.join("\n")));
    let message = plain(&bench.run("inspect wide.csv").done().stdout);
    assert!(message.len() < 20_000 && message.contains("az_mps2"), "{}", message.len());
    assert!(message.contains("and 4950 more columns that are not used"), "{message}");
}

/// Times since 1970 in two files, which begin at different times.
#[test]
fn the_files_of_a_pair_keep_their_common_clock() {
    let bench = bench();
    let epoch = |columns: &[usize], header: &str, skip: usize| {
        let line = |row: &str| {
            let (t, rest) = row.split_once(' ').expect("columns");
            let t = t.parse::<f64>().expect("a time");
            format!("{},{}\n", 1_700_000_000_000_u64 + (1e3 * t).round() as u64, rest.replace(' ', ","))
        };
        format!("{header}\n{}", rows(&bench, columns, 1.0).lines().skip(skip).map(line).collect::<String>())
    };
    bench.write("acc.csv", epoch(&[0, 1, 2, 3], "t_ms,ax_mps2,ay_mps2,az_mps2", 0));
    bench.write("gyro.csv", epoch(&[0, 4, 5, 6], "t_ms,gx_radps,gy_radps,gz_radps", 300));
    let message = bench.run("inspect acc.csv --gyroscope gyro.csv").done().printed();
    assert!(message.contains("gyroscope: 16 300 samples from 3 to 165.99 s"), "{message}");
    assert!(
        message.contains(
            "accelerometer: times are counted from the first sample, where `t_ms` is 1700000000000 ms"
        ),
        "{message}"
    );
    assert_eq!(message.matches("times are counted from").count(), 1, "{message}");
}
