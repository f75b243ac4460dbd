//! All guides, followed as a reader does: README.md, `docs/` and the READMEs of `examples/`.
//!
//! The commands of the `sh` blocks run in a shell, in their order and in one empty folder for each guide. A comment may
//! give another exit status than 0. What a `text` block shows is printed by the command before it: its lines in this
//! order, and `…` stands for omitted ones. A `toml` block that begins with `# NAME.toml` is that file.
//! `CALIBRANT_GUIDES=noise` follows the guides with this in their paths alone.

use crate::bench::Bench;
use crate::data::shared_data;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

/// Programs of others: their commands are not run.
const OTHERS: [&str; 4] = ["cargo", "nc", "pip", "python"];

/// Commands that are too long for a test, and what is run in their place: 60 calibrations on an arm take a minute.
const SHORTENED: [(&str, &str); 1] =
    [("calibrant study arm.toml -o study ", "calibrant study arm.toml --sensors 2 -o study ")];

/// Files that the reader has, or that a guide links to: the guide, the file, and where it is in the repository.
const GIVEN: [(&str, &str, &str); 3] = [
    ("docs/calibrate-on-a-machine.md", "my-arm.urdf", "crates/calibrant-io/presets/machines/arm.urdf"),
    ("docs/design-poses.md", "twelve.csv", "examples/10_best_poses/twelve.csv"),
    ("docs/files-and-conventions.md", "resampled.csv", "examples/08_motion_capture/resampled.csv"),
];

/// The recording of imu_tk, which lies outside the repository. Without it, commands on it and on their results are not run.
const GUIDES_WITH_IMU_TK: [&str; 2] = ["docs/calibrate-by-hand.md", "docs/noise.md"];
const IMU_TK: [(&str, &str); 2] =
    [("acc.mat", "xsens-mti-static/xsens_acc.mat"), ("gyro.mat", "xsens-mti-static/xsens_gyro.mat")];

#[test]
fn every_command_of_every_guide_runs_and_prints_what_is_shown() {
    let wanted = std::env::var("CALIBRANT_GUIDES").unwrap_or_default();
    let mut guides = guides();
    assert!(guides.len() >= 20, "{guides:?}");
    guides.retain(|guide| guide.contains(&wanted));
    let (next, faults) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    let work = || {
        while let Some(guide) = guides.get(next.fetch_add(1, Ordering::Relaxed)) {
            let start = Instant::now();
            let mut follower = Follower::new(guide);
            follower.follow();
            println!("{guide}: {} commands, {:.1} s", follower.ran, start.elapsed().as_secs_f64());
            faults.lock().expect("no panic").append(&mut follower.faults);
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    let faults = faults.into_inner().expect("no panic");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

fn root() -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "../.."].iter().collect()
}

fn text_of(guide: &str) -> String {
    std::fs::read_to_string(root().join(guide)).expect("readable")
}

/// The pages with commands, those of examples first: they take longest.
fn guides() -> Vec<String> {
    let names = |folder: &'static str| {
        let entries = std::fs::read_dir(root().join(folder)).expect("a folder");
        let mut names: Vec<String> = entries
            .map(|entry| entry.expect("readable").file_name().into_string().expect("UTF-8"))
            .filter(|name| !name.starts_with('.'))
            .collect();
        names.sort_by(|one, other| other.cmp(one));
        names.into_iter().map(move |name| format!("{folder}/{name}"))
    };
    let examples = names("examples").map(|folder| format!("{folder}/README.md"));
    let pages = names("docs").filter(|name| name.ends_with(".md"));
    let all = examples.chain(["README.md".to_owned()]).chain(pages);
    all.filter(|guide| root().join(guide).is_file() && text_of(guide).contains("```sh\n")).collect()
}

/// The fenced blocks of a text, with their language.
fn blocks(text: &str) -> Vec<(&str, Vec<&str>)> {
    let mut blocks: Vec<(&str, Vec<&str>)> = Vec::new();
    let mut inside = false;
    for line in text.lines() {
        match line.strip_prefix("```") {
            Some(_) if inside => inside = false,
            Some(language) => {
                blocks.push((language, Vec::new()));
                inside = true;
            }
            None if inside => blocks.last_mut().expect("begun").1.push(line),
            None => (),
        }
    }
    blocks
}

/// The commands of a block: a line each, with the lines of its loop.
fn commands(lines: &[&str]) -> Vec<String> {
    let mut commands: Vec<String> = Vec::new();
    for line in lines.iter().filter(|line| !line.is_empty()) {
        match commands.last_mut().filter(|_| line.starts_with(' ') || line.starts_with("done")) {
            Some(loop_of) => *loop_of = format!("{loop_of}\n{line}"),
            None => commands.push((*line).to_owned()),
        }
    }
    commands
}

/// Copies a folder into the bench.
fn copy(bench: &Bench, from: &Path, to: &str) {
    for entry in std::fs::read_dir(from).expect("a folder") {
        let path = entry.expect("readable").path();
        let name = format!("{to}{}", path.file_name().expect("a name").to_string_lossy());
        match path.is_dir() {
            true => copy(bench, &path, &format!("{name}/")),
            false => bench.write(&name, std::fs::read(&path).expect("readable")),
        }
    }
}

/// Follows a guide in a folder of its own.
struct Follower<'g> {
    guide: &'g str,
    bench: Bench,
    /// Files and folders that are not there, since a recording is missing.
    missing: Vec<String>,
    /// What the last command printed; `None` where it was not run.
    printed: Option<String>,
    ran: usize,
    faults: Vec<String>,
}

impl<'g> Follower<'g> {
    fn new(guide: &'g str) -> Self {
        let bench = Bench::new();
        if guide.starts_with("examples/") {
            copy(&bench, root().join(guide).parent().expect("a folder"), "");
        }
        for (_, name, from) in GIVEN.into_iter().filter(|(of, ..)| *of == guide) {
            bench.write(name, std::fs::read(root().join(from)).expect("readable"));
        }
        let mut missing = Vec::new();
        for (name, from) in IMU_TK.into_iter().filter(|_| GUIDES_WITH_IMU_TK.contains(&guide)) {
            match shared_data(from) {
                Some(path) => bench.write(name, std::fs::read(path).expect("readable")),
                None => missing.push(name.to_owned()),
            }
        }
        Self { guide, bench, missing, printed: None, ran: 0, faults: Vec::new() }
    }

    fn follow(&mut self) {
        for (language, lines) in blocks(&text_of(self.guide)) {
            match language {
                "sh" => commands(&lines).iter().for_each(|command| self.run(command)),
                "text" => self.compare(&lines),
                "toml" => {
                    let name = lines.first().and_then(|line| line.strip_prefix("# "));
                    if let Some(name) = name.filter(|name| name.ends_with(".toml") && !name.contains(' ')) {
                        self.bench.write(name, lines.join("\n"));
                    }
                }
                _ => (),
            }
        }
        // our JSON files have the form of their kinds
        self.bench
            .files()
            .iter()
            .filter(|file| file.ends_with(".json"))
            .for_each(|file| drop(self.bench.json(file)));
    }

    fn run(&mut self, command: &str) {
        self.printed = None;
        let first = command.split_whitespace().next().unwrap_or_default();
        if OTHERS.contains(&first) || self.missing.iter().any(|name| command.contains(name.as_str())) {
            println!("{}: not run: {command}", self.guide);
            // nor is what it would write
            let output = command.split_once(" -o ").and_then(|(_, output)| output.split_whitespace().next());
            self.missing.extend(output.map(|output| format!("{output}/")));
            return;
        }
        let shortened = SHORTENED.into_iter().find(|_| !self.guide.starts_with("examples/"));
        let command =
            shortened.map_or(command.to_owned(), |(from, to)| format!("{command} ").replace(from, to));
        // faster, and beside another guide
        let command = command.replace(" --demo ", " --from demo@20 --listen 127.0.0.1:0 ");
        let status = command.split("exit status ").nth(1).map_or(Ok(0), |status| status.trim().parse());
        let outcome = self.bench.shell(&command);
        self.ran += 1;
        if status != Ok(outcome.status) {
            self.faults.push(format!(
                "{}: exit status {}\n{command}\n{}",
                self.guide, outcome.status, outcome.stderr
            ));
        }
        self.printed = Some(outcome.stdout + &outcome.stderr);
    }

    fn compare(&mut self, lines: &[&str]) {
        let Some(printed) = &self.printed else { return };
        let mut rest = printed.lines();
        for line in lines.iter().map(|line| line.trim()).filter(|line| *line != "…") {
            if !rest.any(|printed| printed.trim() == line) {
                self.faults.push(format!("{}: shown is\n{line}\nbut printed\n{printed}", self.guide));
                return;
            }
        }
    }
}
