//! Tests of broken experiment files: exit status 2, the line shown and the remedy.

use super::bench;

/// Text of the preset, its replacement, text of the line at fault, and the message.
type Case = (&'static str, &'static str, &'static str, &'static [&'static str]);

/// The broken experiment files.
const CASES: &[Case] = &[
    ("interval_s = 1.0", "intervall_s = 1.0", "intervall_s", &["unknown key", "did you mean `interval_s`?"]),
    ("[limits]", "[limit]", "[limit]", &["unknown key", "did you mean `limits`?"]),
    (
        "axes = 3",
        "axes = 3\nrate_hz = 5.0",
        "rate_hz = 5.0",
        &["unknown key", "`rate_hz` belongs in [motion]"],
    ),
    ("axes = 3", "axes = 2", "axes = 2", &["2 axes are not supported", "axes = 3, or axes = 1"]),
    ("axes = 3", "axes = \"3\"", "axes = \"3\"", &["without the quotes"]),
    ("\"accelerometer\"", "\"gyroscope\"", "gyroscope", &["alone or with a gyroscope", "\"imu\" for both"]),
    ("noise_mps2 = 2e-4", "noise_mps2 = -2e-4", "-2e-4", &["`sensor.noise_mps2`"]),
    ("noise_mps2 = 2e-4", "noise_mps2 = nan", "nan", &["`sensor.noise_mps2`"]),
    ("noise_mps2 = 2e-4", "noise_mps2 = [1e-4, 2e-4]", "[1e-4, 2e-4]", &["`sensor.noise_mps2`"]),
    ("noise_mps2 = 2e-4", "", "[sensor]", &["`sensor.noise_mps2`: this key is required with [motion]"]),
    ("\"known\"", "\"knwon\"", "knwon", &["\"knwon\" is not known here", "did you mean \"known\"?"]),
    ("\"known\"", "\"unknown\"", "known_ends", &["needs the acceleration at both ends of the motion"]),
    ("\"known\"", "\"noisy\"", "[motion]", &["`motion.input_noise`: this required key is missing"]),
    ("intervals = 10", "intervals = 0", "intervals = 0", &["`motion.intervals`"]),
    ("rate_hz = 10.0", "rate_hz = 1e-3", "rate_hz = 1e-3", &["less than one sample step"]),
    ("rate_hz = 10.0", "rate_hz = 10.0\nrate_hz = 20.0", "rate_hz = 20.0", &["`rate_hz` is there twice"]),
    ("rate_hz = 10.0", "rate_hz =", "rate_hz =", &["not valid TOML"]),
    ("schema = 1", "schema = 2", "schema = 2", &["schema 2 is not known to this version"]),
    ("prior = \"none\"", "prior = \"flat\"", "\"flat\"", &["\"flat\" is not known here"]),
    ("criterion = \"A\"", "criterion = \"Z\"", "\"Z\"", &["`design.criterion`"]),
];

#[test]
fn every_broken_experiment_is_refused_at_its_line() {
    let bench = bench();
    let good = bench.read("experiment.toml");
    for (from, to, at, says) in CASES {
        assert!(good.contains(from), "{from}");
        let text = good.replacen(from, to, 1);
        let line = 1 + text.lines().position(|line| line.contains(at)).expect("the line");
        bench.write("broken.toml", &text);
        let place = format!("broken.toml:{line}:");
        let says: Vec<&str> = says.iter().copied().chain([place.as_str()]).collect();
        bench.refuses("simulate broken.toml -o result", 2, &says);
        bench.refuses("calibrate broken.toml recording.csv --motion motion.csv -o result", 2, &says);
        bench.refuses("study broken.toml -o result", 2, &says);
    }
}

#[test]
fn the_line_is_shown_and_underlined() {
    let bench = bench();
    bench.preset("report", "broken.toml", &[("interval_s", "intervall_s")]);
    let stderr = bench.run("simulate broken.toml -o result").stderr;
    let shown: Vec<&str> = stderr.lines().collect();
    let at = shown.iter().position(|line| line.starts_with(" 19 │ intervall_s = 1.0 ")).expect(&stderr);
    assert!(shown[at + 1].contains("─────┬─────"), "{stderr}");
    assert!(!stderr.contains('\u{1b}'), "no colours where stderr is no terminal: {stderr:?}");
}

#[test]
fn what_is_no_experiment_file_is_refused() {
    let bench = bench();
    bench.refuses(
        "simulate absent.toml -o result",
        2,
        &["error: absent.toml: cannot read the experiment file"],
    );
    bench.write("folder/inside.toml", "");
    bench.refuses("simulate folder -o result", 2, &["folder: this is a directory, not the experiment file"]);
    for (bytes, says) in [
        (&b""[..], "`schema`: this required key is missing"),
        (b"\x00\x01\x02", "this is binary data, not text"),
        (b"schema = 1\n# caf\xe9\n", "not UTF-8 text"),
        (b"schema = 1\n", "`sensor`: this required key is missing"),
        (b"t_s,ax,ay,az\n0,1,2,3\n", "not valid TOML"),
    ] {
        bench.write("broken.toml", bytes);
        bench.refuses("simulate broken.toml -o result", 2, &["broken.toml:", says]);
    }
    let both = bench.read("experiment.toml") + "[holds]\ngravity_mps2 = 9.81\ngauge = \"upper\"\n";
    bench.write("broken.toml", both);
    bench.refuses("simulate broken.toml -o result", 2, &["[motion] and [holds] are both there"]);
}
