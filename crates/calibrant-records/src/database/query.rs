//! Questions to the records.

use super::blob::numbers_of;
use super::checksum::{COLUMNS, MODEL, PARAMETERS, SHARED, VALUES, model_row, parameters};
use super::failure::{damaged, failed};
use super::records::Records;
use super::schema::{self, LATEST};
use crate::model::{self, Further};
use crate::record::{KeptVerdict, Record};
use calibrant_core::diagnostic::Usability;
use calibrant_core::error::Result;
use calibrant_core::sensor::{CalibratedImu, SharedErrors};
use calibrant_io::{HashedFile, UtcTime};
use nalgebra::DMatrix;
use rusqlite::types::ToSql;
use rusqlite::{CachedStatement, Row};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::HashMap;

/// Which records are asked for. Each field that is given restricts them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RecordFilter {
    /// Those of this sensor.
    pub sensor: Option<String>,
    /// Those of this station.
    pub station: Option<String>,
    /// Those with this verdict.
    pub verdict: Option<Usability>,
    /// Without those that a later calibration of the same recording replaces.
    pub latest: bool,
}

/// A record of a database.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct KeptRecord {
    /// Its number.
    pub id: i64,
    /// When it was inserted, UTC.
    pub inserted: UtcTime,
    /// The calibration.
    #[serde(flatten)]
    pub record: Record,
}

impl Records {
    /// The records of a filter. Those of one sensor stand together, in the order of their dates; those without a date are first, since the newest one with a date counts as the latest.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) where the records are damaged.
    pub fn list(&self, filter: &RecordFilter) -> Result<Vec<KeptRecord>> {
        let mut records = Vec::new();
        self.each(filter, |record| records.push(record))?;
        Ok(records)
    }

    /// Hands the same records on one by one, so that they need not fit into memory.
    ///
    /// # Errors
    /// As [`list`](Self::list).
    pub fn each(&self, filter: &RecordFilter, take: impl FnMut(KeptRecord)) -> Result<()> {
        let mut conditions: Vec<&str> = Vec::new();
        let mut given: Vec<&dyn ToSql> = Vec::new();
        let verdict = filter.verdict.map(Usability::name);
        let fields: [(&str, Option<&dyn ToSql>); 3] = [
            ("sensor = ?", filter.sensor.as_ref().map(|sensor| sensor as &dyn ToSql)),
            ("station = ?", filter.station.as_ref().map(|station| station as &dyn ToSql)),
            ("verdict = ?", verdict.as_ref().map(|verdict| verdict as &dyn ToSql)),
        ];
        for (condition, value) in fields {
            if let Some(value) = value {
                conditions.push(condition);
                given.push(value);
            }
        }
        let restriction = match conditions.as_slice() {
            [] => String::new(),
            some => format!("WHERE {}", some.join(" AND ")),
        };
        let table = if filter.latest { &format!("({LATEST})") } else { "calibrations" };
        let order = "ORDER BY sensor, recorded IS NOT NULL, recorded, id";
        self.query(&format!("SELECT {COLUMNS} FROM {table} {restriction} {order}"), &given, take)
    }

    /// The newest calibration of each sensor that is not bad, by their numbers.
    pub(crate) fn newest(&self) -> Result<Vec<KeptRecord>> {
        // of several bare columns beside one max(), SQLite takes those of that row
        let newest = format!(
            "SELECT id FROM (
            SELECT id, max((recorded IS NOT NULL) || coalesce(recorded, '') || printf(' %020d', id))
            FROM ({LATEST}) WHERE verdict <> 'bad' GROUP BY sensor)"
        );
        let mut records = Vec::new();
        let query = format!("SELECT {COLUMNS} FROM calibrations WHERE id IN ({newest}) ORDER BY id");
        self.query(&query, &[], |record| records.push(record))?;
        Ok(records)
    }

    /// The record of this number.
    ///
    /// # Errors
    /// As [`list`](Self::list).
    pub fn get(&self, id: i64) -> Result<Option<KeptRecord>> {
        let mut found = None;
        let query = format!("SELECT {COLUMNS} FROM calibrations WHERE id = ?");
        self.query(&query, &[&id], |record| found = Some(record))?;
        Ok(found)
    }

    /// The number of records.
    ///
    /// # Errors
    /// As [`list`](Self::list).
    pub fn count(&self) -> Result<usize> {
        let count =
            self.connection.query_row("SELECT count(*) FROM calibrations", [], |row| row.get::<_, i64>(0));
        Ok(usize::try_from(count.map_err(|error| failed(&self.path, error))?).unwrap_or_default())
    }

    fn query(&self, query: &str, given: &[&dyn ToSql], mut take: impl FnMut(KeptRecord)) -> Result<()> {
        let sql = |error| failed(&self.path, error);
        let mut reader = Reader::of(self).map_err(sql)?;
        let mut statement = self.connection.prepare_cached(query).map_err(sql)?;
        let mut rows = statement.query(given).map_err(sql)?;
        while let Some(row) = rows.next().map_err(sql)? {
            match reader.record(row).map_err(sql)? {
                Some(record) => take(record),
                None => {
                    let id: i64 = row.get(0).map_err(sql)?;
                    return Err(damaged(&self.path, &format!("calibration {id} is not as it was written")));
                }
            }
        }
        Ok(())
    }
}

/// The shared errors of these many parameters; `None` where the sizes do not fit.
fn shared_of(sources: &str, root: &[u8], parameters: usize) -> Option<SharedErrors> {
    let sources: Vec<String> = sources.split('\n').map(str::to_owned).collect();
    let numbers = numbers_of(root).filter(|numbers| numbers.len() == parameters * sources.len())?;
    Some(SharedErrors { root: DMatrix::from_row_slice(parameters, sources.len(), &numbers), sources })
}

/// Makes records of rows.
struct Reader<'r> {
    estimates: CachedStatement<'r>,
    /// Not in a database of the version before.
    shared: Option<CachedStatement<'r>>,
    model: CachedStatement<'r>,
    /// The models so far, by their numbers; `None` for one that cannot be read.
    models: HashMap<i64, Option<CalibratedImu>>,
}

impl<'r> Reader<'r> {
    fn of(records: &'r Records) -> rusqlite::Result<Self> {
        let statement = |text| records.connection.prepare_cached(text);
        let has_shared = schema::has_shared_errors(&records.connection)?;
        let shared = has_shared.then(|| statement(SHARED)).transpose()?;
        Ok(Self {
            estimates: statement(PARAMETERS)?,
            shared,
            model: statement(MODEL)?,
            models: HashMap::new(),
        })
    }

    /// The record of a row; `None` where its parts do not fit together.
    fn record(&mut self, row: &Row<'_>) -> rusqlite::Result<Option<KeptRecord>> {
        let id: i64 = row.get(0)?;
        let (estimates, errors, checksum) = parameters(&mut self.estimates, self.shared.as_mut(), row)?;
        if row.get::<_, Option<Vec<u8>>>(VALUES)?.as_ref() != Some(&checksum) {
            return Ok(None);
        }
        let number: i64 = row.get(16)?;
        if !self.models.contains_key(&number) {
            let (text, kept, checksum) = self.model.query_row([number], model_row)?;
            let whole = kept.is_some_and(|kept| kept == checksum);
            self.models.insert(number, model::read(&text).filter(|_| whole));
        }
        // a blob that is cut has no numbers, which do not fit
        let numbers = |place: usize| -> rusqlite::Result<Option<Vec<f64>>> {
            let bytes: Option<Vec<u8>> = row.get(place)?;
            Ok(bytes.map(|bytes| numbers_of(&bytes).unwrap_or_default()))
        };
        let Ok(degrees) = numbers(20)?.map(<[f64; 3]>::try_from).transpose() else { return Ok(None) };
        let further = Further {
            reference_c: row.get(17)?,
            range_c: row
                .get::<_, Option<f64>>(18)?
                .zip(row.get(19)?)
                .map(|(least, greatest)| [least, greatest]),
            degrees,
            covariance: numbers(21)?,
            shared: errors.as_ref().and_then(|(sources, root)| shared_of(sources, root, estimates.len())),
        };
        if errors.is_some() && further.shared.is_none() {
            return Ok(None);
        }
        let time = |text: String| UtcTime::parse(&text);
        let (recorded, inserted): (Option<String>, String) = (row.get(2)?, row.get(3)?);
        let (verdict, codes): (String, String) = (row.get(13)?, row.get(14)?);
        let (files, hashes): (String, String) = (row.get(11)?, row.get(12)?);
        let optional = |place: usize| -> rusqlite::Result<Option<HashedFile>> {
            let (file, sha256): (Option<String>, String) = (row.get(place)?, row.get(place + 1)?);
            Ok(file.map(|file| HashedFile { file, sha256 }))
        };
        let fitting = self.models[&number].as_ref().and_then(|model| further.onto(model, &estimates));
        let (Some(imu), Some(usability), Some(inserted)) =
            (fitting, Usability::parse(&verdict), time(inserted))
        else {
            return Ok(None);
        };
        let file = |(file, sha256): (&str, &str)| HashedFile { file: file.into(), sha256: sha256.into() };
        let record = Record {
            sensor: row.get(1)?,
            recorded: recorded.and_then(time),
            station: row.get(4)?,
            program: row.get(5)?,
            plan: row.get(6)?,
            experiment: optional(7)?,
            motion_file: optional(9)?,
            recordings: files.split('/').zip(hashes.split(' ')).map(file).collect(),
            verdict: KeptVerdict { usability, codes: codes.split_whitespace().map(str::to_owned).collect() },
            status: row.get(15)?,
            imu,
        };
        Ok(Some(KeptRecord { id, inserted, record }))
    }
}
