//! `calibrant simulate`: draws a sensor from the datasheet and simulates its recording.

mod arguments;

pub(crate) use arguments::Arguments;

use crate::budget::budget;
use crate::console;
use crate::diagnostics::tell_all;
use crate::exit::Exit;
use calibrant::io::{ResultPlaces, read_poses};
use calibrant::session::MotionSource;
use calibrant::{SimulationOptions, simulate};

impl crate::run::Run for Arguments {
    fn places(&self) -> ResultPlaces {
        let names =
            ["recording.csv", "truth.json", "motion.csv", "true_motion.csv", "joints.csv", "poses.csv"];
        ResultPlaces {
            directory: Some(self.output.clone()),
            results: names.map(|name| self.output.join(name)).to_vec(),
            inputs: std::iter::once(&self.experiment)
                .chain(&self.motion)
                .chain(&self.poses)
                .cloned()
                .collect(),
        }
    }

    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    let experiment = arguments.settings.read(&arguments.experiment)?;
    let options = SimulationOptions {
        seed: arguments.seed,
        recording: arguments.recording.into(),
        motion: arguments.motion.clone().map(MotionSource::File),
        poses: arguments.poses.as_deref().map(read_poses).transpose()?,
        budget: budget(),
    };
    let simulated =
        simulate(&experiment, &options).map_err(|error| error.in_experiment(&arguments.experiment))?;
    tell_all(&simulated.notes);
    simulated.write(&arguments.output)?;
    let which =
        if arguments.recording == 1 { String::new() } else { format!(", recording {}", arguments.recording) };
    console::print(&format!(
        "{} samples, seed {}{which}: {}\n",
        simulated.samples(),
        simulated.seed,
        console::name(&arguments.output.join("recording.csv"))
    ));
    Ok(Exit::DONE)
}
