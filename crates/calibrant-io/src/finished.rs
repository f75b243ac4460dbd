//! `resume.json`: what a batch keeps of a finished recording, so that another run need not calibrate it again.
//!
//! It is written after the results, and has their checksums. So a result that another run has replaced is not taken for that of this key.

use super::atomic_output::program;
use super::hashed_file::checksum;
use super::json::write_json;
use super::resume_key::ResumeKey;
use super::summary::{Summary, SummaryParameter, unit_of};
use super::told::{Told, ToldKind};
use calibrant_core::diagnostic::{Code, Verdict};
use calibrant_core::error::Result;
use calibrant_core::estimate::CalibrationStatus;
use calibrant_core::sensor::Parameter;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The name of the file.
const NAME: &str = "resume.json";
/// The results that stand beside it, where they were written.
const RESULTS: [&str; 2] = ["calibration.json", "report.html"];

/// What tables and pages of a batch need of a recording that is calibrated.
#[derive(Debug, Clone)]
pub struct Finished {
    /// Its line of `summary.csv`.
    pub summary: Summary,
    /// Its cells in the table of the terminal.
    pub cells: Vec<String>,
    /// What was told of it.
    pub told: Vec<Told>,
}

#[derive(Serialize, Deserialize)]
struct Content {
    program: String,
    key: String,
    results: Vec<Checksum>,
    codes: Vec<String>,
    limits_failed: Vec<String>,
    status: String,
    quality: Vec<(String, String)>,
    parameters: Vec<ParameterFields>,
    cells: Vec<String>,
    told: Vec<ToldFields>,
}

#[derive(Serialize, Deserialize)]
struct Checksum {
    file: String,
    sha256: String,
}

/// Numbers are texts, which read back to the same bits.
#[derive(Serialize, Deserialize)]
struct ParameterFields {
    name: String,
    unit: String,
    value: String,
    sd: String,
    nominal: Option<String>,
    spread: Option<String>,
}

#[derive(Serialize, Deserialize)]
struct ToldFields {
    kind: String,
    code: Option<String>,
    file: String,
    words: String,
}

impl Finished {
    /// Writes `resume.json` beside the results in this directory. `report`: has it a `report.html` of this run?
    ///
    /// # Errors
    /// [`Error::Output`](calibrant_core::Error::Output) where it cannot be written.
    pub fn write(&self, directory: &Path, key: &ResumeKey, report: bool) -> Result<()> {
        let results = RESULTS.into_iter().filter(|name| report || *name != "report.html");
        let checksum_of =
            |name: &str| Some(Checksum { file: name.into(), sha256: checksum(&directory.join(name))? });
        let Summary { verdict, limits_failed, status, quality, parameters } = &self.summary;
        let number = |value: f64| format!("{value:?}");
        let content = Content {
            program: program(),
            key: key.0.clone(),
            results: results.filter_map(checksum_of).collect(),
            codes: verdict.code_names().into_iter().map(str::to_owned).collect(),
            limits_failed: limits_failed.clone(),
            status: status.name().to_owned(),
            quality: quality.clone(),
            parameters: parameters
                .iter()
                .map(|SummaryParameter { parameter, value, sd }| ParameterFields {
                    name: parameter.name.clone(),
                    unit: parameter.unit.to_owned(),
                    value: number(*value),
                    sd: number(*sd),
                    nominal: parameter.nominal.map(number),
                    spread: parameter.spread.map(number),
                })
                .collect(),
            cells: self.cells.clone(),
            told: self
                .told
                .iter()
                .map(|told| ToldFields {
                    kind: told.kind.name().to_owned(),
                    code: told.code.map(|code| code.name().to_owned()),
                    file: told.file.clone(),
                    words: told.words.clone(),
                })
                .collect(),
        };
        write_json(&directory.join(NAME), &content)
    }

    /// What an earlier run kept in this directory, with the text of `calibration.json`. `None` where it has another key, or where a result is
    /// missing or has changed since.
    #[must_use]
    pub fn read(directory: &Path, key: &ResumeKey) -> Option<(Self, String)> {
        let content: Content = serde_json::from_slice(&std::fs::read(directory.join(NAME)).ok()?).ok()?;
        let unchanged = |of: &Checksum| {
            RESULTS.contains(&of.file.as_str())
                && checksum(&directory.join(&of.file)).as_ref() == Some(&of.sha256)
        };
        if content.key != key.0 || content.results.is_empty() || !content.results.iter().all(unchanged) {
            return None;
        }
        let json = std::fs::read_to_string(directory.join(RESULTS[0])).ok()?;
        Some((content.finished()?, json))
    }
}

impl Content {
    fn finished(self) -> Option<Finished> {
        let codes: Vec<Code> = self.codes.iter().map(|code| Code::parse(code)).collect::<Option<_>>()?;
        let summary = Summary {
            verdict: Verdict::on(codes, &[]),
            limits_failed: self.limits_failed,
            status: status(&self.status)?,
            quality: self.quality,
            parameters: self.parameters.into_iter().map(ParameterFields::parameter).collect::<Option<_>>()?,
        };
        let told = self.told.into_iter().map(ToldFields::told).collect::<Option<_>>()?;
        Some(Finished { summary, cells: self.cells, told })
    }
}

impl ParameterFields {
    fn parameter(self) -> Option<SummaryParameter> {
        let number = |text: String| text.parse::<f64>().ok();
        let parameter = Parameter {
            name: self.name,
            unit: unit_of(&self.unit)?,
            nominal: self.nominal.and_then(number),
            spread: self.spread.and_then(number),
        };
        Some(SummaryParameter { parameter, value: number(self.value)?, sd: number(self.sd)? })
    }
}

impl ToldFields {
    fn told(self) -> Option<Told> {
        let code = match self.code {
            Some(name) => Some(Code::parse(&name)?),
            None => None,
        };
        Some(Told { kind: ToldKind::parse(&self.kind)?, code, file: self.file, words: self.words })
    }
}

fn status(name: &str) -> Option<CalibrationStatus> {
    let all = [CalibrationStatus::Converged, CalibrationStatus::IterationLimit, CalibrationStatus::Stalled];
    all.into_iter().find(|status| status.name() == name)
}
