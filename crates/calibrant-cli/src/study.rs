//! `calibrant study`: simulates many sensors, and compares estimates with the truth.

use crate::budget::budget;
use crate::diagnostics::tell_all;
use crate::exit::Exit;
use crate::{console, interruption};
use calibrant::error::{Error, InputError, Refusal};
use calibrant::io::{
    CampaignStudyFile, Experiment, Plan, ResultPlaces, StudyFile, to_json, write_json, write_text,
};
use calibrant::report::{About, campaign_study_sheet, study_sheet};
use calibrant::session::MotionSource;
use calibrant::study::Studies;
use calibrant::{CampaignStudy, DesignChoice, RehearsalPlan, StudyChoice, StudyPlan, TrajectoryPlan};
use std::path::PathBuf;

/// The experiment without a file: the thesis's chapters 3 and 4.
const DEFAULT: &str = "report";

/// Simulate many sensors. Compare predicted and realised errors of their calibrations, and the optimal motion with a random one.
///
/// Each sensor is calibrated on a random motion. The best motion is designed at this estimate, and the sensor is calibrated on it. If no motion can be
/// designed (trust "unknown", or limits that do not bound it), the sensors are calibrated once. With joints in [machine] it rehearses the machine: the best trajectory
/// is designed, and each simulated sensor is calibrated from a recording of a plain routine and of that trajectory. With [campaign] it rehearses campaigns over
/// temperature: the best one beside what is usual, of sensors that are drawn from what the file says of them. Without EXPERIMENT, the command repeats chapters 3 and 4
/// of the thesis (vamvaka2021 in references.bib), which `calibrant init report` describes. Writes study.json and report.html.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The experiment file (default: the preset report; see `calibrant init`).
    experiment: Option<PathBuf>,
    #[command(flatten)]
    settings: crate::experiment_settings::Settings,
    /// The initial motion of every sensor (default: a random one for each).
    #[arg(long, value_name = "CSV")]
    motion: Option<PathBuf>,
    /// Number of sensors of every experiment (default: from [study]).
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    sensors: Option<u32>,
    /// Starts of each sensor's design (default: from [study] or [design]).
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    starts: Option<u32>,
    /// Seed of all random numbers (default: from [study]).
    #[arg(long, allow_negative_numbers = true)]
    seed: Option<u64>,
    /// Print study.json on stdout instead of the tables.
    #[arg(long)]
    json: bool,
    /// Directory for the results.
    #[arg(short, long, value_name = "DIR", default_value = "calibrant-study")]
    output: PathBuf,
}

impl crate::run::Run for Arguments {
    fn places(&self) -> ResultPlaces {
        let names = ["study.json", "report.html"];
        ResultPlaces {
            directory: Some(self.output.clone()),
            results: names.map(|name| self.output.join(name)).to_vec(),
            inputs: self.experiment.iter().chain(&self.motion).cloned().collect(),
        }
    }

    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    let experiment = arguments.settings.read_or(arguments.experiment.as_deref(), DEFAULT)?;
    if experiment.campaign_section().is_some() {
        return campaign(arguments, &experiment);
    }
    let of_thesis = experiment.is_of_thesis();
    let studies = match experiment.plan {
        Plan::Machine(_) => rehearsed(arguments, experiment)?,
        Plan::Motion(_) | Plan::Holds(_) => studied(arguments, &experiment)?,
    };
    tell_all(&studies.notes);
    write_json(&arguments.output.join("study.json"), &StudyFile { studies: &studies })?;
    let report = arguments.output.join("report.html");
    let about = About {
        title: match &arguments.experiment {
            Some(path) => format!("Study of {}", path.display()),
            None => "Calibration and optimal experimental design: the thesis's chapters 3 and 4".into(),
        },
        of_thesis,
        ..About::default()
    };
    let sheet = study_sheet(&studies, &about);
    write_text(&report, &sheet.html())?;
    console::result(arguments.json, || to_json(&StudyFile { studies: &studies }), &sheet, None, &[report])?;
    Ok(Exit::DONE)
}

/// The studies of a commanded motion.
fn studied(arguments: &Arguments, experiment: &Experiment) -> calibrant::Result<Studies> {
    let choice = StudyChoice {
        motion: arguments.motion.clone().map(MotionSource::File),
        sensors: arguments.sensors.map(|sensors| sensors as usize),
        seed: arguments.seed,
        starts: arguments.starts.map(|starts| starts as usize),
        budget: budget(),
        interruption: interruption::keeping_the_best(),
    };
    let plan = StudyPlan::new(experiment, &choice)?;
    let bar = console::progress(plan.steps(), "sensors");
    let outcome = plan.run(&|done| bar.inc(done));
    bar.finish_and_clear();
    outcome
}

/// The rehearsal of a machine.
fn rehearsed(arguments: &Arguments, experiment: Experiment) -> calibrant::Result<Studies> {
    if arguments.motion.is_some() {
        let message = "--motion is of the study of a [motion] experiment: a rehearsal designs the motions of its machine";
        let input_error = InputError::new(Refusal::ExperimentUnsuited, message, "leave it away");
        return Err(Error::experiment(input_error));
    }
    let interruption = interruption::keeping_the_best();
    let (sensors, seed) = (experiment.study.sensors, experiment.study.seed);
    let choice = DesignChoice {
        starts: arguments.starts.map(|starts| starts as usize),
        interruption: interruption.clone(),
        ..DesignChoice::default()
    };
    let plan = TrajectoryPlan::new(experiment, &choice)?;
    let bar = console::spinner("design");
    bar.enable_steady_tick(std::time::Duration::from_millis(200));
    let design = plan.design();
    bar.finish_and_clear();
    let rehearsal = RehearsalPlan {
        plan: &plan,
        sensors: arguments.sensors.map_or(sensors, |sensors| sensors as usize),
        seed: arguments.seed.unwrap_or(seed),
        interruption,
        budget: budget(),
    };
    let bar = console::progress(rehearsal.sensors as u64, "sensors");
    let outcome = rehearsal.run(&design?, &|done| bar.inc(done));
    bar.finish_and_clear();
    outcome
}

/// The rehearsal of a campaign over temperature: the best one, and the usual ones in the same time.
fn campaign(arguments: &Arguments, experiment: &Experiment) -> calibrant::Result<Exit> {
    let sensors = arguments.sensors.map(|sensors| sensors as usize);
    let study = CampaignStudy::new(experiment, sensors, arguments.seed);
    let bar = console::progress(study.sensors as u64, "sensors");
    let found = study.run(|done| bar.set_position(done as u64));
    bar.finish_and_clear();
    let found = found?;
    write_json(&arguments.output.join("study.json"), &CampaignStudyFile(&found))?;
    let report = arguments.output.join("report.html");
    let path = arguments.experiment.as_ref().map_or_else(String::new, |path| path.display().to_string());
    let about = About { title: format!("Study of {path}"), ..About::default() };
    let sheet = campaign_study_sheet(&found, &about);
    write_text(&report, &sheet.html())?;
    console::result(arguments.json, || to_json(&CampaignStudyFile(&found)), &sheet, None, &[report])?;
    Ok(Exit::DONE)
}
