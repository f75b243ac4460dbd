//! Tests of `init`: the list of presets, and the commands that it prints.

use crate::bench::Bench;

/// The names of the presets, from the list.
fn presets() -> Vec<String> {
    let list = Bench::new().run("init --list").done().stdout;
    list.lines().map(|line| line.split_whitespace().next().expect("a name").to_owned()).collect()
}

/// The sensor of imu-counts, as `simulate` needs it.
const COUNTS: &str =
    "gain_counts_per_mps2 = 400.0\noffset_counts = 32768.0\nnoise_counts = 4.0\nunit = \"counts\"";

/// Writes the files that the printed commands need from a user.
fn bring_own_files(bench: &Bench, preset: &str) {
    let switch_on = |key: &'static str| (key, key.trim_start_matches("# "));
    let gains = match preset {
        "imu-counts" => vec![
            ("unit = \"counts\"", COUNTS),
            switch_on("# gain_counts_per_radps"),
            switch_on("# noise_counts"),
        ],
        "static-poses-counts" => ["# gain_counts", "# offset_counts", "# noise_counts"].map(switch_on).into(),
        "ferraris" => return session(bench),
        _ => return,
    };
    bench.preset(preset, "gains.toml", &gains);
    bench.run("simulate gains.toml -o own").done();
    std::fs::copy(bench.path("own/recording.csv"), bench.path("recording.csv")).expect("copied");
}

/// Writes a Ferraris session as imucal exports it: samples without times, and turns that are clockwise.
fn session(bench: &Bench) {
    let table = include_str!("../../../../examples/06_whole_imu/table.toml");
    bench.write("table.toml", table.replace("angle_deg = 360.0", "angle_deg = -360.0"));
    bench.run("simulate table.toml -o own").done();
    let recording = bench.read("own/recording.csv");
    let mut text = "n_samples,gyr_x,gyr_y,gyr_z,acc_x,acc_y,acc_z\n".to_owned();
    for (number, line) in recording.lines().skip(1).enumerate() {
        let row: Vec<f64> = line.split(',').map(|field| field.parse().expect("a number")).collect();
        let [ax, ay, az] = [row[1], row[2], row[3]];
        let [gx, gy, gz] = [row[4], row[5], row[6]].map(f64::to_degrees);
        text.push_str(&format!("{number},{gx},{gy},{gz},{ax},{ay},{az}\n"));
    }
    bench.write("session.csv", text);
    bench.write("sections.json", include_str!("../../../../examples/06_whole_imu/sections.json"));
}

#[test]
fn the_list_has_one_line_for_each_preset() {
    let list = Bench::new().run("init --list").done();
    assert!(
        list.stdout.contains("stage                accelerometer on a linear stage, from rest to rest\n")
    );
    assert!(list.stdout.lines().all(|line| line.chars().count() <= 80), "{}", list.stdout);
    assert!(list.stderr.is_empty());
    Bench::new().refuses("init stage --list", 2, &["cannot be used with"]);
}

#[test]
fn the_printed_commands_work_for_every_preset() {
    for preset in presets() {
        let bench = Bench::new();
        bring_own_files(&bench, &preset);
        let note = bench.run(&format!("init {preset} -o {preset}.toml")).done().stdout.replace("\\\n", "");
        let commands: Vec<&str> = note.lines().filter_map(|line| line.strip_prefix("  calibrant ")).collect();
        assert!(!commands.is_empty(), "{note}");
        for command in commands {
            let outcome = bench.run(command);
            assert_eq!(outcome.status, 0, "{preset}: {outcome:?}");
        }
        let last = if preset == "campaign" { "plan/design.json" } else { "result/calibration.json" };
        assert!(bench.path(last).exists(), "{preset}: {note}");
    }
}

#[test]
fn a_name_with_blanks_is_quoted() {
    let bench = Bench::new();
    bench.write("my stage/x", "");
    let outcome = bench.run_with(&["init", "stage", "-o", "my stage/it's.toml"]).done();
    let command = r"calibrant design 'my stage/it'\''s.toml' -o best";
    assert!(outcome.printed().contains(command), "{}", outcome.stdout);
}

#[test]
fn a_key_is_set_on_the_command_line() {
    let bench = Bench::new();
    bench.run("init imu --sensor bmi088 -o imu.toml").done();
    let text = bench.read("imu.toml");
    assert!(
        text.contains("noise_ug_per_rthz = 190.0") && text.contains("# gyroscope_lsb_per_dps = 16.384"),
        "{text}"
    );
    bench.run("simulate imu.toml --set holds.poses=14 --set sensor.model=scale-bias -o made").done();
    // fourteen holds of five seconds, and what lies between them
    let seconds = bench.read("made/recording.csv").lines().count() as f64 / 100.0;
    assert!((70.0..120.0).contains(&seconds), "{seconds}");
    bench
        .run("calibrate imu.toml made/recording.csv --set holds.minimum_hold_s=2.0 --no-report -o out")
        .done();
    let experiment = &bench.json("out/calibration.json")["experiment"]["file"];
    assert_eq!(experiment, "imu.toml with holds.minimum_hold_s=2.0");
    for (setting, says) in [
        ("holds.posse=7", "did you mean `poses`?"),
        ("holds.poses=-7", "`holds.poses`"),
        ("holds.poses", "sets no key"),
        ("holds={posse=3,hold_s=5.0}", "did you mean `poses`?"),
    ] {
        let command = format!("simulate imu.toml --set {setting} -o other");
        bench.refuses(&command, 2, &[says]);
        let said = bench.run(&command).stderr;
        assert!(!said.contains("imu.toml:"), "it is not in the file: {said}");
    }
    bench.refuses("init imu-counts --sensor mti-3", 2, &["has no sensitivity of counts"]);
    bench.refuses("init imu --sensor adxl355", 2, &["is an accelerometer alone"]);
    bench.refuses("init imu --sensor lsm9ds1", 2, &["the datasheets at hand are bmi088"]);
}
