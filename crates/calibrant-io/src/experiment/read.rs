//! Reads an experiment file, and makes the experiment of its sections.

use super::accept::{AcceptSection, acceptance_limits};
use super::campaign::CampaignSection;
use super::columns::ColumnsSection;
use super::document::{Document, LARGEST, Setting};
use super::file::ExperimentFile;
use super::gyroscope::GyroscopeSection;
use super::number::Count;
use super::refused_key::{missing, refused};
use super::remedies::remedy;
use super::spreads::need_spreads;
use super::{CalibrateOptions, DesignOptions, ImuPlan, Plan, Prior, StudyOptions};
use crate::experiment::presets::preset;
use calibrant_core::acceptance::AcceptanceLimit;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::motion::Limits;
use calibrant_core::sensor::{ReadingUnit, Sensor};
use calibrant_recording::text::decoding;
use calibrant_recording::{HashedFile, ImuReadOptions, file_name};
use serde::Deserialize;
use std::path::Path;

/// The content of an experiment file.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// The text from which it was read, by its content. Without a file its name is `experiment`.
    pub source: HashedFile,
    /// What was read, to notice what is changed in code.
    read: String,
    /// `[sensor]`: the datasheet.
    pub sensor: Sensor,
    /// `[motion]`, `[holds]` or `[machine]`.
    pub plan: Plan,
    /// `[gyroscope]`, `[known]` and `[temperature]`, for an IMU.
    pub imu: Option<ImuPlan>,
    /// `[campaign]`: a campaign over temperature, where the section is there.
    pub(super) campaign: Option<CampaignSection>,
    /// `[columns]`: what the recordings' files do not state themselves; nothing where the section is absent.
    pub columns: ImuReadOptions,
    /// `[limits]`; none where the section is absent.
    pub limits: Limits,
    /// `[calibrate]`.
    pub calibrate: CalibrateOptions,
    /// `[accept]`: the limits that a result must keep; none where the section is absent.
    pub accept: Vec<AcceptanceLimit>,
    /// `[design]`.
    pub design: DesignOptions,
    /// `[study]`.
    pub study: StudyOptions,
}

/// A file that may have one section alone.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SectionAlone {
    #[serde(rename = "schema")]
    _schema: Option<Count<0, { u64::MAX }>>,
    columns: Option<ColumnsSection>,
    accept: Option<AcceptSection>,
}

/// Reads `[columns]` of a file that may have nothing else. It is an experiment file, or one with this table
/// alone (and optionally `schema = 1`).
///
/// # Errors
/// As [`Experiment::read`], whatever section is wrong. [`Error::Experiment`] where there is no `[columns]`
/// section, or an empty one.
pub fn read_columns(path: &Path) -> Result<ImuReadOptions> {
    let alone = |alone: &SectionAlone| options_of(alone.columns.as_ref());
    let columns = one_section(path, "columns", alone, |experiment| experiment.columns)?;
    if columns == ImuReadOptions::default() {
        return Err(nothing_there(
            path,
            "there is no [columns] section",
            "add one, or leave option `columns` away",
        ));
    }
    Ok(columns)
}

/// Reads `[accept]` of a file that may have nothing else. It is an experiment file, or one with this table
/// alone (and optionally `schema = 1`).
///
/// # Errors
/// As [`Experiment::read`], whatever section is wrong. [`Error::Experiment`] where there is no `[accept]`
/// section, or an empty one.
pub fn read_acceptance(path: &Path) -> Result<Vec<AcceptanceLimit>> {
    let alone = |alone: &SectionAlone| limits_of(alone.accept.as_ref());
    let limits = one_section(path, "accept", alone, |experiment| experiment.accept)?;
    if limits.is_empty() {
        return Err(nothing_there(
            path,
            "there is no limit in [accept]",
            "add some, or leave option `accept` away",
        ));
    }
    Ok(limits)
}

/// What a file says in this section: alone, or as part of an experiment.
fn one_section<T>(
    path: &Path,
    section: &str,
    alone: impl Fn(&SectionAlone) -> Result<T>,
    whole: impl Fn(Experiment) -> T,
) -> Result<T> {
    let text = decoding::read_text(path, LARGEST, "the experiment file").map_err(Error::Experiment)?;
    let document = Document::parse(&text, Some(path))?;
    if document.has_others(&["schema", section]) {
        return Experiment::parse(&text, Some(path)).map(whole);
    }
    alone(&document.read()?).map_err(|error| document.placed(error))
}

fn nothing_there(path: &Path, message: &str, help: &str) -> Error {
    Error::experiment(InputError::new(Refusal::KeyMissing, message, help).in_file(path))
}

fn options_of(section: Option<&ColumnsSection>) -> Result<ImuReadOptions> {
    section.map_or(Ok(ImuReadOptions::default()), ColumnsSection::options)
}

fn limits_of(section: Option<&AcceptSection>) -> Result<Vec<AcceptanceLimit>> {
    section.map_or(Ok(Vec::new()), acceptance_limits)
}

impl ExperimentFile {
    /// The form of the preset of this name.
    #[must_use]
    pub fn preset(name: &str) -> Option<Self> {
        Self::parse(preset(name)?, None).ok()
    }

    /// Reads the text of an experiment file: its keys, types and ranges. `file` serves only for its name in
    /// errors.
    ///
    /// # Errors
    /// [`Error::Experiment`] with line, column, key and excerpt. The TOML is invalid, a key is unknown or
    /// missing, or a value has the wrong type or is out of range.
    pub fn parse(text: &str, file: Option<&Path>) -> Result<Self> {
        Self::of(&Document::parse(text, file)?)
    }

    /// Reads a document, which describes one plan.
    fn of(document: &Document<'_>) -> Result<Self> {
        if !document.has("schema") {
            return Err(document.placed(missing("schema", remedy("schema"))));
        }
        let plans: Vec<&str> =
            ["motion", "holds", "machine"].into_iter().filter(|section| document.has(section)).collect();
        if let [one, other, ..] = plans.as_slice() {
            let help = "an experiment is one or the other: take one of them out";
            let error = refused(*other, format!("[{one}] and [{other}] are both there"), help);
            return Err(document.placed(error));
        }
        let form: Self = document.read()?;
        if form.holds.is_some() && !document.has("holds.gauge") {
            return Err(document.placed(missing("holds.gauge", remedy("holds.gauge"))));
        }
        Ok(form)
    }

    /// The text of such a file.
    #[must_use]
    pub fn to_toml(&self) -> String {
        toml::to_string(self).unwrap_or_default()
    }

    /// The experiment that it describes. Paths are relative to the working directory.
    ///
    /// # Errors
    /// [`Error::Experiment`] with the key, as [`Experiment::parse`], where a value is out of range or keys
    /// contradict each other.
    pub fn experiment(&self) -> Result<Experiment> {
        let text = self.to_toml();
        let within = Self::parse(&text, None).map_err(|error| match error {
            // nobody has seen the text
            Error::Experiment(input_error) => {
                Error::experiment(InputError { line: None, column: None, excerpt: None, ..*input_error })
            }
            other => other,
        });
        within.and_then(|_| self.made(HashedFile::of_bytes("experiment", text.as_bytes()), None))
    }

    /// The experiment, with the directory of the file.
    fn made(&self, source: HashedFile, directory: Option<&Path>) -> Result<Experiment> {
        if self.schema.get() != 1 {
            let message = format!("schema {} is not known to this version", self.schema.get());
            return Err(refused("schema", message, "schema = 1"));
        }
        let sensor = self.sensor.sensor()?;
        let plan = self.plan(&sensor, directory)?;
        let imu = self.imu(&plan)?;
        self.campaign.as_ref().map_or(Ok(()), |campaign| campaign.check(&plan))?;
        let calibrate = self.calibrate.clone().unwrap_or_default();
        if calibrate.prior == Prior::Datasheet {
            need_spreads("calibrate.prior", &sensor)?;
            if self.campaign.is_some() {
                let help =
                    "leave it away: what the other soaks say is the prior of one that leaves parameters open";
                return Err(refused(
                    "calibrate.prior",
                    "each soak of a campaign would count the datasheet once more",
                    help,
                ));
            }
        }
        if let Some(machine) = &self.machine {
            machine.check_noise(&sensor, imu.as_ref())?;
        }
        let list = match &plan {
            Plan::Motion(_) | Plan::Machine(_) => sensor.parameter_list(),
            Plan::Holds(holds) => holds.parameter_list(sensor.model, false),
        };
        let limits = self.limits.as_ref().map(|limits| limits.limits("limits", sensor.axes)).transpose()?;
        let design = self.design.clone().unwrap_or_default();
        design.check(&sensor, &list)?;
        let study = self.study.clone().unwrap_or_default();
        study.check(&plan, sensor.axes)?;
        let mut experiment = Experiment {
            source,
            read: String::new(),
            limits: limits.flatten().unwrap_or_default(),
            campaign: self
                .campaign
                .clone()
                .map(|campaign| campaign.with_temperature(self.temperature.as_ref()).beside(directory)),
            columns: options_of(self.columns.as_ref())?,
            calibrate,
            accept: limits_of(self.accept.as_ref())?,
            design,
            study,
            sensor,
            plan,
            imu,
        };
        experiment.read = experiment.content().sha256;
        Ok(experiment)
    }

    fn plan(&self, sensor: &Sensor, directory: Option<&Path>) -> Result<Plan> {
        let three_axes = |section: &str| match sensor.axes {
            3 => Ok(()),
            _ => Err(refused(
                section,
                format!("[{section}] needs a sensor of three axes"),
                "axes = 3, or [motion]",
            )),
        };
        match (&self.motion, &self.holds, &self.machine) {
            (Some(motion), _, _) => {
                need_noise(sensor)?;
                Ok(Plan::Motion(motion.plan(sensor)?))
            }
            (None, Some(holds), _) => {
                three_axes("holds")?;
                holds.check(self.sensor.is_imu())?;
                Ok(Plan::Holds(holds.clone()))
            }
            (None, None, Some(machine)) => {
                three_axes("machine")?;
                machine.check(sensor)?;
                Ok(Plan::Machine(Box::new(machine.clone().beside(directory))))
            }
            (None, None, None) => Err(refused(
                "",
                "neither [motion] nor [holds] nor [machine] is there",
                "say how the sensor is moved: [motion] for a commanded motion, [holds] for still poses, [machine] for a machine whose motion is logged",
            )),
        }
    }

    /// The second sensor of an IMU: there if, and only if, the kind is "imu".
    fn imu(&self, plan: &Plan) -> Result<Option<ImuPlan>> {
        let is_imu = self.sensor.is_imu();
        let kind = "kind = \"imu\" in [sensor]";
        if let Some(temperature) = self.temperature.as_ref().filter(|_| !is_imu) {
            if self.campaign.is_none() {
                return Err(refused(
                    "temperature",
                    "[temperature] is read for an IMU, or with [campaign]",
                    kind,
                ));
            }
            temperature.without_gyroscope()?;
        }
        match (&self.gyroscope, is_imu) {
            (Some(gyroscope), true) => match plan {
                Plan::Holds(_) => gyroscope.plan(self.known.as_ref(), self.temperature.as_ref()).map(Some),
                Plan::Machine(_) => self.imu_on_a_machine(gyroscope).map(Some),
                Plan::Motion(_) => Err(refused(
                    "gyroscope",
                    "an IMU is calibrated from holds and what lies between them, or on a machine",
                    "[holds] or [machine] in place of [motion], or kind = \"accelerometer\"",
                )),
            },
            (Some(_), false) => Err(refused("gyroscope", "only an IMU has a gyroscope", kind)),
            (None, true) => Err(missing("gyroscope", "kind = \"imu\" needs [gyroscope]: its unit, at least")),
            (None, false) if self.known.is_some() => {
                Err(refused("known", "[known] is read for an IMU only", kind))
            }
            (None, false) => Ok(None),
        }
    }

    /// On a machine nothing is read that only a calibration by holds needs.
    fn imu_on_a_machine(&self, gyroscope: &GyroscopeSection) -> Result<ImuPlan> {
        if self.temperature.is_some() {
            let message = "[temperature] is not read with [machine]";
            return Err(refused("temperature", message, "take it out"));
        }
        match gyroscope.turn_keys().into_iter().find_map(|(key, is_there)| is_there.then_some(key)) {
            Some(key) => Err(refused(key, "turns are not read with [machine]", "take this key out")),
            None => gyroscope.plan(self.known.as_ref(), None),
        }
    }
}

impl Experiment {
    /// What results state of it: the text from which it was read, or, where it was changed in code since then, its content.
    #[must_use]
    pub fn origin(&self) -> HashedFile {
        let content = self.content();
        if content.sha256 == self.read { self.source.clone() } else { content }
    }

    /// Is it one of the thesis (`vamvaka2021`), as its presets have it?
    #[must_use]
    pub fn is_of_thesis(&self) -> bool {
        let is_preset = |name: &str| {
            let text = preset(name).and_then(|text| Self::parse(text, None).ok());
            text.is_some_and(|of| of.content().sha256 == self.content().sha256)
        };
        ["report", "report-unknown", "report-noisy"].into_iter().any(is_preset)
    }

    /// States the text from which it was read as its origin, whatever was changed since.
    pub(super) fn stated_as_read(&mut self) {
        self.read = self.content().sha256;
    }

    fn content(&self) -> HashedFile {
        let source = HashedFile::of_bytes("", b"");
        let bare = Self { source, read: String::new(), ..self.clone() };
        HashedFile::of_bytes("experiment", format!("{bare:?}").as_bytes())
    }

    /// Reads an experiment file.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the file cannot be read, is larger than 1 MiB, is not text, or as [`parse`](Self::parse).
    pub fn read(path: &Path) -> Result<Self> {
        let (text, source) = Self::text_of(path)?;
        Ok(Self { source, ..Self::parse(&text, Some(path))? })
    }

    /// Reads an experiment file with other values of some keys: `holds.poses=36`, the value as in the file. Results name them after the file.
    ///
    /// # Errors
    /// As [`read`](Self::read). The TOML of a setting is invalid, or sets no key.
    ///
    /// # Examples
    /// ```no_run
    /// use calibrant_io::Experiment;
    /// let longer = Experiment::read_with("imu.toml".as_ref(), &["holds.hold_s=8.0".into()])?;
    /// assert!(longer.origin().file.ends_with("imu.toml with holds.hold_s=8.0"));
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    pub fn read_with(path: &Path, settings: &[String]) -> Result<Self> {
        if settings.is_empty() {
            return Self::read(path);
        }
        let (text, source) = Self::text_of(path)?;
        let toml: Vec<Setting> = settings.iter().map(|setting| Setting::new(setting)).collect();
        let mut document = Document::parse(&text, Some(path))?;
        document.set(&toml)?;
        let file = settings.iter().fold(source.file, |file, setting| format!("{file} with {setting}"));
        Self::of(&document, HashedFile { file, ..source })
    }

    fn text_of(path: &Path) -> Result<(String, HashedFile)> {
        decoding::parsed(path, (LARGEST, "the experiment file"), |bytes| {
            Ok((decoding::as_text(bytes)?.to_owned(), HashedFile::of_bytes(file_name(path), bytes)))
        })
    }

    /// Reads the text of an experiment file. `file` serves only for its name in errors.
    ///
    /// # Errors
    /// [`Error::Experiment`] with line, column, key and excerpt. The TOML is invalid, or a key is unknown or
    /// missing. A value has the wrong type or is out of range, or keys contradict each other.
    ///
    /// # Examples
    /// ```
    /// use calibrant_io::{Experiment, preset};
    /// let text = preset("report").expect("a preset");
    /// assert_eq!(Experiment::parse(text, None)?.sensor.axes, 3);
    ///
    /// let error = Experiment::parse(&text.replace("interval_s", "intervall_s"), None).expect_err("misspelt");
    /// assert!(error.to_string().contains("did you mean `interval_s`?"), "{error}");
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    pub fn parse(text: &str, file: Option<&Path>) -> Result<Self> {
        let document = Document::parse(text, file)?;
        let source =
            HashedFile::of_bytes(file.map_or_else(|| "experiment".into(), file_name), text.as_bytes());
        Self::of(&document, source)
    }

    fn of(document: &Document<'_>, source: HashedFile) -> Result<Self> {
        let form = ExperimentFile::of(document)?;
        form.made(source, document.directory()).map_err(|error| document.placed(error))
    }
}

/// A commanded motion needs the noise of the sensor.
fn need_noise(sensor: &Sensor) -> Result<()> {
    if sensor.noise_mps2.is_some() || sensor.noise_counts.is_some() {
        return Ok(());
    }
    let (key, example) = match sensor.unit {
        ReadingUnit::Counts => ("sensor.noise_counts", "noise_counts = 10.0"),
        ReadingUnit::MetrePerSecondSquared | ReadingUnit::RadianPerSecond => {
            ("sensor.noise_mps2", "noise_mps2 = 2e-4")
        }
    };
    let help = format!("{example}, for example: the noise of one sample");
    Err(refused(key, "this key is required with [motion]", help))
}
