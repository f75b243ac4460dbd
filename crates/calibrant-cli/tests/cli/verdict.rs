//! Tests of the verdict: what is wrong with a sensor or its recording, for every kind of calibration.

use crate::bench::{Bench, Outcome};

/// A recording's columns after the time, and its rows.
struct Table {
    header: String,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn read(bench: &Bench, name: &str) -> Self {
        let text = bench.read(name);
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let header = lines.next().expect("a header").to_owned();
        let row = |line: &str| line.split(',').map(|field| field.parse().expect("a number")).collect();
        Self { header, rows: lines.map(row).collect() }
    }

    /// Writes the rows as this changes them. It gets the number of the row, and the row with its time.
    fn write_changed(&self, bench: &Bench, name: &str, change: impl Fn(usize, &mut Vec<f64>)) {
        let changed = |(number, row): (usize, &Vec<f64>)| {
            let mut row = row.clone();
            change(number, &mut row);
            row.iter().map(|value| format!("{value:?}")).collect::<Vec<_>>().join(",")
        };
        let rows: Vec<String> = self.rows.iter().enumerate().map(changed).collect();
        bench.write(name, format!("{}\n{}\n", self.header, rows.join("\n")));
    }
}

/// A number between -√3 and √3 that looks random: of standard deviation 1.
fn scatter(number: usize, column: usize) -> f64 {
    let mixed = ((number * 7 + column) as f64 * 12.9898).sin() * 43_758.545_3;
    (mixed - mixed.floor() - 0.5) * 12.0_f64.sqrt()
}

/// What may be wrong.
#[derive(Clone, Copy)]
enum Fault {
    None,
    /// An axis of the accelerometer is reversed.
    Reversed,
    /// Two of its axes are exchanged.
    Exchanged,
    /// Its gain is 5 % too large.
    Gain,
    /// It shows 2 % of the stimulus.
    Scale,
    /// It is in g.
    InG,
    /// White noise of this size is added, m/s².
    Noise(f64),
    /// One sample reads 55 m/s².
    Spike,
    /// An axis of the gyroscope is reversed.
    GyroscopeReversed,
}

impl Fault {
    fn apply(self, count: usize, number: usize, row: &mut [f64]) {
        match self {
            Self::None => {}
            Self::Reversed => row[1] = -row[1],
            Self::Exchanged => row.swap(1, 2),
            Self::Gain => row[1] *= 1.05,
            Self::Scale => row[1..4].iter_mut().for_each(|y| *y *= 0.02),
            Self::InG => row[1..4].iter_mut().for_each(|y| *y /= 9.80665),
            Self::Noise(sd) => (1..4).for_each(|k| row[k] += sd * scatter(number, k)),
            Self::Spike if number == count / 2 => row[1] = 55.0,
            Self::Spike => {}
            Self::GyroscopeReversed => row[4] = -row[4],
        }
    }
}

/// Calibrates from the recording with a fault. `further`: arguments.
fn calibrated(bench: &Bench, fault: Fault, further: &str) -> Outcome {
    let table = Table::read(bench, "made/recording.csv");
    let count = table.rows.len();
    table.write_changed(bench, "faulty.csv", |number, row| fault.apply(count, number, row));
    bench.run(&format!("calibrate sensor.toml faulty.csv {further} --no-report -o out"))
}

/// The first line of the output, and the exit status that goes with it.
fn assert_verdict(outcome: &Outcome, expected: &str) {
    let first = outcome.stdout.lines().next().unwrap_or_default();
    assert_eq!(first, format!("verdict: {expected}"), "{}\n{}", outcome.command, outcome.stderr);
    let status = if expected.starts_with("bad") { 5 } else { 0 };
    assert_eq!(outcome.status, status, "{first}");
}

fn bench(preset: &str, edits: &[(&str, &str)]) -> Bench {
    let bench = Bench::new();
    bench.preset(preset, "sensor.toml", edits);
    bench.run("simulate sensor.toml -o made").done();
    bench
}

fn verdicts(bench: &Bench, further: &str, cases: &[(Fault, &str)]) {
    cases.iter().for_each(|(fault, expected)| assert_verdict(&calibrated(bench, *fault, further), expected));
}

const FAR_OFF: &str = "bad (parameter-implausible, gain-implausible)";

#[test]
fn of_a_known_motion() {
    let bench = bench("report", &[]);
    let cases = [
        (Fault::None, "ok"),
        (Fault::Reversed, "bad (parameter-implausible, scale-negative)"),
        (Fault::Exchanged, "bad (model-contradicted, parameter-implausible, gain-implausible)"),
        (Fault::Gain, "bad (parameter-implausible)"),
        (Fault::Scale, FAR_OFF),
        (Fault::InG, FAR_OFF),
        (Fault::Noise(4e-3), "bad (noise-implausible)"),
        (Fault::Spike, "doubtful (spikes)"),
    ];
    verdicts(&bench, "--motion made/motion.csv", &cases);
}

#[test]
fn of_holds() {
    let bench = bench("static-poses", &[("# noise_mps2", "noise_mps2")]);
    // the magnitude of gravity does not show the order and the direction of axes
    let cases = [
        (Fault::None, "ok"),
        (Fault::Reversed, "ok"),
        (Fault::Gain, "bad (parameter-implausible)"),
        (Fault::Scale, FAR_OFF),
        (Fault::InG, FAR_OFF),
        // the result has the noise that was found
        (Fault::Noise(0.2), "doubtful (holds-tremble)"),
        (Fault::Noise(0.05), "ok"),
        (Fault::Spike, "ok"),
    ];
    verdicts(&bench, "", &cases);
}

#[test]
fn of_an_imu() {
    let datasheet = "noise_mps2 = 0.01\nbias_sd_mps2 = 0.1\nscale_sd = 0.005\nunit = \"mps2\"";
    let bench = bench("imu", &[("unit = \"mps2\"", datasheet)]);
    let cases = [
        (Fault::None, "ok"),
        (Fault::Reversed, "bad (axes-in-other-order)"),
        (Fault::Exchanged, "bad (axes-in-other-order)"),
        (Fault::Gain, "bad (parameter-implausible)"),
        (Fault::Noise(0.2), "doubtful (holds-tremble)"),
        (Fault::Spike, "ok"),
        (Fault::GyroscopeReversed, "bad (axes-in-other-order)"),
    ];
    verdicts(&bench, "", &cases);
    calibrated(&bench, Fault::InG, "").ends_with(3).says("is it in g?");
}

#[test]
fn of_a_sensor_on_a_machine() {
    let datasheet = "noise_mps2 = 5e-3\nbias_sd_mps2 = 0.1\nscale_sd = 0.005\n#";
    let edits = [("noise_mps2", datasheet), ("duration_s = 60.0", "duration_s = 15.0")];
    let bench = bench("arm", &edits);
    let cases = [
        (Fault::None, "ok"),
        (Fault::Reversed, "bad (gain-implausible, parameter-implausible)"),
        (Fault::Exchanged, "bad (gain-implausible, parameter-implausible)"),
        (Fault::Gain, "bad (parameter-implausible)"),
        (Fault::Noise(0.1), "bad (noise-implausible)"),
        // one of 1500 samples
        (Fault::Spike, "ok"),
        (Fault::GyroscopeReversed, "bad (gain-implausible)"),
    ];
    verdicts(&bench, "--motion made/joints.csv", &cases);
}

/// One sample of 55 m/s² moves no parameter by more than its standard deviation, whatever is known of the motion.
#[test]
fn one_wrong_sample_moves_no_parameter_of_a_motion() {
    for preset in ["report", "report-unknown", "report-noisy"] {
        let bench = bench(preset, &[]);
        let parameters = |fault: Fault| -> Vec<(f64, f64)> {
            assert_eq!(calibrated(&bench, fault, "--motion made/motion.csv").status, 0);
            let json = bench.json("out/calibration.json");
            let list = json["parameters"].as_array().expect("a list");
            let number = |of: &serde_json::Value| of.as_f64().expect("a number");
            list.iter().map(|of| (number(&of["value"]), number(&of["sd"]))).collect()
        };
        for ((clean, sd), (found, _)) in parameters(Fault::None).into_iter().zip(parameters(Fault::Spike)) {
            assert!((found - clean).abs() < sd, "{preset}: {found} in place of {clean} ± {sd}");
        }
        let json = bench.json("out/calibration.json");
        assert_eq!(json["warnings"][0]["code"], "spikes");
        assert_eq!(json["warnings"][0]["numbers"]["cut"], 1.0);
        assert_eq!(json["warnings"][0]["numbers"]["reading"], 55.0);
    }
}

#[test]
fn the_verdict_is_in_every_result_and_codes_can_be_allowed() {
    let bench = bench("report", &[]);
    let motion = "--motion made/motion.csv";
    assert_verdict(&calibrated(&bench, Fault::Spike, motion), "doubtful (spikes)");
    calibrated(&bench, Fault::Spike, &format!("{motion} --deny doubtful")).ends_with(5);
    let allowed = format!("{motion} --deny doubtful --allow spikes");
    assert_verdict(&calibrated(&bench, Fault::Spike, &allowed), "ok");
    assert_verdict(
        &calibrated(
            &bench,
            Fault::Gain,
            &format!("{motion} --allow parameter-implausible --allow gain-unusual"),
        ),
        "ok",
    );
    calibrated(&bench, Fault::Gain, motion).ends_with(5).says("error: accelerometer.scale.x is");
    let json = bench.json("out/calibration.json");
    assert_eq!(json["verdict"], serde_json::json!({"usability": "bad", "codes": ["parameter-implausible"]}));
    assert_eq!(json["warnings"][0]["severity"], "error");
    bench.run(&format!("calibrate sensor.toml faulty.csv {motion} -o page")).ends_with(5);
    assert!(bench.read("page/report.html").contains("Bad: do not use (parameter-implausible)"));
    let several = bench
        .run(&format!("calibrate sensor.toml made/recording.csv faulty.csv {motion} --no-report -o all"));
    let several = several.ends_with(5);
    assert!(
        several
            .stdout
            .starts_with("Yield 50 %: 1 of 2 sensors ok.\n\n  1 bad, 0 doubtful, 0 without a result."),
        "{}",
        several.stdout
    );
    let rows: Vec<&str> = several.stdout.lines().skip(6).map(str::trim).collect();
    assert!(rows[0].starts_with("faulty") && rows[1].starts_with("recording"), "{}", several.stdout);
    let summary = bench.read("all/summary.csv");
    assert!(summary.contains("\nfaulty,faulty.csv,bad,parameter-implausible,converged,,,,"), "{summary}");
}

#[test]
fn limits_are_guarded_by_the_standard_deviation() {
    let bench = bench("report", &[]);
    let run = |limits: &str| {
        bench.write("limits.toml", format!("[accept]\n{limits}\n"));
        let command = "calibrate sensor.toml made/recording.csv --motion made/motion.csv";
        bench.run(&format!("{command} --accept limits.toml --no-report -o out"))
    };
    run("\"accelerometer.bias\" = { range = [-0.5, 0.5], sd = 1e-3 }").done();
    let scale = bench.json("out/calibration.json")["parameters"][3].clone();
    assert_eq!(scale["name"], "accelerometer.scale.x");
    let (value, sd) = (scale["value"].as_f64().expect("a number"), scale["sd"].as_f64().expect("a number"));
    for (beyond, decision, expected) in [
        (2.0, "pass", "ok"),
        (1.0, "too_close", "doubtful (limit-too-close)"),
        (-1.0, "too_close", "doubtful (limit-too-close)"),
        (-2.0, "fail", "bad (limit-broken)"),
    ] {
        let most = value + beyond * sd;
        let outcome = run(&format!("\"accelerometer.scale.x\" = {{ range = [0.5, {most:?}] }}"));
        assert_verdict(&outcome, expected);
        assert_eq!(bench.json("out/calibration.json")["limits"][0]["decision"], decision);
    }
    let outcome = run("\"accelerometer.scale\" = { sd = 1e-9 }").ends_with(5);
    outcome.says("error: the sd of accelerometer.scale.x is");
    assert!(outcome.stdout.contains("FAIL"), "{}", outcome.stdout);
    assert_verdict(&run("\"norm_rms_mps2\" = { range = [0.0, 1.0] }"), "doubtful (limit-not-checked)");
    run("\"accelerometer.bais\" = { sd = 1.0 }").ends_with(2).says("did you mean `accelerometer.bias`?");
    run("\"residual_rms\" = {}").ends_with(2).says("this limit limits nothing");
    run("\"residual_rms\" = { range = [1.0, 0.0] }").ends_with(2).says("is above the largest");
    run("").ends_with(2).says("there is no limit in [accept]");
}
