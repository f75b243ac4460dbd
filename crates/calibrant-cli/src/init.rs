//! `calibrant init`: writes a commented experiment file.

use crate::{Exit, console};
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::{Experiment, PRESETS, Plan, ResultPlaces, preset, write_atomically};
use std::path::PathBuf;

/// Write a commented experiment file, to be edited.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The preset: report, report-unknown, report-noisy, stage, static-poses, faces, static-poses-counts, imu, imu-counts, ferraris, arm, rate-table, gantry, mocap.
    #[arg(default_value = "report")]
    preset: String,
    /// Where to write it (default: stdout).
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

impl crate::run::Run for Arguments {
    fn places(&self) -> ResultPlaces {
        ResultPlaces { results: self.output.iter().cloned().collect(), ..ResultPlaces::default() }
    }

    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    let reject = |code, message, help| Err(Error::Experiment(Box::new(InputError::new(code, message, help))));
    let Some(text) = preset(&arguments.preset) else {
        let names: Vec<_> = PRESETS.iter().map(|(name, _)| *name).collect();
        return reject(
            Refusal::KeyUnknown,
            format!("there is no preset `{}`", arguments.preset),
            format!("choose one of {}", names.join(", ")),
        );
    };
    match &arguments.output {
        None => console::print(text),
        Some(path) => {
            write_atomically(path, |out| out.write_all(text.as_bytes()))?;
            let file = path.display();
            let experiment = Experiment::parse(text, None)?;
            let then = match experiment.plan {
                Plan::Machine(_) => format!("calibrant calibrate {file} RECORDING --motion LOG -o DIR"),
                // counts of unknown gain can be calibrated, but not simulated
                _ if experiment.sensor.gain.is_none() => format!(
                    "calibrant calibrate {file} RECORDING -o DIR (calibrant simulate {file} needs the gains)"
                ),
                _ => format!("calibrant simulate {file} -o DIR"),
            };
            console::note(&format!("wrote {file}. Edit it, then run: {then}"));
        }
    }
    Ok(Exit::DONE)
}
