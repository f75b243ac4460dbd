//! `calibrant simulate`: draws a sensor from the datasheet and simulates its recording.

mod arguments;

pub(crate) use arguments::Arguments;

use crate::budget::budget;
use crate::console;
use crate::diagnostics::tell_all;
use crate::exit::Exit;
use calibrant::campaign::{Soak, design_over_cycles, timetable};
use calibrant::io::{Experiment, ResultPlaces, read_campaign_csv, read_poses};
use calibrant::session::MotionSource;
use calibrant::{SimulatedCampaign, SimulationOptions, simulate, simulate_campaign};

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
                .chain(&self.campaign)
                .cloned()
                .collect(),
        }
    }

    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

/// The soaks of the best campaign, in their order.
fn best(experiment: &Experiment) -> calibrant::Result<Vec<Soak>> {
    let Some((campaign, section)) = experiment.campaign()?.zip(experiment.campaign_section()) else {
        return Ok(Vec::new());
    };
    let (campaign, found) = design_over_cycles(&campaign, section.cycles())?;
    Ok(timetable(&campaign, &found.soaks).into_iter().map(|row| row.soak).collect())
}

/// Simulates the soaks of a campaign: those of the timetable, or of the best campaign.
fn campaign(arguments: &Arguments, experiment: &Experiment) -> calibrant::Result<Exit> {
    let soaks = match &arguments.campaign {
        Some(path) => read_campaign_csv(path)?,
        None => best(experiment)?,
    };
    let simulated = simulate_campaign(experiment, &soaks, arguments.seed)?;
    simulated.write(&arguments.output)?;
    let names = SimulatedCampaign::names(soaks.len());
    let ends = names
        .first()
        .zip(names.last())
        .map_or_else(String::new, |(first, last)| format!("{first} to {last}"));
    console::print(&format!(
        "{} soaks, seed {}: {ends} in {}\n",
        soaks.len(),
        simulated.seed,
        console::name(&arguments.output)
    ));
    Ok(Exit::DONE)
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    let experiment = arguments.settings.read(&arguments.experiment)?;
    if experiment.campaign_section().is_some() && arguments.poses.is_none() {
        return campaign(arguments, &experiment).map_err(|error| error.in_experiment(&arguments.experiment));
    }
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
