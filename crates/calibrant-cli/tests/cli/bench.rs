//! The bench of the command-line tests: a directory in which the program runs, and the result of a run.

use crate::schemas;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A temporary directory, the working directory of every command.
pub(crate) struct Bench {
    directory: tempfile::TempDir,
}

impl Bench {
    pub(crate) fn new() -> Self {
        Self { directory: tempfile::tempdir().expect("a temporary directory") }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    /// Writes a file, its directories too.
    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().expect("inside")).expect("a directory");
        std::fs::write(path, content).expect("written");
    }

    /// The text of a file.
    pub(crate) fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// A JSON file. One of ours has the form of its kind.
    pub(crate) fn json(&self, name: &str) -> Value {
        let value = serde_json::from_str(&self.read(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
        schemas::check(name, &value);
        value
    }

    /// Writes a preset as an experiment file, after these replacements; each must find its text.
    pub(crate) fn preset(&self, preset: &str, file: &str, edits: &[(&str, &str)]) {
        let given = |line: &str| match line.strip_prefix("# ") {
            Some(key) if key.starts_with("gravity_mps2") && key.contains("at your place") => {
                format!("{key}\n")
            }
            _ => format!("{line}\n"),
        };
        // what is tested is rarely gravity: it is given
        let mut text: String = self.run(&format!("init {preset}")).done().stdout.lines().map(given).collect();
        for (from, to) in edits {
            assert!(text.contains(from), "{preset}: {from}");
            text = text.replacen(from, to, 1);
        }
        self.write(file, text);
    }

    /// Writes experiment.toml with datasheet, motion.csv, and recordings s1.csv to s6.csv of six sensors. The gain of the fourth is far off in x.
    pub(crate) fn six_sensors(&self) {
        self.preset("report", "experiment.toml", &[]);
        self.run("simulate experiment.toml -o made").done();
        self.write("motion.csv", self.read("made/motion.csv"));
        for seed in 1..=6 {
            self.run(&format!("simulate experiment.toml --motion motion.csv --seed {seed} -o made")).done();
            let text = self.read("made/recording.csv");
            let (header, rows) = text.split_once('\n').expect("a header");
            let changed = |row: &str| {
                let mut fields: Vec<f64> = row.split(',').map(|f| f.parse().expect("a number")).collect();
                fields[1] *= if seed == 4 { 1.3 } else { 1.0 };
                fields.iter().map(|field| format!("{field:?}")).collect::<Vec<_>>().join(",") + "\n"
            };
            let rows: String = rows.lines().map(changed).collect();
            self.write(&format!("s{seed}.csv"), format!("{header}\n{rows}"));
        }
    }

    /// Writes poses.toml, an honest recording of it, and stepped.csv: the same with a bias that steps half-way.
    pub(crate) fn stepped_poses(&self) {
        self.preset("static-poses", "poses.toml", &[("poses = 24 ", "poses = 32 ")]);
        self.run("simulate poses.toml -o honest").done();
        let text = self.read("honest/recording.csv");
        let rows = text.lines().count();
        let stepped = text.lines().enumerate().map(|(row, line)| {
            let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
            if row > rows / 2 {
                fields[1] = format!("{}", fields[1].parse::<f64>().expect("a number") + 0.05);
            }
            fields.join(",") + "\n"
        });
        self.write("stepped.csv", stepped.collect::<String>());
    }

    /// Runs the program; the arguments are separated by blanks.
    pub(crate) fn run(&self, arguments: &str) -> Outcome {
        self.run_with(&arguments.split_whitespace().collect::<Vec<_>>())
    }

    /// Runs the program with arguments that may contain blanks.
    pub(crate) fn run_with(&self, arguments: &[&str]) -> Outcome {
        self.outcome(arguments, Stdio::null())
    }

    /// Runs the program with this file as standard input.
    pub(crate) fn run_from(&self, input: &str, arguments: &str) -> Outcome {
        let file = std::fs::File::open(self.path(input)).expect("there");
        self.outcome(&arguments.split_whitespace().collect::<Vec<_>>(), file.into())
    }

    /// Runs a line of a shell, which finds the program.
    #[cfg(unix)]
    pub(crate) fn shell(&self, line: &str) -> Outcome {
        let program = Path::new(env!("CARGO_BIN_EXE_calibrant")).parent().expect("a folder");
        let others = std::env::var_os("PATH").unwrap_or_default();
        let path = std::iter::once(program.to_owned()).chain(std::env::split_paths(&others));
        let mut command = Command::new("sh");
        command.args(["-c", line]).env("PATH", std::env::join_paths(path).expect("no colons"));
        self.outcome_of(command, line.to_owned(), Stdio::null())
    }

    fn outcome(&self, arguments: &[&str], input: Stdio) -> Outcome {
        let mut command = Command::new(env!("CARGO_BIN_EXE_calibrant"));
        command.args(arguments);
        self.outcome_of(command, format!("calibrant {}", arguments.join(" ")), input)
    }

    fn outcome_of(&self, mut command: Command, words: String, input: Stdio) -> Outcome {
        let output = command
            .current_dir(self.directory.path())
            .env_remove("RAYON_NUM_THREADS")
            .env_remove("FORCE_COLOR")
            .stdin(input)
            .output()
            .expect("the program runs");
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8");
        let outcome = Outcome {
            command: words,
            status: output.status.code().expect("an exit status, not a signal"),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        };
        assert!(!outcome.stderr.contains("panicked at"), "{outcome:?}");
        outcome
    }

    /// Every file and directory, by its path from here.
    pub(crate) fn files(&self) -> BTreeSet<String> {
        fn collect(root: &Path, directory: &Path, found: &mut BTreeSet<String>) {
            for entry in std::fs::read_dir(directory).expect("a directory") {
                let path = entry.expect("readable").path();
                let name = path.strip_prefix(root).expect("inside").to_string_lossy().replace('\\', "/");
                found.insert(name);
                if path.is_dir() {
                    collect(root, &path, found);
                }
            }
        }
        let mut found = BTreeSet::new();
        collect(self.directory.path(), self.directory.path(), &mut found);
        found
    }

    /// A run that must fail with this exit status, print all of these texts, and write nothing at all.
    pub(crate) fn refuses(&self, arguments: &str, status: i32, says: &[&str]) {
        let before = self.files();
        let outcome = self.run(arguments);
        assert_eq!(outcome.status, status, "{outcome:?}");
        says.iter().for_each(|text| outcome.says(text));
        assert_eq!(outcome.stdout, "", "{outcome:?}");
        let mut after = self.files();
        // but a page that says why, in its folder
        let page =
            after.iter().find(|name| name.ends_with("report.html") && !before.contains(*name)).cloned();
        if let Some(folder) = page.as_deref().map(|page| page.trim_end_matches("/report.html")) {
            after.retain(|name| before.contains(name) || !name.starts_with(folder));
        }
        assert_eq!(after, before, "nothing is written: {outcome:?}");
    }
}

/// How a run ended.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) command: String,
    pub(crate) status: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Outcome {
    /// The run, which must have succeeded.
    pub(crate) fn done(self) -> Self {
        self.ends_with(0)
    }

    /// The run, which must have ended with this status.
    pub(crate) fn ends_with(self, status: i32) -> Self {
        assert_eq!(self.status, status, "{}\n{}", self.command, self.stderr);
        self
    }

    /// The JSON on stdout. It has the form of its kind.
    pub(crate) fn json(&self) -> Value {
        let value =
            serde_json::from_str(&self.stdout).unwrap_or_else(|error| panic!("{}: {error}", self.command));
        schemas::check(&self.command, &value);
        value
    }

    /// The JSON list on stdout. It has the form of this kind.
    pub(crate) fn list(&self, kind: &str) -> Value {
        let value = self.json();
        schemas::check_kind(kind, &self.command, &value);
        value
    }

    /// The words of stdout, wherever lines are broken.
    pub(crate) fn printed(&self) -> String {
        self.stdout.split_whitespace().collect::<Vec<_>>().join(" ")
    }

    /// Stderr must contain this text, wherever lines are broken.
    pub(crate) fn says(&self, text: &str) {
        // long messages beside an excerpt are wrapped with a bar on the left
        let stderr = self.stderr.replace("\n  │ ", " ");
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            words(&stderr).contains(&words(text)),
            "{} does not say: {text}\n{}",
            self.command,
            self.stderr
        );
    }
}

/// Names of parameters, in order.
pub(crate) fn names(parameters: &Value) -> Vec<&str> {
    let list = parameters.as_array().expect("an array");
    list.iter().map(|parameter| parameter["name"].as_str().expect("a name")).collect()
}

/// Each parameter of a `calibration.json` must lie within five standard deviations of `truth.json`.
pub(crate) fn assert_close_to_truth(calibration: &Value, truth: &Value) {
    assert_eq!(names(&calibration["parameters"]), names(&truth["parameters"]));
    let list = |value: &Value| value["parameters"].as_array().expect("an array").clone();
    for (found, truth) in list(calibration).iter().zip(list(truth)) {
        let number = |value: &Value, field: &str| value[field].as_f64().expect("a number");
        let (error, sd) = (number(found, "value") - number(&truth, "value"), number(found, "sd"));
        assert!(sd > 0.0 && error.abs() < 5.0 * sd, "{found} against {truth}");
        assert_eq!(found["unit"], truth["unit"]);
    }
}
