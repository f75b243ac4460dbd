//! The commands that follow `calibrant init`, from the experiment to a calibration. They work as printed.

use crate::console;
use calibrant::io::{Experiment, FileFormat, MachinePlan, MotionPlan, Plan};
use calibrant::motion::Trust;
use std::path::Path;

/// What to do with a new experiment file.
pub(super) struct NextSteps {
    /// The files that the commands need beside it, in words; empty where `simulate` makes them.
    pub(super) needs: &'static str,
    commands: Vec<String>,
}

impl NextSteps {
    /// The next steps with this experiment, in this file.
    pub(super) fn of(experiment: &Experiment, file: &Path) -> Self {
        let file = quoted(&console::name(file));
        if experiment.columns.format == Some(FileFormat::Imucal) {
            let needs = ", with your session.csv and its sections.json";
            return Self {
                needs,
                commands: vec![calibrate(&file, "session.csv", "--sections sections.json")],
            };
        }
        // counts of unknown gain can be calibrated, but not simulated
        if experiment.sensor.gain.is_none() {
            let needs = ", with your recording.csv";
            return Self { needs, commands: vec![calibrate(&file, "recording.csv", "")] };
        }
        if matches!(experiment.campaign(), Ok(Some(_))) {
            return Self { needs: "", commands: vec![format!("calibrant design {file} -o plan")] };
        }
        let commands = match &experiment.plan {
            Plan::Motion(plan) => of_motion(plan, &file),
            Plan::Holds(_) => rehearsal(&file, None),
            Plan::Machine(plan) => rehearsal(&file, Some(log_of(plan))),
        };
        Self { needs: "", commands }
    }

    /// Their lines.
    pub(super) fn lines(&self) -> String {
        self.commands.iter().map(|command| format!("  {command}\n")).collect()
    }
}

/// Designs a motion where one can be commanded, and rehearses it.
fn of_motion(plan: &MotionPlan, file: &str) -> Vec<String> {
    if plan.trust == Trust::Unknown {
        return rehearsal(file, Some("motion.csv"));
    }
    let motion = "--motion best/motion.csv";
    vec![
        format!("calibrant design {file} -o best"),
        format!("calibrant simulate {file} {motion} -o simulated"),
        calibrate(file, "simulated/recording.csv", motion),
    ]
}

/// Simulates a recording, and calibrates it with this log of its motion.
fn rehearsal(file: &str, log: Option<&str>) -> Vec<String> {
    let motion = log.map_or_else(String::new, |log| format!("--motion simulated/{log}"));
    vec![
        format!("calibrant simulate {file} -o simulated"),
        calibrate(file, "simulated/recording.csv", &motion),
    ]
}

/// A line that would be long ends with a backslash, as a shell takes it, and its options stand below.
fn calibrate(file: &str, recording: &str, option: &str) -> String {
    let gap = match option {
        "" => "",
        option if file.len() + recording.len() + option.len() > 46 => " \\\n    ",
        _ => " ",
    };
    format!("calibrant calibrate {file} {recording}{gap}{option} -o result")
}

/// The log that `simulate` writes.
fn log_of(plan: &MachinePlan) -> &'static str {
    if plan.has_joints() { "joints.csv" } else { "poses.csv" }
}

/// The name of a file as a shell takes it.
fn quoted(name: &str) -> String {
    let plain = |sign: char| sign.is_alphanumeric() || "-_./\\:".contains(sign);
    if name.chars().all(plain) { name.to_owned() } else { format!("'{}'", name.replace('\'', r"'\''")) }
}
