//! Tests of `--quiet` and `--color`.

use crate::bench::Bench;

/// A motion, its recording and a warning about the recording of another.
fn bench() -> Bench {
    let bench = Bench::new();
    // no motion within the limits says as much as such a datasheet
    bench.preset("report-noisy", "noisy.toml", &[("scale_sd = 0.005 ", "scale_sd = 1e-6 ")]);
    bench.run("simulate noisy.toml -o made").done();
    bench
}

const CALIBRATE: &str = "calibrate noisy.toml made/recording.csv --motion made/motion.csv -o result";

#[test]
fn quiet_leaves_errors_warnings_and_what_was_asked_for() {
    let bench = bench();
    for (command, stdout, stderr) in [
        ("simulate noisy.toml -o made", "", ""),
        ("init stage -o stage.toml --force", "", ""),
        ("design noisy.toml --starts 2 --no-certificate -o best", "", ""),
        (CALIBRATE, "", "warning: the recording determines"),
        ("init", "schema = 1", ""),
        ("init --list", "stage", ""),
        ("completions bash", "calibrate", ""),
        (&format!("{CALIBRATE} --json"), "{", "warning: the recording determines"),
    ] {
        let outcome = bench.run(&format!("{command} --quiet")).done();
        for (found, expected) in [(&outcome.stdout, stdout), (&outcome.stderr, stderr)] {
            assert!(found.contains(expected) && found.is_empty() == expected.is_empty(), "{outcome:?}");
        }
    }
    assert_eq!(bench.run(&format!("-q {CALIBRATE}")).done().stdout, "");
    bench.refuses("design absent.toml -o best --quiet", 2, &["error: absent.toml: cannot read"]);
}

#[test]
fn labels_are_coloured_on_demand() {
    let bench = bench();
    bench.write("wrong.toml", "schema = 1\nsensr = 2\n");
    let [error, warning] = ["\u{1b}[1;31merror:\u{1b}[0m ", "\u{1b}[1;33mwarning:\u{1b}[0m "];
    for (command, status, label) in [
        (CALIBRATE, 0, warning),
        ("design absent.toml -o best", 2, error),
        ("design wrong.toml -o best", 2, error),
    ] {
        let always = bench.run(&format!("--color always {command}")).ends_with(status).stderr;
        assert!(always.contains(label), "{always:?}");
        for without in ["", "--color never", "--color auto"] {
            let plain = bench.run(&format!("{command} {without}")).ends_with(status).stderr;
            assert!(!plain.contains('\u{1b}'), "{plain:?}");
        }
    }
    // an error about the arguments, too
    for (color, is_coloured) in [("always", true), ("never", false)] {
        let stderr = bench.run(&format!("--color {color} desgin")).ends_with(2).stderr;
        assert_eq!(stderr.contains('\u{1b}'), is_coloured, "{stderr:?}");
    }
    bench.refuses("init --color pink", 2, &["[possible values: auto, always, never]"]);
}
