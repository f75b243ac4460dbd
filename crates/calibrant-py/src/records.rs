//! The records: calibrations over the years, in an SQLite database.

use crate::failure::invalid;
use crate::work::run;
use calibrant::Result;
use calibrant::diagnostic::Usability;
use calibrant::io::to_json;
use calibrant::records::{Record, RecordFile, RecordFilter, Records as Database};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Where the records are.
#[pyclass(frozen)]
pub(crate) struct Records(PathBuf);

fn filter(
    sensor: Option<String>,
    station: Option<String>,
    verdict: Option<&str>,
    latest: bool,
) -> Result<RecordFilter> {
    let verdict = verdict.map(|name| {
        let names = Usability::ALL.map(Usability::name).join(", ");
        Usability::parse(name)
            .ok_or_else(|| invalid(format!("`verdict` is {name:?}"), format!("the verdicts are {names}")))
    });
    Ok(RecordFilter { sensor, station, verdict: verdict.transpose()?, latest })
}

#[pymethods]
impl Records {
    /// Opens the records, or makes them.
    #[new]
    fn new(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let at = path.clone();
        run(py, move || Database::open(&at).map(drop))?;
        Ok(Self(path))
    }

    /// Adds calibrations; returns how many are new.
    fn add(&self, py: Python<'_>, texts: Vec<String>) -> PyResult<usize> {
        let path = self.0.clone();
        run(py, move || {
            let records = texts.iter().map(|text| Record::parse(text)).collect::<Result<Vec<_>>>()?;
            Database::open(&path)?.insert_all(records)
        })
    }

    /// The text of `calibrant records list --json`.
    #[pyo3(signature = (sensor=None, station=None, verdict=None, latest=false))]
    fn list(
        &self,
        py: Python<'_>,
        sensor: Option<String>,
        station: Option<String>,
        verdict: Option<String>,
        latest: bool,
    ) -> PyResult<String> {
        let path = self.0.clone();
        run(py, move || {
            let filter = filter(sensor, station, verdict.as_deref(), latest)?;
            Ok(to_json(&Database::open_existing(&path)?.list(&filter)?))
        })
    }

    /// The text of `calibrant records show --json`; `None` where there is none of this number.
    fn get(&self, py: Python<'_>, id: i64) -> PyResult<Option<String>> {
        let path = self.0.clone();
        run(py, move || Ok(Database::open_existing(&path)?.get(id)?.map(|of| to_json(&RecordFile::of(&of)))))
    }

    /// The text of `calibrant records drift --json`, of one sensor or of all.
    #[pyo3(signature = (sensor=None))]
    fn drift(&self, py: Python<'_>, sensor: Option<String>) -> PyResult<String> {
        let path = self.0.clone();
        run(py, move || {
            let records = Database::open_existing(&path)?;
            Ok(match sensor {
                Some(sensor) => to_json(&records.history(&sensor)?),
                None => to_json(&records.drifts()?),
            })
        })
    }

    /// The text of `calibrant records fleet --json`.
    fn fleet(&self, py: Python<'_>) -> PyResult<String> {
        let path = self.0.clone();
        run(py, move || Ok(to_json(&Database::open_existing(&path)?.fleet()?)))
    }

    fn count(&self, py: Python<'_>) -> PyResult<usize> {
        let path = self.0.clone();
        run(py, move || Database::open_existing(&path)?.count())
    }

    fn remove(&self, py: Python<'_>, ids: Vec<i64>) -> PyResult<()> {
        let path = self.0.clone();
        run(py, move || Database::open_existing(&path)?.remove(&ids))
    }

    /// Writes them as CSV or Parquet; returns the number of rows.
    #[pyo3(signature = (path, sensor=None, station=None, verdict=None, latest=false))]
    fn export(
        &self,
        py: Python<'_>,
        path: PathBuf,
        sensor: Option<String>,
        station: Option<String>,
        verdict: Option<String>,
        latest: bool,
    ) -> PyResult<usize> {
        let from = self.0.clone();
        run(py, move || {
            let filter = filter(sensor, station, verdict.as_deref(), latest)?;
            Database::open_existing(&from)?.export(&path, &filter)
        })
    }
}
