//! Tests of the names of sensors: by an option, by the path of a file, by the recording itself.

use crate::bench::Bench;
use serde_json::Value;

const CALIBRATE: &str = "calibrate experiment.toml --motion motion.csv --no-report -o out";

/// Two sensors, each with a folder and a recording of the same name.
fn folders() -> Bench {
    let bench = Bench::new();
    bench.six_sensors();
    for sensor in ["s1", "s2"] {
        bench.write(&format!("{sensor}/2026-05-01.csv"), bench.read(&format!("{sensor}.csv")));
    }
    bench
}

/// The sensors in the records, in their order.
fn recorded(bench: &Bench) -> Vec<String> {
    let list = bench.run("records list r.db --json").done().list("records");
    let sensor = |record: &Value| record["sensor"].as_str().expect("a name").to_owned();
    list.as_array().expect("a list").iter().map(sensor).collect()
}

#[test]
fn recordings_of_the_same_name_are_not_recorded_as_one_sensor_unless_somebody_says_so() {
    let bench = folders();
    let two = format!("{CALIBRATE} s1/2026-05-01.csv s2/2026-05-01.csv");
    bench.run(&two).done();
    bench.refuses(&format!("{two} --records r.db"), 2, &["would be recorded as one sensor", "--sensor-from"]);
    assert!(!bench.path("r.db").exists());
    bench.run(&format!("{two} --records r.db --sensor-from {{sensor}}/{{date}} --threads 1")).done();
    assert_eq!(recorded(&bench), ["s1", "s2"]);
    bench.refuses(&format!("{two} --sensor A"), 2, &["--sensor names one sensor", "{}_{date}"]);
    bench.refuses(
        &format!("{two} --sensor A --sensor-from {{sensor}}"),
        2,
        &["by an option and by {sensor}"],
    );
    bench.refuses(&format!("{two} --sensor-from {{date}}"), 2, &["does not name the sensor"]);
    bench
        .run(&format!("{two} --sensor-from L1/{{sensor}}/{{}}"))
        .ends_with(2)
        .says("the path of this file is not of");
    bench.run(&format!("{two} --records one.db --sensor A --sensor-from {{date}} --threads 1")).done();
    let list = bench.run("records list one.db").done().printed();
    assert_eq!(list.matches(" A 2026-05-01 ").count(), 2, "{list}");
    bench.refuses(
        "calibrate experiment.toml s1.csv --motion motion.csv -o out --sensor A --sensor-key serial",
        2,
        &["cannot be used with"],
    );
}

#[test]
fn a_report_begins_with_sensor_date_and_station_and_invents_none() {
    let bench = folders();
    let calibrate = "calibrate experiment.toml --motion motion.csv -o out s1/2026-05-01.csv";
    let head = |options: &str| {
        bench.run(&format!("{calibrate} {options}")).done();
        let page = bench.read("out/report.html");
        page.split("<div class=\"verdict").next().expect("a head").replace("</dt><dd>", ": ")
    };
    let plain = head("");
    for says in ["Recorded: not stated", "Station: not stated", "Gravity: not stated", "Program: calibrant "]
    {
        assert!(plain.contains(says), "{says}: {plain}");
    }
    let named = head("--sensor-from {sensor}/{date} --station L1");
    for says in ["Sensor: s1, accelerometer", "Recorded: 2026-05-01", "Station: L1"] {
        assert!(named.contains(says), "{says}: {named}");
    }
    let sha256 = calibrant::io::HashedFile::of(&bench.path("out/calibration.json")).expect("written").sha256;
    assert!(named.contains(&sha256[..16]), "{named}");
}

#[test]
fn a_recording_names_its_sensor() {
    let bench = folders();
    bench.write("noted.csv", format!("# serial: SN 17\n{}", bench.read("s1.csv")));
    let rows = bench.read("s2.csv");
    let with_column = |(k, row): (usize, &str)| format!("{row},{}\n", if k == 0 { "Serial" } else { "SN18" });
    bench.write("column.csv", rows.lines().enumerate().map(with_column).collect::<String>());
    bench
        .run(&format!("{CALIBRATE} noted.csv column.csv --sensor-key serial --records r.db --threads 1"))
        .done();
    assert_eq!(recorded(&bench), ["SN 17", "SN18"]);
    let batch = bench.run(&format!("{CALIBRATE} noted.csv s3.csv --sensor-key serial")).ends_with(3);
    batch.says("s3.csv: this recording has neither a line `# serial: …` above its header nor a column");
    let two_lines: Vec<&str> = CALIBRATE.split(' ').chain(["s1.csv", "--sensor", "A\n1"]).collect();
    bench.run_with(&two_lines).ends_with(2).says("is no name of a sensor");
}

#[test]
fn standard_input_is_given_once_and_its_sensor_is_named_for_records() {
    let bench = folders();
    let run = |arguments: &str| bench.run_from("s1.csv", &format!("{CALIBRATE} {arguments}"));
    run("- -").ends_with(2).says("standard input (-) is given twice");
    run("- --records r.db").ends_with(2).says("name it with --sensor");
    run("- --records r.db --sensor A").done();
    assert_eq!(recorded(&bench), ["A"]);
    run("-").done();
    assert_eq!(bench.json("out/calibration.json")["sensor"], "stdin");
}
