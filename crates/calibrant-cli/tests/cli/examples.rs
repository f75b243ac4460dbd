//! Tests of the READMEs of `examples/`: their commands run, and print the output shown there.

use crate::bench::Bench;
use std::path::{Path, PathBuf};

/// Copies a folder into the bench.
fn copy(bench: &Bench, from: &Path, to: &str) {
    for entry in std::fs::read_dir(from).expect("a folder") {
        let path = entry.expect("readable").path();
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        let name = if to.is_empty() { name } else { format!("{to}/{name}") };
        if path.is_dir() {
            copy(bench, &path, &name);
        } else {
            bench.write(&name, std::fs::read(&path).expect("readable"));
        }
    }
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

/// Runs the commands of a text: the lines of `sh` blocks that begin with `calibrant`. A comment may give another exit
/// status than 0. The last command must have printed the lines of the `text` block below, in this order; `…`
/// stands for omitted lines.
pub(crate) fn follow_text(bench: &Bench, name: &str, text: &str, commands: usize) {
    let (mut ran, mut printed) = (0, String::new());
    for (language, lines) in blocks(text) {
        if language == "sh" {
            for line in lines.iter().filter_map(|line| line.strip_prefix("calibrant ")) {
                let (arguments, comment) = line.split_once(" #").unwrap_or((line, ""));
                let status = comment
                    .split("exit status ")
                    .nth(1)
                    .map_or(0, |status| status.trim().parse().unwrap_or_else(|_| panic!("{name}: {line}")));
                let outcome = bench.run(arguments);
                assert_eq!(outcome.status, status, "{name}: {outcome:?}");
                printed = outcome.stdout + &outcome.stderr;
                ran += 1;
            }
        } else if language == "text" {
            let mut rest = printed.lines();
            for line in lines.iter().map(|line| line.trim()).filter(|line| *line != "…") {
                let found = rest.any(|printed| printed.trim() == line);
                assert!(found, "{name}: the text says\n{line}\nbut the program\n{printed}");
            }
        }
    }
    assert_eq!(ran, commands, "{name}: number of commands");
    bench.files().iter().filter(|file| file.ends_with(".json")).for_each(|file| drop(bench.json(file)));
}

/// Runs the README of an example, in its folder.
fn follow(name: &str, commands: usize) {
    let folder: PathBuf = [env!("CARGO_MANIFEST_DIR"), "../../examples", name].iter().collect();
    let bench = Bench::new();
    copy(&bench, &folder, "");
    follow_text(&bench, name, &bench.read("README.md"), commands);
}

#[test]
fn robot_motion() {
    follow("01_robot_motion", 7);
}

#[test]
fn unknown_motion() {
    follow("02_unknown_motion", 5);
}

#[test]
fn static_poses() {
    follow("03_static_poses", 6);
}

#[test]
fn many_sensors() {
    follow("04_many_sensors", 5);
}

#[test]
fn design_a_motion() {
    follow("05_design_a_motion", 9);
}

#[test]
fn whole_imu() {
    follow("06_whole_imu", 14);
}

#[test]
fn robot_arm() {
    follow("07_robot_arm", 8);
}

#[test]
fn motion_capture() {
    follow("08_motion_capture", 5);
}

#[test]
fn rate_table() {
    follow("09_rate_table", 6);
}

#[test]
fn best_poses() {
    follow("10_best_poses", 8);
}

#[test]
fn design_for_an_arm() {
    follow("11_design_for_an_arm", 4);
}

/// The guide takes its first poses from example 10.
#[test]
fn guide_to_the_design_of_poses() {
    let root: PathBuf = [env!("CARGO_MANIFEST_DIR"), "../.."].iter().collect();
    let bench = Bench::new();
    copy(&bench, &root.join("examples/10_best_poses"), "");
    let guide = std::fs::read_to_string(root.join("docs/design-poses.md")).expect("the guide");
    bench.preset("static-poses", "static.toml", &[]);
    follow_text(&bench, "design-poses.md", &guide, 6);
}

/// The guide to the production line, with three simulated IMUs and a broken file.
#[test]
fn guide_to_the_production_line() {
    let bench = Bench::new();
    bench.preset("imu", "imu.toml", &[]);
    for (seed, name) in ["a", "b", "c"].into_iter().enumerate() {
        bench.run(&format!("simulate imu.toml --seed {} -o made", seed + 1)).done();
        bench.write(&format!("line/{name}.csv"), bench.read("made/recording.csv"));
    }
    let text = bench.read("line/b.csv");
    let row = text.lines().nth(57).expect("line 58");
    let reading = row.split(',').nth(1).expect("a field");
    bench.write("broken.csv", text.replace(row, &row.replacen(reading, "overrun", 1)));
    std::fs::remove_file(bench.path("imu.toml")).expect("there");
    let guide = include_str!("../../../../docs/production-line.md");
    let guide =
        guide.replace("line/*.csv", "line/a.csv line/b.csv line/c.csv").replace(" > results.json", "");
    let limits = blocks(&guide).into_iter().find(|(language, _)| *language == "toml").expect("limits").1;
    bench.write("limits.toml", limits.join("\n"));
    // the shell shows the columns of summary.csv
    let (before, rest) = guide.split_once("## summary.csv").expect("a part");
    let (shown, after) = rest.split_once("Then follow value").expect("its end");
    follow_text(&bench, "production-line.md", &format!("{before}{after}"), 9);
    let columns = blocks(shown).pop().expect("the columns").1.join(",");
    assert!(bench.read("results/summary.csv").lines().any(|line| line.starts_with(&columns)), "{columns}");
}

/// The README's calibration, of a simulated IMU.
#[test]
fn calibration_in_the_readme() {
    let bench = Bench::new();
    bench.preset("imu", "simulated.toml", &[]);
    bench.run("simulate simulated.toml -o simulated").done();
    bench.write("recording.csv", bench.read("simulated/recording.csv"));
    let readme = include_str!("../../../../README.md");
    let part =
        readme.split("\n## ").find(|part| part.starts_with("Calibrate your own IMU\n")).expect("the part");
    follow_text(&bench, "README.md", part, 5);
}

/// The README's design, from `init` to a calibration.
#[test]
fn design_in_the_readme() {
    let readme = include_str!("../../../../README.md");
    let part = readme.split("\n## ").find(|part| part.starts_with("Design a motion\n")).expect("the part");
    follow_text(&Bench::new(), "README.md", part, 4);
}

#[test]
fn every_example_is_followed() {
    let root: PathBuf = [env!("CARGO_MANIFEST_DIR"), "../../examples"].iter().collect();
    let mut names: Vec<_> = std::fs::read_dir(root)
        .expect("examples")
        .map(|entry| entry.expect("readable").path())
        .filter(|path| path.is_dir())
        .map(|path| path.file_name().expect("a name").to_string_lossy().into_owned())
        .collect();
    names.sort();
    assert_eq!(
        names,
        [
            "01_robot_motion",
            "02_unknown_motion",
            "03_static_poses",
            "04_many_sensors",
            "05_design_a_motion",
            "06_whole_imu",
            "07_robot_arm",
            "08_motion_capture",
            "09_rate_table",
            "10_best_poses",
            "11_design_for_an_arm"
        ]
    );
}
