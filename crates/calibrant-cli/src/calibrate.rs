//! `calibrant calibrate`: from recordings to parameters with their covariance.

mod arguments;
mod batch;
mod campaign;
mod job;
mod naming;
mod one;
mod sources;
mod unused;

pub(crate) use arguments::Arguments;

use crate::exit::Exit;
use calibrant::batch::{RESULT_FILES, folder_names};
use calibrant::io::ResultPlaces;
use std::path::PathBuf;
use std::sync::PoisonError;

impl crate::run::Run for Arguments {
    fn places(&self) -> ResultPlaces {
        let others = [
            &self.accept,
            &self.motion,
            &self.sections,
            &self.validate,
            &self.validate_gyroscope,
            &self.validate_motion,
            &self.records,
        ];
        let others = others.into_iter().flatten();
        let inputs = self.recordings.iter().chain(&self.gyroscope).chain([&self.experiment]).chain(others);
        let folders = match self.recordings.as_slice() {
            [_] => vec![String::new()],
            _ if self.together => vec![String::new()],
            several => folder_names(several),
        };
        let of_folder = |folder: &String| RESULT_FILES.map(|name| self.output.join(folder).join(name));
        ResultPlaces {
            directory: Some(self.output.clone()),
            results: folders
                .iter()
                .flat_map(of_folder)
                .chain(["summary.csv", "batch.html"].map(|name| self.output.join(name)))
                .chain(RESULT_FILES.map(|name| self.output.join(name)))
                .chain(self.residuals.clone())
                .collect(),
            inputs: inputs.cloned().collect(),
        }
    }

    fn kept(&self) -> Vec<PathBuf> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    let experiment = arguments.settings.read(&arguments.experiment)?;
    unused::warn(arguments, &experiment);
    if campaign::is_one(arguments, &experiment) {
        return campaign::run(arguments, &experiment);
    }
    // without orders of its own, a recording of a campaign is one soak
    let is_soak = experiment.campaign_section().is_some()
        && experiment.imu.as_ref().is_none_or(|imu| imu.thermal.is_none())
        && !arguments.together;
    let of_one = if is_soak { experiment.of_one_soak()? } else { experiment.clone() };
    let batch = job::batch(arguments, &of_one)?;
    if is_soak && campaign::is_of_ramp(&batch) {
        return campaign::run(arguments, &experiment);
    }
    match batch.sources() {
        [source] => Ok(one::run(arguments, &batch, source)),
        _ => batch::run(arguments, &batch),
    }
}
