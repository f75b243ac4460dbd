//! The commands that follow `calibrant init`, from the experiment to a calibration. They work as printed.

use crate::console;
use calibrant::io::{Experiment, FileFormat, MachinePlan, MotionPlan, Plan};
use calibrant::motion::Trust;
use std::path::Path;

/// What to do with a new experiment file.
pub(super) struct NextSteps {
    /// The files that the commands need beside it, in words; empty where `simulate` makes them.
    needs: &'static str,
    commands: Vec<String>,
}

impl NextSteps {
    /// The next steps with this experiment, in this file.
    pub(super) fn of(experiment: &Experiment, file: &Path) -> Self {
        let file = quoted(&console::name(file));
        if experiment.columns.format == Some(FileFormat::Imucal) {
            let needs = ", with your session.csv and its sections.json";
            return Self { needs, commands: vec![calibrate(&file, "session.csv --sections sections.json")] };
        }
        // counts of unknown gain can be calibrated, but not simulated
        if experiment.sensor.gain.is_none() {
            let needs = ", with your recording.csv";
            return Self { needs, commands: vec![calibrate(&file, "recording.csv")] };
        }
        let commands = match &experiment.plan {
            Plan::Motion(plan) => of_motion(plan, &file),
            Plan::Holds(_) => rehearsal(&file, None),
            Plan::Machine(plan) => rehearsal(&file, Some(log_of(plan))),
        };
        Self { needs: "", commands }
    }

    /// The text that shows them.
    pub(super) fn note(&self) -> String {
        let lines: String = self.commands.iter().map(|command| format!("\n  {command}")).collect();
        format!("Edit it, then run{}:{lines}", self.needs)
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
        calibrate(file, &format!("simulated/recording.csv {motion}")),
    ]
}

/// Simulates a recording, and calibrates it with this log of its motion.
fn rehearsal(file: &str, log: Option<&str>) -> Vec<String> {
    let motion = log.map_or_else(String::new, |log| format!(" --motion simulated/{log}"));
    vec![
        format!("calibrant simulate {file} -o simulated"),
        calibrate(file, &format!("simulated/recording.csv{motion}")),
    ]
}

fn calibrate(file: &str, inputs: &str) -> String {
    format!("calibrant calibrate {file} {inputs} -o result")
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
