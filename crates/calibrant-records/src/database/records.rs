//! The database of records: opened, and written.

use super::blob::bytes_of;
use super::failure::{Failure, empty, failed, not_a_database, unknown};
use super::writable::check_writable;
use super::{checksum, repeated_recording, schema};
use crate::model::{self, Further};
use crate::record::Record;
use calibrant_core::error::{Error, Result};
use calibrant_core::sensor::CalibratedImu;
use calibrant_io::{HashedFile, UtcTime, open_file};
use rusqlite::config::DbConfig;
use rusqlite::{Connection, OpenFlags, OptionalExtension, Transaction, TransactionBehavior, params};
use std::collections::BTreeSet;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// How long a writer waits for another.
const PATIENCE: Duration = Duration::from_secs(60);
/// How an SQLite database begins.
const MAGIC: &[u8; 16] = b"SQLite format 3\0";
/// Records that one transaction inserts.
const PIECE: usize = 1000;

/// Records of calibrations in an SQLite database.
///
/// # Examples
/// ```
/// use calibrant_records::{Record, RecordFilter, Records};
/// # let text = r#"{"schema": 2, "kind": "calibration", "program": "calibrant 1.0.0", "sensor": "A17", "recorded": "2026-05-01",
/// #  "verdict": {"usability": "ok", "codes": []}, "status": "converged",
/// #  "direction": "true to raw", "frame": "the sensor's", "gauge": "lower",
/// #  "accelerometer": {"reading_unit": "m/s²", "bias_mps2": [0.1, 0.0, 0.0], "matrix": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]},
/// #  "parameters": [{"name": "accelerometer.bias.x", "unit": "m/s²", "value": 0.1, "sd": 0.01}],
/// #  "covariance_of": "", "covariance": [[1e-4]], "inputs": [{"file": "a.csv", "sha256": "ab", "samples": 9, "rate_hz": 1.0}]}"#;
/// let directory = tempfile::tempdir().expect("a directory");
/// let mut records = Records::open(&directory.path().join("records.db"))?;
/// let record = Record::parse(text)?; // the text of a calibration.json
/// records.insert(&record)?;
/// records.insert(&record)?; // the same calibration: it takes the place of the first
/// let kept = records.list(&RecordFilter::default())?;
/// assert_eq!((kept.len(), &kept[0].record), (1, &record));
/// # Ok::<(), calibrant_core::Error>(())
/// ```
#[derive(Debug)]
pub struct Records {
    pub(crate) connection: Connection,
    pub(super) path: PathBuf,
}

/// What became of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Inserted {
    /// Its number in the database.
    pub id: i64,
    /// Has it replaced an earlier calibration of the same recording, by the same experiment, motion and program?
    pub replaced: bool,
}

impl Records {
    /// Opens records to write them, and makes the database where there is none.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the file is empty or no database of records, or one of another schema. [`Error::Output`] where it cannot be written.
    pub fn open(path: &Path) -> Result<Self> {
        if let Some(parent) = path.parent().filter(|parent| !parent.as_os_str().is_empty()) {
            let output = |source| Error::Output { path: path.to_path_buf(), source };
            std::fs::create_dir_all(parent).map_err(output)?;
        }
        if !path.exists() {
            make(path)?;
        }
        let mut records = Self::open_existing(path)?;
        check_writable(&mut records.connection, path)?;
        schema::upgrade(&mut records.connection, path)?;
        Ok(records)
    }

    /// Opens records that are there. The database is not made; but what an interrupted writer left in its journal is taken back.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the file is missing, empty or no database of records, or where it is one of another schema.
    pub fn open_existing(path: &Path) -> Result<Self> {
        // a pipe would be waited for
        if path.metadata().is_ok_and(|found| !found.is_file() && !found.is_dir()) {
            return Err(not_a_database(path));
        }
        let file = open_file(path, "records").map_err(Error::Experiment)?;
        if file.metadata().is_ok_and(|metadata| metadata.len() == 0) {
            return Err(empty(path));
        }
        let mut start = Vec::new();
        // a file that cannot be read is refused below
        let _ = file.take(MAGIC.len() as u64).read_to_end(&mut start);
        if !start.is_empty() && start != MAGIC {
            return Err(not_a_database(path));
        }
        let connection = connect(path, path)?;
        schema::check(&connection, path)?;
        Ok(Self { connection, path: path.to_path_buf() })
    }

    /// Inserts a calibration, in one transaction. One of the same recording, experiment, motion and program is replaced and keeps its number.
    ///
    /// # Errors
    /// [`Error::Output`] where it cannot be written. [`Error::Recording`] where the records have its recording as one of another sensor. The records are then as they were.
    pub fn insert(&mut self, record: &Record) -> Result<Inserted> {
        self.in_transaction(|transaction, path| insert(transaction, path, record))
    }

    /// Inserts many calibrations, a thousand in one transaction. Gives how many are new.
    ///
    /// # Errors
    /// As [`insert`](Self::insert). What was inserted a thousand before stays.
    pub fn insert_all(&mut self, records: impl IntoIterator<Item = Record>) -> Result<usize> {
        let (mut records, mut new) = (records.into_iter().peekable(), 0);
        while records.peek().is_some() {
            let piece = records.by_ref().take(PIECE);
            new += self.in_transaction(|transaction, path| {
                let mut new = 0;
                for record in piece {
                    new += usize::from(!insert(transaction, path, &record)?.replaced);
                }
                Ok(new)
            })?;
        }
        Ok(new)
    }

    /// Refuses a recording that the records have as one of another sensor. [`insert`](Self::insert) does so, too; this is for before the work.
    ///
    /// # Errors
    /// [`Error::Recording`] names the calibration of the other sensor.
    pub fn refuse_repeated(&self, sensor: &str, recordings: &[HashedFile]) -> Result<()> {
        repeated_recording::refuse(&self.connection, &self.path, sensor, recordings)
            .map_err(|failure| failure.of(&self.path))
    }

    /// Removes calibrations by their numbers, in one transaction.
    ///
    /// # Errors
    /// [`Error::Experiment`] where there is no calibration of a number, and [`Error::Output`] where they cannot be written. The records are then as they were.
    pub fn remove(&mut self, ids: &[i64]) -> Result<()> {
        self.in_transaction(|transaction, path| {
            // one that is named twice is removed once
            for id in BTreeSet::from_iter(ids) {
                // its parameters go with it
                if transaction.execute("DELETE FROM calibrations WHERE id = ?", [id])? == 0 {
                    return Err(Failure::Refused(unknown(path, *id)));
                }
            }
            Ok(())
        })
    }

    fn in_transaction<T>(
        &mut self,
        work: impl FnOnce(&Transaction<'_>, &Path) -> std::result::Result<T, Failure>,
    ) -> Result<T> {
        let Self { connection, path } = self;
        let attempt = || {
            let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
            let done = work(&transaction, path)?;
            transaction.commit()?;
            Ok(done)
        };
        attempt().map_err(|failure: Failure| failure.of(path))
    }
}

/// Makes a database without records: beside its place, since a writer who comes at the same time must not find half of it.
fn make(path: &Path) -> Result<()> {
    let output = |source| Error::Output { path: path.to_path_buf(), source };
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let directory = tempfile::Builder::new().prefix(".calibrant-").tempdir_in(parent).map_err(output)?;
    let place = directory.path().join("new");
    schema::make(&connect(&place, path)?, path)?;
    match tempfile::TempPath::try_from_path(place).map_err(output)?.persist_noclobber(path) {
        // the other writer has made the same
        Err(error) if error.error.kind() == std::io::ErrorKind::AlreadyExists => Ok(()),
        made => made.map_err(|error| output(error.error)),
    }
}

/// Connects to the database in this place, which is that of these records.
fn connect(place: &Path, records: &Path) -> Result<Connection> {
    let connected = Connection::open_with_flags(place, flags(place != records)).and_then(|connection| {
        connection.busy_timeout(PATIENCE)?;
        // a file of somebody else can have any, also one that never ends
        connection.set_db_config(DbConfig::SQLITE_DBCONFIG_ENABLE_VIEW, false)?;
        connection.set_db_config(DbConfig::SQLITE_DBCONFIG_ENABLE_TRIGGER, false)?;
        // for a new database; covariances of 20 parameters leave half of a page of 4 KiB empty
        connection.pragma_update(None, "page_size", 16_384)?;
        connection.pragma_update(None, "foreign_keys", true)?;
        Ok(connection)
    });
    connected.map_err(|error| failed(records, error))
}

fn flags(new: bool) -> OpenFlags {
    let usual = OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    if new { usual | OpenFlags::SQLITE_OPEN_CREATE } else { usual }
}

fn insert(
    transaction: &Transaction<'_>,
    path: &Path,
    record: &Record,
) -> std::result::Result<Inserted, Failure> {
    repeated_recording::refuse(transaction, path, &record.sensor, &record.recordings)?;
    let recording_sha256 = record.recording_sha256();
    let sha256 = |file: &Option<HashedFile>| file.as_ref().map_or(String::new(), |file| file.sha256.clone());
    let (experiment_sha256, motion_sha256) = (sha256(&record.experiment), sha256(&record.motion_file));
    let earlier: Option<i64> = transaction
        .prepare_cached(
            "SELECT id FROM calibrations
             WHERE recording_sha256 = ? AND experiment_sha256 = ? AND motion_sha256 = ? AND program = ?",
        )?
        .query_row([&recording_sha256, &experiment_sha256, &motion_sha256, &record.program], |row| row.get(0))
        .optional()?;
    // its parameters go with it
    transaction.prepare_cached("DELETE FROM calibrations WHERE id = ?")?.execute([earlier])?;
    let further = Further::of(&record.imu);
    transaction
        .prepare_cached(
            "INSERT INTO calibrations (id, sensor, recorded, inserted, station, program, plan, experiment, experiment_sha256, motion, motion_sha256,
                recording, recording_sha256, verdict, codes, status, model, reference_c, least_c, greatest_c, degrees, covariance)
             VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        )?
        .execute(params![
            earlier,
            record.sensor,
            record.recorded.map(|time| time.to_string()),
            // it does not stand in results
            UtcTime::now().to_string(),
            record.station,
            record.program,
            record.plan,
            record.experiment.as_ref().map(|file| &file.file),
            experiment_sha256,
            record.motion_file.as_ref().map(|file| &file.file),
            motion_sha256,
            record.names().join("/"),
            recording_sha256,
            record.verdict.usability.name(),
            record.verdict.codes.join(" "),
            record.status,
            model_of(transaction, &record.imu)?,
            further.reference_c,
            further.range_c.map(|[least, _]| least),
            further.range_c.map(|[_, greatest]| greatest),
            further.degrees.map(bytes_of),
            further.covariance.map(bytes_of),
        ])?;
    let id = transaction.last_insert_rowid();
    let mut parameter = transaction
        .prepare_cached("INSERT INTO parameters (calibration, place, value, sd) VALUES (?, ?, ?, ?)")?;
    for (place, quantity) in record.imu.quantities.iter().enumerate() {
        let variance = record.imu.covariance.as_ref().map(|sigma| sigma[(place, place)]);
        // a fit that did not converge has a covariance of zeros, and no sd
        let sd = variance.filter(|variance| *variance > 0.0).map(f64::sqrt);
        parameter.execute(params![id, place as i64, quantity.value(&record.imu.parameters), sd])?;
    }
    if let Some(shared) = further.shared {
        transaction
            .prepare_cached("INSERT INTO shared_errors (calibration, sources, root) VALUES (?, ?, ?)")?
            .execute(params![
                id,
                shared.sources.join("\n"),
                bytes_of(shared.root.transpose().iter().copied())
            ])?;
    }
    checksum::seal(transaction, id)?;
    Ok(Inserted { id, replaced: earlier.is_some() })
}

/// The number of the model of an IMU, which is inserted where it is new.
fn model_of(transaction: &Transaction<'_>, imu: &CalibratedImu) -> rusqlite::Result<i64> {
    let text = model::text_of(imu);
    let known = transaction
        .prepare_cached("SELECT id FROM models WHERE text = ?")?
        .query_row([&text], |row| row.get(0));
    if let Some(id) = known.optional()? {
        return Ok(id);
    }
    transaction.execute("INSERT INTO models (text) VALUES (?)", [&text])?;
    let id = transaction.last_insert_rowid();
    let mut name =
        transaction.prepare_cached("INSERT INTO names (model, place, name, unit) VALUES (?, ?, ?, ?)")?;
    for (place, quantity) in imu.quantities.iter().enumerate() {
        let readings = imu.unit(quantity.sensor_kind()).unwrap_or(quantity.sensor_kind().stimulus_unit());
        name.execute(params![id, place as i64, quantity.name(), quantity.unit(readings)])?;
    }
    checksum::seal_model(transaction, id)?;
    Ok(id)
}
