//! `calibrant init`: writes a commented experiment file.

use crate::{Exit, console};
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::{Experiment, PRESETS, ResultPlaces, preset, write_atomically};
use std::path::PathBuf;

/// Write a commented experiment file, to be edited.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The preset: report, report-unknown, report-noisy, static-poses, static-poses-counts, imu, imu-counts, ferraris.
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
            // counts of unknown gain can be calibrated, but not simulated
            let simulable =
                Experiment::parse(text, None).is_ok_and(|experiment| experiment.sensor.gain.is_some());
            console::note(&if simulable {
                format!("wrote {file}. Edit it, then run: calibrant simulate {file} -o DIR")
            } else {
                format!(
                    "wrote {file}. Edit it, then run: calibrant calibrate {file} RECORDING -o DIR (calibrant simulate {file} needs the gains)"
                )
            });
        }
    }
    Ok(Exit::DONE)
}
