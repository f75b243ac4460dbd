//! One calibration over temperature from the calibrations of several soaks: reads, fits, judges, writes.

use crate::batch::in_parallel;
use crate::session::{Session, Source, doubts};
use calibrant_campaign::fit::{CampaignModel, FittedCampaign, fit};
use calibrant_core::diagnostic::campaign::SoakLeftOut;
use calibrant_core::diagnostic::{Code, Diagnostic, Phrase, Verdict};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::estimate::{HoldScatter, Validation};
use calibrant_io::{
    CampaignCalibrationFile, Experiment, Judgement, Origin, ReadSoak, parse_soak, to_json, write_json,
    write_text,
};
use calibrant_report::{About, Sheet, campaign_fit_sheet};
use std::collections::BTreeMap;
use std::path::Path;

/// A calibration over temperature with everything that stands beside it.
#[derive(Debug, Clone)]
pub struct CampaignCalibration {
    /// The calibration.
    pub fitted: FittedCampaign,
    /// What was fitted.
    pub model: CampaignModel,
    /// The sensor, and the files of all soaks.
    pub origin: Origin,
    /// Diagnostics that the files mark as allowed.
    pub allowed: Vec<Code>,
    /// How the holds of the soaks scatter.
    pub scatter: HoldScatter,
    /// The calibration on recordings that were not used.
    pub validations: Vec<Validation>,
    about: About,
}

impl CampaignCalibration {
    /// From the `calibration.json` of each soak: its name, and its text or why there is none. Soaks that cannot be used are left out, and named. They are taken
    /// in the order of their times where all have one, otherwise as they are given. What is left out goes to `notes`, so that it is known even where an error ends the work; otherwise it is among
    /// the warnings of the result.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the experiment has no `[campaign]`. As [`fit`] where the soaks are not alike, or leave coefficients open.
    pub fn of_soaks(
        experiment: &Experiment,
        soaks: impl IntoIterator<Item = (String, std::result::Result<String, String>)>,
        allowed: &[Code],
        notes: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        let model = experiment.campaign_model()?.ok_or_else(|| {
            let help = "see `calibrant init campaign`";
            Error::experiment(InputError::new(Refusal::KeyMissing, "the experiment has no [campaign]", help))
        })?;
        let mut kept: Vec<ReadSoak> = Vec::new();
        let mut left_out: BTreeMap<String, Vec<String>> = BTreeMap::new();
        let soaks: Vec<_> = soaks.into_iter().collect();
        let read = |k: usize| {
            let (name, text) = &soaks[k];
            let soak = parse_soak(text.as_ref()?, name).map_err(|error| error.to_string())?;
            soak.bad.as_ref().map_or(Ok(soak.clone()), |bad| Err(bad.without_file()))
        };
        let all = in_parallel(soaks.len(), read);
        for ((name, _), read) in soaks.into_iter().zip(all) {
            match read {
                Ok(soak) => kept.push(soak),
                Err(why) => left_out.entry(why).or_default().push(name),
            }
        }
        notes.extend(left_out.into_iter().map(|(why, soaks)| SoakLeftOut { soaks, why: Phrase(why) }.into()));
        if kept.is_empty() {
            let (message, help) = ("no soak can be used", "look at the report of each soak");
            return Err(Error::recording(InputError::new(Refusal::RecordingsUnlike, message, help)));
        }
        refuse_repeated(&kept)?;
        if kept.iter().all(|soak| soak.recorded.is_some()) {
            kept.sort_by_key(|soak| soak.recorded.map(|time| time.seconds()));
        }
        let calibrations: Vec<_> = kept.iter().map(|soak| soak.calibration.clone()).collect();
        let mut fitted = fit(&model, &calibrations)?;
        fitted.warnings.append(notes);
        let first = kept[0].sensor.clone();
        let origin = Origin {
            sensor: first.filter(|first| kept.iter().all(|soak| soak.sensor.as_ref() == Some(first))),
            recorded: kept.iter().filter_map(|soak| soak.recorded).min_by_key(|time| time.seconds()),
            experiment: Some(experiment.origin()),
            inputs: kept.iter().flat_map(|soak| soak.inputs.clone()).collect(),
            ..Origin::default()
        };
        let soaks = format!("{}, from {} files", kept.len(), origin.inputs.len());
        let scatter = HoldScatter::pooled(kept.iter().map(|soak| &soak.scatter));
        let found =
            Self::of("Calibration over temperature", ("Soaks", soaks), (fitted, model), origin, allowed);
        Ok(Self { scatter, ..found })
    }

    pub(crate) fn of(
        title: &str,
        (what, which): (&str, String),
        (fitted, model): (FittedCampaign, CampaignModel),
        origin: Origin,
        allowed: &[Code],
    ) -> Self {
        let experiment = origin.experiment.as_ref().map(|of| ("Experiment".to_owned(), of.file.clone()));
        let facts = experiment.into_iter().chain([(what.to_owned(), which)]).collect();
        let about = About { title: title.to_owned(), facts, ..About::default() };
        let (scatter, validations) = (HoldScatter::default(), Vec::new());
        let mut found =
            Self { fitted, model, origin, allowed: allowed.to_vec(), scatter, validations, about };
        found.about.verdict = Some(found.verdict());
        found
    }

    /// Tries it on a recording of the sensor that is not among the soaks: each direction of its temperature by itself.
    ///
    /// # Errors
    /// [`Error::Recording`] where the recording cannot be read, has no temperature or no holds, or is another sensor's. [`Error::Experiment`] where it is one of
    /// the soaks.
    pub fn validate(mut self, of_one_soak: &Session, recording: &Source) -> Result<Self> {
        self.validations = of_one_soak.on_held_out(recording, &mut self)?;
        self.fitted.warnings.extend(doubts(&self.validations));
        self.about.verdict = Some(self.verdict());
        Ok(self)
    }

    /// May the result be used?
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        Verdict::on(self.fitted.warnings.iter().map(Diagnostic::code), &self.allowed)
    }

    fn file(&self) -> CampaignCalibrationFile<'_> {
        let judgement = Judgement { allowed: &self.allowed, ..Judgement::default() };
        let validations = &self.validations;
        CampaignCalibrationFile {
            fitted: &self.fitted,
            model: &self.model,
            origin: &self.origin,
            validations,
            judgement,
        }
    }

    /// The text of `calibration.json`.
    #[must_use]
    pub fn json(&self) -> String {
        to_json(&self.file())
    }

    /// The calibration for people.
    #[must_use]
    pub fn sheet(&self) -> Sheet<'_> {
        campaign_fit_sheet(&self.fitted, &self.model, &self.validations, &self.about)
    }

    /// Writes `calibration.json` and, where it is wanted, `report.html`.
    ///
    /// # Errors
    /// [`Error::Output`] where a file cannot be written.
    pub fn write(&self, directory: &Path, report: bool) -> Result<()> {
        write_json(&directory.join("calibration.json"), &self.file())?;
        if report { write_text(&directory.join("report.html"), &self.sheet().html()) } else { Ok(()) }
    }
}

/// Refuses two calibrations of one recording: it would count twice.
fn refuse_repeated(soaks: &[ReadSoak]) -> Result<()> {
    for (k, soak) in soaks.iter().enumerate() {
        let same = |other: &&ReadSoak| {
            other.inputs.iter().any(|input| soak.inputs.iter().any(|own| own.sha256 == input.sha256))
        };
        if let Some(other) = soaks[..k].iter().find(same) {
            let message = format!(
                "{} and {} are of one recording: it would count twice",
                other.calibration.name, soak.calibration.name
            );
            return Err(Error::recording(InputError::new(
                Refusal::RecordingRepeated,
                message,
                "give each soak once",
            )));
        }
    }
    Ok(())
}
