//! Experiments: their text, made of sections, and read.

use crate::failure::{invalid, raised};
use crate::work::at_once;
use calibrant::Result;
use calibrant::io::{Experiment as Read, PRESETS, Plan, nearest, preset};
use pyo3::prelude::*;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// An experiment that was read.
#[pyclass(frozen)]
#[derive(Clone)]
pub(crate) struct Experiment {
    pub(crate) read: Read,
    /// As errors and reports name it.
    pub(crate) file: PathBuf,
}

#[pymethods]
impl Experiment {
    /// Reads a text. `path`: of its file, for errors, and from which relative paths count.
    #[new]
    #[pyo3(signature = (text, path=None))]
    fn new(py: Python<'_>, text: &str, path: Option<PathBuf>) -> PyResult<Self> {
        let read = at_once(py, || Read::parse(text, path.as_deref()))?;
        Ok(Self { read, file: path.unwrap_or_default() })
    }

    /// Kind of plan, whether it is a campaign, sensors, hash, and the files that it names.
    fn about(&self) -> String {
        let of = &self.read;
        let files = match &of.plan {
            Plan::Machine(plan) => plan.files(),
            _ => of.campaign_section().and_then(|campaign| campaign.poses_file()).into_iter().collect(),
        };
        json!({
            "plan": of.plan.section(), "is_campaign": of.campaign_section().is_some(), "is_imu": of.imu.is_some(), "sha256": of.origin().sha256, "files": files,
        })
        .to_string()
    }
}

impl Experiment {
    /// Errors of it name its file.
    pub(crate) fn placed(file: &Path) -> impl Fn(calibrant::Error) -> calibrant::Error + '_ {
        move |error| if file.as_os_str().is_empty() { error } else { error.in_experiment(file) }
    }
}

/// The text of a preset.
#[pyfunction]
pub(crate) fn preset_text(py: Python<'_>, name: &str) -> PyResult<&'static str> {
    preset(name).ok_or_else(|| {
        let help = match nearest(name, PRESETS.iter().map(|of| of.name)) {
            Some(near) => format!("did you mean {near:?}?"),
            None => {
                format!("the presets are {}", PRESETS.iter().map(|of| of.name).collect::<Vec<_>>().join(", "))
            }
        };
        raised(py, &invalid(format!("there is no preset {name:?}"), help))
    })
}

/// Name and purpose of each preset.
#[pyfunction]
pub(crate) fn presets() -> Vec<(&'static str, &'static str)> {
    PRESETS.iter().map(|of| (of.name, of.summary)).collect()
}

/// A text with these sections, as JSON: keys replace keys, and null takes one away.
#[pyfunction]
pub(crate) fn merged(py: Python<'_>, text: &str, sections: &str) -> PyResult<String> {
    at_once(py, || merge(text, sections))
}

/// The sections of a text, as JSON.
#[pyfunction]
pub(crate) fn sections_of(py: Python<'_>, text: &str) -> PyResult<String> {
    let read = toml::from_str::<toml::Table>(text);
    let read = read.map_err(|error| invalid(error.message().to_owned(), "correct the TOML"));
    let read =
        read.and_then(|table| serde_json::to_string(&table).map_err(|error| invalid(error.to_string(), "")));
    read.map_err(|error| raised(py, &error))
}

fn merge(text: &str, sections: &str) -> Result<String> {
    let mut table: toml::Table =
        toml::from_str(text).map_err(|error| invalid(error.message().to_owned(), "correct the TOML"))?;
    let given: Value = serde_json::from_str(sections).map_err(|error| {
        invalid(format!("the sections cannot be read: {error}"), "give numbers, texts, lists and dicts")
    })?;
    let Value::Object(given) = given else {
        return Err(invalid("the sections are no dict", "give a dict of keys for each section"));
    };
    lay_over(&mut table, given, "")?;
    toml::to_string(&table)
        .map_err(|error| invalid(error.to_string(), "give numbers, texts, lists and dicts"))
}

fn lay_over(table: &mut toml::Table, given: serde_json::Map<String, Value>, path: &str) -> Result<()> {
    for (key, value) in given {
        let at = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        match value {
            Value::Null => drop(table.remove(&key)),
            Value::Object(inner) => {
                let under = table.entry(key).or_insert_with(|| toml::Value::Table(toml::Table::new()));
                if !under.is_table() {
                    *under = toml::Value::Table(toml::Table::new());
                }
                if let Some(under) = under.as_table_mut() {
                    lay_over(under, inner, &at)?;
                }
            }
            other => {
                let value = toml::Value::try_from(&other).map_err(|_| {
                    invalid(format!("`{at}` is {other}"), "give numbers, texts, lists and dicts")
                })?;
                table.insert(key, value);
            }
        }
    }
    Ok(())
}
