//! Tests of `calibrate --records` and of `calibrant records`: what is kept, what is asked, several writers, and a writer that is killed.

use crate::bench::Bench;
use std::process::{Child, Command, Stdio};

const CALIBRATE: &str = "calibrate experiment.toml --motion motion.csv --no-report";

/// Six recordings of each of several dates, in files as `s1_2026-05-01.csv`; each date with a bias of its own.
fn dated(dates: &[&str]) -> Bench {
    let bench = Bench::new();
    bench.six_sensors();
    for (k, date) in dates.iter().enumerate() {
        for sensor in 1..=6 {
            let text = bench.read(&format!("s{sensor}.csv"));
            let (header, rows) = text.split_once('\n').expect("a header");
            let shifted = |row: &str| {
                let mut fields: Vec<f64> = row.split(',').map(|f| f.parse().expect("a number")).collect();
                fields[1] += 0.01 * k as f64;
                fields.iter().map(|field| format!("{field:?}")).collect::<Vec<_>>().join(",") + "\n"
            };
            let rows: String = rows.lines().map(shifted).collect();
            bench.write(&format!("line/s{sensor}_{date}.csv"), format!("{header}\n{rows}"));
        }
    }
    bench
}

/// A calibration of all recordings of a date, into a folder of that name.
fn of_date(date: &str) -> String {
    let recordings: Vec<String> = (1..=6).map(|k| format!("line/s{k}_{date}.csv")).collect();
    format!(
        "{CALIBRATE} --sensor-from {{sensor}}_{{date}} --station L1 --records r.db -o {date} {}",
        recordings.join(" ")
    )
}

/// Starts the program.
fn spawn(bench: &Bench, arguments: &str) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calibrant"));
    command.args(arguments.split_whitespace()).current_dir(bench.path("."));
    command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("the program runs")
}

/// The rows of the list, up to where the table continues with further columns, their words joined by one space.
fn listed(bench: &Bench) -> Vec<String> {
    let list = bench.run("records list r.db").done().stdout;
    let rows = list.lines().skip(2).take_while(|line| !line.is_empty());
    rows.map(|row| row.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
}

#[test]
fn a_result_says_its_sensor_its_date_its_station_and_its_experiment() {
    let bench = dated(&["2026-05-01"]);
    let one = "line/s1_2026-05-01.csv";
    bench.run(&format!("{CALIBRATE} {one} --sensor-from {{sensor}}_{{date}} --station L1 -o a")).done();
    let result = bench.json("a/calibration.json");
    assert_eq!(result["sensor"], "s1");
    assert_eq!(result["recorded"], "2026-05-01");
    assert_eq!(result["station"], "L1");
    assert_eq!(result["experiment"]["file"], "experiment.toml");
    assert_eq!(result["motion_file"]["file"], "motion.csv");
    for file in [&result["experiment"], &result["motion_file"], &result["inputs"][0]] {
        assert_eq!(file["sha256"].as_str().expect("a hash").len(), 64);
    }
    // without a name, the file's; without a date, none, and never the clock
    bench.run(&format!("{CALIBRATE} s1.csv -o b")).done();
    let bare = bench.json("b/calibration.json");
    assert_eq!(bare["sensor"], "s1");
    assert!(bare.get("recorded").is_none() && bare.get("station").is_none(), "{bare}");
    bench.run(&format!("{CALIBRATE} s1.csv --sensor SN7 -o b")).done();
    assert_eq!(bench.json("b/calibration.json")["sensor"], "SN7");

    bench.refuses(&format!("{CALIBRATE} s1.csv s2.csv --sensor SN7 -o c"), 2, &["--sensor names one sensor"]);
    bench.refuses(
        &format!("{CALIBRATE} s1.csv --sensor-from {{serial}} -o c"),
        2,
        &["{serial}", "placeholders are {sensor}"],
    );
    let wrong = bench.run(&format!("{CALIBRATE} s1.csv --sensor-from {{sensor}}_{{date}} -o c")).ends_with(2);
    wrong.says("s1.csv: the name of this file is not of the pattern");
}

#[test]
fn times_since_1970_are_the_date_of_a_recording() {
    let bench = Bench::new();
    let moved = |(k, row): (usize, &str)| match k {
        0 => row.to_owned() + "\n",
        _ => {
            let (time, rest) = row.split_once(',').expect("columns");
            let milliseconds = (1e3 * time.parse::<f64>().expect("a time")).round() as i64;
            format!("{},{rest}\n", 1_777_624_200_000 + milliseconds)
        }
    };
    bench.preset("static-poses", "poses.toml", &[]);
    bench.run("simulate poses.toml -o made").done();
    let text = bench.read("made/recording.csv").replace("t_s,", "t_ms,");
    bench.write("epoch.csv", text.lines().enumerate().map(moved).collect::<String>());
    bench.run("calibrate poses.toml epoch.csv --no-report -o b").done();
    assert_eq!(bench.json("b/calibration.json")["recorded"], "2026-05-01T08:30:00Z");
}

#[test]
fn a_line_is_recorded_listed_shown_compared_and_exported() {
    let dates = ["2024-05-01", "2025-05-01", "2026-05-01"];
    let bench = dated(&dates);
    for date in dates {
        bench.run(&of_date(date)).ends_with(5);
    }
    let rows = listed(&bench);
    assert_eq!(rows.len(), 18, "{rows:?}");
    assert!(rows[0].contains("s1 2024-05-01 L1") && rows[1].contains("s1 2025-05-01"), "{rows:?}");
    let bad = bench.run("records list r.db --verdict bad --json").done().list("records");
    let sensors: Vec<&str> =
        bad.as_array().expect("an array").iter().map(|row| row["sensor"].as_str().expect("a name")).collect();
    assert_eq!(sensors, ["s4", "s4", "s4"], "the gain of the fourth is far off");

    // what the records show is what the result says
    let result = bench.json("2025-05-01/s1_2025-05-01/calibration.json");
    let id = &bench.run("records list r.db --sensor s1 --json").done().list("records")[1]["id"];
    bench.write("shown.json", bench.run(&format!("records show r.db {id} --json")).done().stdout);
    let shown = bench.json("shown.json");
    for field in
        ["program", "sensor", "recorded", "station", "experiment", "verdict", "status", "accelerometer"]
    {
        assert_eq!(shown[field], result[field], "{field}");
    }
    for (one, other) in [("name", "name"), ("value", "value"), ("sd", "sd"), ("unit", "unit")] {
        assert_eq!(shown["parameters"][4][one], result["parameters"][4][other]);
    }
    // of the covariance, the records keep the lower triangle: it is symmetric but for the last bit
    for (i, row) in result["covariance"].as_array().expect("rows").iter().enumerate() {
        for j in 0..=i {
            assert_eq!(shown["covariance"][i][j], row[j]);
        }
    }
    let compared = bench.run("compare shown.json 2025-05-01/s1_2025-05-01/calibration.json").done().stdout;
    assert!(compared.contains("χ² 0 with"), "{compared}");
    let words = bench.run(&format!("records show r.db {id}")).done().stdout;
    assert!(words.starts_with(&format!("calibration {id} of sensor s1: ok\n")), "{words}");
    assert!(words.contains("accelerometer.bias.x"), "{words}");

    // the bias in x was shifted by 0.01 m/s² a year
    let history = bench.run("records drift r.db s1 --json").done().json();
    let aging = |k: usize, field: &str| history["aging"][k][field].as_f64().expect("a number");
    assert_eq!(history["aging"][0]["name"], "accelerometer.bias.x");
    assert!((aging(0, "per_year") - 0.01).abs() < 1e-4, "{}", history["aging"][0]);
    assert!(aging(0, "p_value") < 1e-6 && aging(1, "p_value") > 0.9, "{}", history["aging"]);
    assert_eq!(history["changes"].as_array().expect("an array").len(), 2);
    assert!(history["changes"][0]["overall"]["p_value"].as_f64().expect("a number") < 1e-6);
    let direct = bench.run("compare 2024-05-01/s1_2024-05-01/calibration.json 2025-05-01/s1_2025-05-01/calibration.json --json").done().json();
    let chi2 = |overall: &serde_json::Value| overall["chi2"].as_f64().expect("a number");
    // but for the rounding of a covariance that is symmetric
    let ratio = chi2(&history["changes"][0]["overall"]) / chi2(&direct["overall"]);
    assert!((ratio - 1.0).abs() < 1e-12, "{ratio}");
    let table = bench.run("records drift r.db s1").done();
    let table = table.printed();
    assert!(table.starts_with("sensor s1: 3 calibrations, 3 with a date and not bad"), "{table}");
    assert!(table.contains("accelerometer.bias.x +"), "{table}");
    let bad = bench.run("records drift r.db s4").done().stdout;
    assert!(bad.contains("no aging"), "{bad}");
    let drifts = bench.run("records drift r.db --json").done().list("drift");
    assert_eq!(drifts[0]["calibrations"], 3, "{drifts}");
    let all = bench.run("records drift r.db").done().printed();
    assert!(
        all.contains("p below 0.01: last change 6 of 6, where chance alone gives 0.06; aging 5 of 5"),
        "{all}"
    );
    let fleet = bench.run("records fleet r.db").done();
    assert!(fleet.printed().contains(" accelerometer.bias.x 5 "), "{}", fleet.stdout);

    let fleet = bench.run("records fleet r.db --json").done().json();
    assert_eq!(fleet["parameters"][0]["sensors"], 5);
    assert_eq!(fleet["left_out"], serde_json::json!([]));

    bench.run("records export r.db -o t.csv --latest").done();
    let csv = bench.read("t.csv");
    let header = csv.lines().next().expect("a header");
    assert!(
        header.starts_with("id,sensor,recorded,station,verdict,codes,status,plan,program,experiment,"),
        "{header}"
    );
    assert!(header.contains(",accelerometer.bias.x_mps2,accelerometer.bias.x_sd_mps2,"), "{header}");
    assert_eq!(csv.lines().count(), 1 + 18);
    let value = result["parameters"][0]["value"].as_f64().expect("a number");
    assert!(csv.contains(&format!(",{value:?},")), "to the last bit");
    bench.refuses("records export r.db -o t.xlsx", 2, &["neither .csv nor .parquet"]);
}

#[test]
fn calibrations_that_are_there_become_records_once() {
    let bench = dated(&["2026-05-01"]);
    bench.run(&of_date("2026-05-01").replace("--records r.db", "")).ends_with(5);
    let files: Vec<String> =
        (1..=6).map(|k| format!("2026-05-01/s{k}_2026-05-01/calibration.json")).collect();
    let add = format!("records add r.db {}", files.join(" "));
    assert!(bench.run(&add).done().stdout.starts_with("6 new calibrations, 0 replaced"));
    assert!(bench.run(&add).done().stdout.starts_with("0 new calibrations, 6 replaced"));
    bench.refuses("records add r.db motion.csv", 2, &["motion.csv"]);
    // a batch that was calibrated before is recorded all the same
    std::fs::remove_file(bench.path("r.db")).expect("removed");
    bench.run(&format!("{} --resume", of_date("2026-05-01"))).ends_with(5).says("note: 6 of 6");
    assert_eq!(listed(&bench).len(), 6);
}

#[test]
fn what_is_no_record_is_refused() {
    let bench = dated(&["2026-05-01"]);
    bench.refuses("records list none.db", 2, &["none.db: cannot read records"]);
    bench.refuses(
        "records list s1.csv",
        2,
        &["s1.csv: this file is there already, and is no database of records"],
    );
    bench.write("empty.db", "");
    bench.refuses("records list empty.db", 2, &["empty.db: this file is empty"]);
    assert_eq!(bench.read("empty.db"), "");
    // a pipe is not waited for
    if std::process::Command::new("mkfifo").arg(bench.path("pipe")).status().is_ok_and(|made| made.success())
    {
        bench.refuses("records list pipe", 2, &["pipe: this file is there already, and is no database"]);
    }
    // before the work, and before anything is written
    bench.refuses(
        &format!("{CALIBRATE} s1.csv --records motion.csv -o a"),
        2,
        &["motion.csv: this file is there already"],
    );
    for name in ["summary.csv", "batch.html", "s1/report.html"] {
        let says = format!("a/{name}: this file is read, and would be replaced by the result");
        bench.refuses(&format!("{CALIBRATE} s1.csv s2.csv --records ./a/{name} -o a"), 2, &[&says]);
    }
    bench.refuses(
        &format!("{CALIBRATE} s1.csv --records empty.db -o a"),
        2,
        &["empty.db: this file is empty"],
    );
    bench.run(&of_date("2026-05-01")).ends_with(5);
    bench.refuses("records show r.db 99", 2, &["r.db: there is no calibration 99"]);
    bench.refuses("records drift r.db s9", 2, &["r.db: there is no calibration of sensor \"s9\""]);
    // the version of the schema is at byte 60 of the file
    let mut bytes = std::fs::read(bench.path("r.db")).expect("there");
    bytes[60..64].copy_from_slice(&9_u32.to_be_bytes());
    bench.write("newer.db", bytes);
    let says = "newer.db: these records have version 9 of the schema, and this calibrant reads version 4";
    bench.refuses("records list newer.db", 2, &[says, "use the calibrant that wrote them"]);
    bench.refuses(
        &of_date("2026-05-01").replace("r.db", "newer.db").replace("-o 2026-05-01", "-o a"),
        2,
        &[says],
    );
}

#[test]
fn what_is_no_data_set_is_not_imported() {
    let bench = Bench::new();
    bench.write("set/part-1.parquet", "PAR1 and no more");
    bench.write("empty/notes.txt", "no part");
    bench.refuses("records import r.db none", 2, &["none: cannot read the data set"]);
    bench.refuses("records import r.db empty", 2, &["empty: there is no file of Parquet in this folder"]);
    bench.refuses("records import r.db set", 2, &["part-1.parquet: the Parquet file is damaged"]);
}

#[test]
fn a_copy_under_the_name_of_another_sensor_is_refused_and_the_wrong_name_removed() {
    let bench = dated(&["2026-05-01"]);
    bench.run(&of_date("2026-05-01")).ends_with(5);
    bench.write("line/s7_2026-05-01.csv", bench.read("line/s1_2026-05-01.csv"));
    bench.write("line/s8_2026-05-01.csv", bench.read("s2.csv").replacen("\n0.1,", "\n0.10001,", 1));
    let says = ["r.db has ", " as calibration", "of sensor \"s1\"", "recording-repeated"];
    let of = |recordings: &str, directory: &str| {
        format!("{CALIBRATE} --sensor-from {{sensor}}_{{date}} --records r.db -o {directory} {recordings}")
    };
    // alone, nothing is calibrated
    bench.refuses(&of("line/s7_2026-05-01.csv", "alone"), 3, &says);
    // in a batch, it is a row that failed, and the other is recorded
    let batch = bench.run(&of("line/s7_2026-05-01.csv line/s8_2026-05-01.csv", "batch")).ends_with(3);
    says.iter().for_each(|text| batch.says(text));
    let summary = bench.read("batch/summary.csv");
    let row = |name: &str| summary.lines().find(|line| line.starts_with(name)).expect("a row").to_owned();
    assert!(row("s7_").contains("recording-repeated") && row("s8_").contains(",converged,"), "{summary}");
    assert!(!bench.path("batch/s7_2026-05-01").exists());
    let list = || bench.run("records list r.db").done().stdout;
    assert!(list().contains(" s8 ") && !list().contains(" s7 "), "{}", list());
    // results that are there are refused, too
    bench.run(&of("line/s7_2026-05-01.csv", "later").replace(" --records r.db", "")).done();
    bench.refuses("records add r.db later/calibration.json", 3, &says);

    // the first name was wrong
    let of_s1 = bench.run("records list r.db --sensor s1 --json").done().list("records");
    let id = of_s1[0]["id"].as_i64().expect("a number");
    bench.refuses(&format!("records remove r.db {id} 99"), 2, &["r.db: there is no calibration 99"]);
    assert!(list().contains(" s1 "));
    assert_eq!(
        bench.run(&format!("records remove r.db {id}")).done().stdout,
        "1 calibration removed: r.db\n"
    );
    bench.run("records add r.db later/calibration.json").done();
    assert!(list().contains(" s7 ") && !list().contains(" s1 "), "{}", list());
}

#[test]
fn another_motion_is_another_calibration_of_the_recording() {
    let bench = dated(&["2026-05-01"]);
    let of = |motion: &str| {
        format!("calibrate experiment.toml --motion {motion} --no-report s1.csv --records r.db -o a")
    };
    bench.run(&of("motion.csv")).done();
    let drift = bench.run("records drift r.db").done().stdout;
    assert_eq!(drift, "  no sensor has two calibrations to compare\n");
    bench.write("other.csv", bench.read("motion.csv") + "\n");
    bench.run(&of("other.csv")).done();
    bench.run(&of("other.csv")).done();
    let list = bench.run("records list r.db --json").done().list("records");
    let motions: Vec<_> =
        list.as_array().expect("rows").iter().map(|row| &row["motion_file"]["file"]).collect();
    assert_eq!(motions, ["motion.csv", "other.csv"]);
}

#[test]
fn processes_that_write_at_once_lose_nothing() {
    let dates = ["2024-05-01", "2025-05-01", "2026-05-01", "2026-11-01"];
    let bench = dated(&dates);
    let children: Vec<Child> = dates.iter().map(|date| spawn(&bench, &of_date(date))).collect();
    for child in children {
        let output = child.wait_with_output().expect("it ended");
        assert_eq!(output.status.code(), Some(5), "{}", String::from_utf8_lossy(&output.stderr));
    }
    assert_eq!(listed(&bench).len(), 24);
}

#[cfg(unix)]
#[test]
fn a_batch_that_is_killed_leaves_whole_records_and_is_resumed() {
    let bench = dated(&["2026-05-01"]);
    // many recordings, so that the kill finds it at work
    let recordings: Vec<String> = (0..200).map(|k| format!("many/s{k}.csv")).collect();
    for (k, recording) in recordings.iter().enumerate() {
        let text = bench.read(&format!("s{}.csv", 1 + k % 6));
        bench.write(recording, text.replacen("\n0.1,", &format!("\n0.1{k:03}1,"), 1));
    }
    let command = format!("{CALIBRATE} --records r.db -o many-results {}", recordings.join(" "));
    let count = || bench.run("records list r.db --json").done().stdout.matches("\"id\"").count();
    let mut interrupted = 0;
    let mut before = 0;
    for wait_for in [3, 40, 90] {
        let mut child = spawn(&bench, &format!("{command} --resume"));
        loop {
            std::thread::sleep(std::time::Duration::from_millis(5));
            let ended = child.try_wait().expect("asked").is_some();
            let there =
                (0..200).filter(|k| bench.path(&format!("many-results/s{k}/resume.json")).exists()).count();
            if ended || there >= wait_for {
                break;
            }
        }
        // SIGKILL
        interrupted += usize::from(child.kill().is_ok() && child.wait().expect("waited").code().is_none());
        // list reads every record, and says where one is not whole
        let now = count();
        assert!(now >= before && now >= wait_for.min(200), "{now} records of {before}, {wait_for}");
        before = now;
    }
    assert!(interrupted > 0, "the batch ended before it could be killed");
    assert!(before < 200, "{before}");
    bench.run(&format!("{command} --resume"));
    assert_eq!(count(), 200);
    let summary = bench.read("many-results/summary.csv");
    assert_eq!(summary.lines().filter(|line| line.contains(",converged,")).count(), 200);
}
