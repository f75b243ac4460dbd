//! `calibrant init`: writes a commented experiment file.

mod next_steps;

use crate::console;
use crate::exit::Exit;
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::{DATASHEETS, Datasheet, Experiment, PRESETS, ResultPlaces, nearest, preset, write_text};
use next_steps::NextSteps;
use std::path::PathBuf;

/// Write a commented experiment file, to be edited.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The preset. --list shows all of them.
    #[arg(default_value = "report")]
    preset: String,
    /// Sensor whose datasheet gives noise, ranges and sensitivity: adis16470, adxl355, bmi088, bmi270, icm-20948, icm-42688-p, lsm6dsv16x, mpu-6050, mpu-9250
    /// or mti-3.
    #[arg(long, value_name = "NAME", value_parser = datasheet)]
    sensor: Option<&'static Datasheet>,
    /// Where to write it (default: stdout).
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// List the presets, each with what it is for.
    #[arg(long, conflicts_with_all = ["preset", "sensor", "output"])]
    list: bool,
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
    if arguments.list {
        console::print_always(&list());
        return Ok(Exit::DONE);
    }
    let reject = |code, message, help| Err(Error::Experiment(Box::new(InputError::new(code, message, help))));
    let Some(text) = preset(&arguments.preset) else {
        let names: Vec<_> = PRESETS.iter().map(|preset| preset.name).collect();
        let near = nearest(&arguments.preset, names.iter().copied());
        let hint = near.map_or_else(String::new, |near| format!("did you mean `{near}`? "));
        return reject(
            Refusal::KeyUnknown,
            format!("there is no preset `{}`", arguments.preset),
            format!("{hint}choose one of {}", names.join(", ")),
        );
    };
    let takes_counts = text.lines().any(|line| line.starts_with("unit = \"counts\""));
    if let Some(sensor) = arguments.sensor.filter(|of| takes_counts && !of.has_counts()) {
        return reject(
            Refusal::ExperimentUnsuited,
            format!("the datasheet of {} has no sensitivity of counts", sensor.name),
            "choose the preset that is not of counts: imu, static-poses".into(),
        );
    }
    if let Some(sensor) =
        arguments.sensor.filter(|of| of.noise_mdps_per_rthz.is_none() && text.contains("\n[gyroscope]"))
    {
        return reject(
            Refusal::ExperimentUnsuited,
            format!("{} is an accelerometer alone, and the preset is of an IMU", sensor.name),
            "choose the preset of an accelerometer: static-poses, faces".into(),
        );
    }
    let text = arguments.sensor.map_or_else(|| text.to_owned(), |sensor| sensor.in_experiment(text));
    match &arguments.output {
        None => console::print_always(&text),
        Some(path) => {
            write_text(path, &text)?;
            let next = NextSteps::of(&Experiment::parse(&text, None)?, path);
            console::print(&format!("wrote {}. Edit it, then run{}:\n", console::name(path), next.needs));
            console::print_lines(&next.lines());
        }
    }
    Ok(Exit::DONE)
}

/// One line for each preset: its name, and what it is for.
fn list() -> String {
    let width = PRESETS.iter().map(|preset| preset.name.len()).max().unwrap_or(0);
    PRESETS.iter().map(|preset| format!("{:width$}  {}\n", preset.name, preset.summary)).collect()
}

fn names() -> Vec<String> {
    DATASHEETS.iter().map(|datasheet| datasheet.name.to_lowercase()).collect()
}

fn datasheet(name: &str) -> Result<&'static Datasheet, String> {
    let others = || {
        format!(
            "the datasheets at hand are {}; of another sensor write noise_ug_per_rthz, noise_mdps_per_rthz and noise_bandwidth_hz into the file",
            names().join(", ")
        )
    };
    Datasheet::of(name).ok_or_else(others)
}
