//! Reads an experiment file, section by section.

use super::toml_document::{Document, Section};
use super::{
    CalibrateOptions, DesignOptions, ImuPlan, Plan, Prior, StudyOptions, accept, calibrate, columns, design,
    gyroscope, holds, limits, machine, motion, sensor, study,
};
use crate::{ImuReadOptions, text_decoding};
use calibrant_core::acceptance::AcceptanceLimit;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::motion::Limits;
use calibrant_core::sensor::{ReadingUnit, Sensor};
use std::path::Path;
use toml::de::DeTable;

/// Largest experiment file, bytes.
const LARGEST: u64 = 1 << 20;

/// The content of an experiment file.
#[derive(Debug, Clone, PartialEq)]
pub struct Experiment {
    /// `[sensor]`: the datasheet.
    pub sensor: Sensor,
    /// `[motion]`, `[holds]` or `[machine]`.
    pub plan: Plan,
    /// `[gyroscope]`, `[known]` and `[temperature]`, for an IMU.
    pub imu: Option<ImuPlan>,
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

/// Reads `[columns]` of a file that may have nothing else. It is an experiment file, or one with this table
/// alone (and optionally `schema = 1`).
///
/// # Errors
/// As [`Experiment::read`], whatever section is wrong. [`Error::Experiment`] where there is no `[columns]`
/// section, or an empty one.
pub fn read_columns(path: &Path) -> Result<ImuReadOptions> {
    let text = read_text(path)?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let document = Document { text, file: Some(path) };
    let table = DeTable::parse(text).map_err(|error| document.syntax(&error))?;
    let root = Section::root(&document, table.get_ref())?;
    let others = table.get_ref().keys().any(|key| !["schema", "columns"].contains(&key.get_ref().as_ref()));
    let columns = match root.section("columns")? {
        _ if others => Experiment::parse(text, Some(path))?.columns,
        Some(section) => columns::read(&section)?,
        None => ImuReadOptions::default(),
    };
    if columns == ImuReadOptions::default() {
        let input_error = InputError::new(
            Refusal::KeyMissing,
            "there is no [columns] section",
            "add one, or leave --columns away",
        );
        return Err(Error::experiment(input_error.in_file(path)));
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
    let text = read_text(path)?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let document = Document { text, file: Some(path) };
    let table = DeTable::parse(text).map_err(|error| document.syntax(&error))?;
    let root = Section::root(&document, table.get_ref())?;
    let others = table.get_ref().keys().any(|key| !["schema", "accept"].contains(&key.get_ref().as_ref()));
    let limits = match others {
        true => Experiment::parse(text, Some(path))?.accept,
        false => read_accept(&root)?,
    };
    if limits.is_empty() {
        let (message, help) = ("there is no limit in [accept]", "add some, or leave --accept away");
        let input_error = InputError::new(Refusal::KeyMissing, message, help);
        return Err(Error::experiment(input_error.in_file(path)));
    }
    Ok(limits)
}

fn read_accept(root: &Section<'_>) -> Result<Vec<AcceptanceLimit>> {
    let section = root.get("accept").map(|entry| Section::open(&entry, "accept")).transpose()?;
    section.map_or(Ok(Vec::new()), |section| accept::read(&section))
}

fn read_text(path: &Path) -> Result<String> {
    let bytes = text_decoding::read_bytes(path, LARGEST, "the experiment file")
        .map_err(|input_error| Error::experiment(*input_error))?;
    let text =
        text_decoding::as_text(&bytes).map_err(|input_error| Error::experiment(input_error.in_file(path)))?;
    Ok(text.to_owned())
}

impl Experiment {
    /// Reads an experiment file.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the file cannot be read, is larger than 1 MiB, is not text, or as [`parse`](Self::parse).
    pub fn read(path: &Path) -> Result<Self> {
        Self::parse(&read_text(path)?, Some(path))
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
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let document = Document { text, file };
        if text.len() as u64 > LARGEST {
            return Err(Error::experiment(document.reject(
                Refusal::FileUnreadable,
                0..0,
                "the experiment file is larger than 1 MiB".into(),
                "this is hardly the file that you mean".into(),
            )));
        }
        let table = DeTable::parse(text).map_err(|error| document.syntax(&error))?;
        let root = Section::root(&document, table.get_ref())?;
        let schema = root.need("schema", "the first line of an experiment file is schema = 1")?;
        let version = schema.whole(0, u64::MAX)?;
        if version != 1 {
            return Err(schema.reject(format!("schema {version} is not known to this version"), "schema = 1"));
        }
        let need =
            |name| root.section(name)?.ok_or_else(|| root.missing(name, "the sensor's datasheet: [sensor]"));
        let sensor = sensor::read(&need("sensor")?)?;
        let plan = read_plan(&root, &sensor)?;
        let imu = read_imu(&root, &plan)?;
        let calibrate = root
            .section("calibrate")?
            .map_or(Ok(CalibrateOptions::default()), |section| calibrate::read(&section, &sensor))?;
        if let (Plan::Machine(_), Some(section)) = (&plan, root.section("machine")?) {
            machine::check_noise(&section, &sensor, imu.as_ref())?;
            if calibrate.prior == Prior::Datasheet {
                let help = "take prior = \"datasheet\" out of [calibrate]";
                return Err(section.reject("a prior of the sensor is not used with [machine]", help, ""));
            }
        }
        let list = match &plan {
            Plan::Motion(_) | Plan::Machine(_) => sensor.parameter_list(),
            Plan::Holds(holds) => holds.gauge.parameter_list(sensor.model),
        };
        Ok(Self {
            limits: root
                .section("limits")?
                .map_or(Ok(Limits::default()), |section| limits::read(&section, sensor.axes))?,
            columns: root
                .section("columns")?
                .map_or(Ok(ImuReadOptions::default()), |section| columns::read(&section))?,
            calibrate,
            accept: read_accept(&root)?,
            design: root
                .section("design")?
                .map_or(Ok(DesignOptions::default()), |section| design::read(&section, &sensor, &list))?,
            study: root
                .section("study")?
                .map_or(Ok(StudyOptions::default()), |section| study::read(&section, &plan, sensor.axes))?,
            sensor,
            plan,
            imu,
        })
    }
}

fn is_imu(root: &Section<'_>) -> Result<bool> {
    Ok(root.section("sensor")?.and_then(|section| section.get("kind")?.text().map(|kind| kind == "imu"))
        == Some(true))
}

/// The second sensor of an IMU: there if, and only if, the kind is \"imu\".
fn read_imu(root: &Section<'_>, plan: &Plan) -> Result<Option<ImuPlan>> {
    let is_imu = is_imu(root)?;
    let known = root.get("known").map(|entry| Section::open(&entry, "known")).transpose()?;
    let temperature = root.section("temperature")?;
    if let Some(section) = temperature.as_ref().filter(|_| !is_imu) {
        return Err(section.reject(
            "[temperature] is read for an IMU only",
            "kind = \"imu\" in [sensor]",
            "",
        ));
    }
    match (root.section("gyroscope")?, is_imu) {
        (Some(section), true) => match plan {
            Plan::Holds(_) => gyroscope::read(&section, known.as_ref(), temperature.as_ref()).map(Some),
            Plan::Machine(_) => {
                machine_has_none(known.as_ref(), "[known]")?;
                machine_has_none(temperature.as_ref(), "[temperature]")?;
                gyroscope::read_without_turns(&section).map(Some)
            }
            Plan::Motion(_) => Err(section.reject(
                "an IMU is calibrated from holds and what lies between them, or on a machine",
                "[holds] or [machine] in place of [motion], or kind = \"accelerometer\"",
                "",
            )),
        },
        (Some(section), false) => {
            Err(section.reject("only an IMU has a gyroscope", "kind = \"imu\" in [sensor]", ""))
        }
        (None, true) => {
            Err(root.missing("gyroscope", "kind = \"imu\" needs [gyroscope]: its unit, at least"))
        }
        (None, false) => match known {
            Some(section) => {
                Err(section.reject("[known] is read for an IMU only", "kind = \"imu\" in [sensor]", ""))
            }
            None => Ok(None),
        },
    }
}

/// Refuses a section that only a calibration by holds reads.
fn machine_has_none(section: Option<&Section<'_>>, name: &str) -> Result<()> {
    section.map_or(Ok(()), |section| {
        Err(section.reject(&format!("{name} is not read with [machine]"), "take it out", ""))
    })
}

fn read_plan(root: &Section<'_>, sensor: &Sensor) -> Result<Plan> {
    let [motion, holds, machine] =
        [root.section("motion")?, root.section("holds")?, root.section("machine")?];
    match (motion, holds, machine) {
        (Some(section), None, None) => {
            need_noise(root, sensor)?;
            Ok(Plan::Motion(motion::read(&section, sensor)?))
        }
        (None, Some(section), None) => {
            need_three_axes(&section, "[holds]", sensor)?;
            Ok(Plan::Holds(holds::read(&section, is_imu(root)?)?))
        }
        (None, None, Some(section)) => {
            need_three_axes(&section, "[machine]", sensor)?;
            Ok(Plan::Machine(Box::new(machine::read(&section, sensor)?)))
        }
        (None, None, None) => Err(root.reject(
            "neither [motion] nor [holds] nor [machine] is there",
            "say how the sensor is moved: [motion] for a commanded motion, [holds] for still poses, [machine] for a machine whose motion is logged",
            "",
        )),
        (Some(_), Some(section), None) => Err(two_plans(&section, "[motion] and [holds]")),
        (motion, _, Some(section)) => Err(two_plans(
            &section,
            if motion.is_some() { "[motion] and [machine]" } else { "[holds] and [machine]" },
        )),
    }
}

fn two_plans(section: &Section<'_>, which: &str) -> Error {
    let help = "an experiment is one or the other: take one of them out";
    section.reject(&format!("{which} are both there"), help, "")
}

fn need_three_axes(section: &Section<'_>, name: &str, sensor: &Sensor) -> Result<()> {
    match sensor.axes {
        3 => Ok(()),
        _ => {
            let message = format!("{name} needs a sensor of three axes");
            Err(section.reject(&message, "axes = 3, or [motion]", ""))
        }
    }
}

/// A commanded motion needs the noise of the sensor.
fn need_noise(root: &Section<'_>, sensor: &Sensor) -> Result<()> {
    if sensor.noise_mps2.is_some() || sensor.noise_counts.is_some() {
        return Ok(());
    }
    let help = match sensor.unit {
        ReadingUnit::MetrePerSecondSquared | ReadingUnit::RadianPerSecond => {
            "noise_mps2 = 2e-4, for example: the noise of one sample"
        }
        ReadingUnit::Counts => "noise_counts = 10.0, for example: the noise of one sample",
    };
    let key = if sensor.unit == ReadingUnit::Counts { "noise_counts" } else { "noise_mps2" };
    // [sensor] is there: it was read above
    Err(root.section("sensor")?.map_or_else(
        || root.missing(key, help),
        |section| section.reject("this key is required with [motion]", help, key),
    ))
}
