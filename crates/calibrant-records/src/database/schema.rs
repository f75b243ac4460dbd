//! The schema of the database: it makes a new one, and refuses one of another program or version.

use super::failure::{damaged, failed};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use rusqlite::{Connection, TransactionBehavior};
use std::path::Path;

/// `cali`: says that a database is ours.
const APPLICATION_ID: i32 = 0x6361_6c69;

/// What makes a new database.
const NEW: &str = "
    CREATE TABLE models (
        id INTEGER PRIMARY KEY,
        text TEXT NOT NULL UNIQUE, -- calibrant JSON of the sensors, with zero in place of each parameter
        checksum BLOB -- of the values before it
    ) STRICT;
    CREATE TABLE names (
        model INTEGER NOT NULL REFERENCES models (id),
        place INTEGER NOT NULL, -- from 0
        name TEXT NOT NULL,
        unit TEXT NOT NULL,
        PRIMARY KEY (model, place)
    ) STRICT, WITHOUT ROWID;
    CREATE TABLE calibrations (
        id INTEGER PRIMARY KEY AUTOINCREMENT, -- the number of a calibration that was removed is not given again
        sensor TEXT NOT NULL,
        recorded TEXT, -- UTC: 2026-05-01, or 2026-05-01T08:30:00Z
        inserted TEXT NOT NULL, -- UTC
        station TEXT,
        program TEXT NOT NULL,
        plan TEXT NOT NULL, -- motion, holds or machine
        experiment TEXT,
        experiment_sha256 TEXT NOT NULL,
        motion TEXT,
        motion_sha256 TEXT NOT NULL, -- empty where there is no file of a motion
        recording TEXT NOT NULL, -- with slashes between several files
        recording_sha256 TEXT NOT NULL, -- with blanks between them
        verdict TEXT NOT NULL CHECK (verdict IN ('ok', 'doubtful', 'bad')),
        codes TEXT NOT NULL, -- with blanks between them
        status TEXT NOT NULL,
        model INTEGER NOT NULL REFERENCES models (id),
        reference_c REAL, -- of the temperature terms
        least_c REAL,
        greatest_c REAL,
        degrees BLOB, -- degrees of freedom behind the covariance, 3 f64
        covariance BLOB, -- lower triangle by rows, f64, little endian
        checksum BLOB, -- of the values before it, and of the parameters
        UNIQUE (recording_sha256, experiment_sha256, motion_sha256, program)
    ) STRICT;
    CREATE INDEX calibrations_of_sensor ON calibrations (sensor, recorded);
    CREATE TABLE parameters (
        calibration INTEGER NOT NULL REFERENCES calibrations (id) ON DELETE CASCADE,
        place INTEGER NOT NULL,
        value REAL NOT NULL,
        sd REAL,
        PRIMARY KEY (calibration, place)
    ) STRICT, WITHOUT ROWID;
    CREATE VIEW estimates AS
        SELECT c.id AS calibration, c.sensor, c.recorded, c.station, c.verdict, n.name, n.unit, p.value, p.sd
        FROM calibrations c JOIN parameters p ON p.calibration = c.id
        JOIN names n ON n.model = c.model AND n.place = p.place;
";

/// The calibrations without those that a later one of the same recording replaces: also a view of the database, for people. The views of a file are
/// not used, since they can be any: a question has this in words.
pub(super) const LATEST: &str = "
    SELECT * FROM calibrations c WHERE NOT EXISTS (
        SELECT 1 FROM calibrations d
        WHERE d.recording_sha256 = c.recording_sha256 AND (d.inserted, d.id) > (c.inserted, c.id)
    )
";

/// The tables that a view cannot stand for.
const TABLES: &str = "SELECT count(*) FROM sqlite_schema
    WHERE type = 'table' AND name IN ('models', 'names', 'calibrations', 'parameters')";

/// What version 4 adds.
const SHARED_ERRORS: &str = "
    CREATE TABLE shared_errors (
        calibration INTEGER PRIMARY KEY REFERENCES calibrations (id) ON DELETE CASCADE,
        sources TEXT NOT NULL, -- one in each line: gravity 9.80665 ± 0.019 m/s²
        root BLOB NOT NULL -- a row for each parameter, a column for each source, f64, little endian
    ) STRICT;
";

/// The version of the schema.
pub(super) const VERSION: i32 = 4;

/// The version before, which has no shared errors.
const BEFORE: i32 = 3;

/// Brings a database that can be written to this version.
pub(super) fn upgrade(connection: &mut Connection, path: &Path) -> Result<()> {
    let upgrade = |connection: &mut Connection| {
        let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
        if version(&transaction)? == BEFORE {
            transaction.execute_batch(SHARED_ERRORS)?;
            transaction.pragma_update(None, "user_version", VERSION)?;
        }
        transaction.commit()
    };
    let is_older = version(connection).is_ok_and(|version| version == BEFORE);
    if is_older { upgrade(connection).map_err(|error| failed(path, error)) } else { Ok(()) }
}

/// Has this database a table of shared errors?
pub(super) fn has_shared_errors(connection: &Connection) -> rusqlite::Result<bool> {
    Ok(version(connection)? >= VERSION)
}

fn version(connection: &Connection) -> rusqlite::Result<i32> {
    connection.pragma_query_value(None, "user_version", |row| row.get(0))
}

/// Makes the tables of a database that is new.
pub(super) fn make(connection: &Connection, path: &Path) -> Result<()> {
    let made = connection.execute_batch(NEW).and_then(|()| {
        connection.execute_batch(&format!("CREATE VIEW latest AS {LATEST};"))?;
        connection.execute_batch(SHARED_ERRORS)?;
        connection.pragma_update(None, "application_id", APPLICATION_ID)?;
        connection.pragma_update(None, "user_version", VERSION)
    });
    made.map_err(|error| failed(path, error))
}

/// Refuses a database of another program or version.
pub(super) fn check(connection: &Connection, path: &Path) -> Result<()> {
    let number = |name: &str| {
        connection
            .pragma_query_value(None, name, |row| row.get::<_, i32>(0))
            .map_err(|error| failed(path, error))
    };
    let (application, version) = (number("application_id")?, number("user_version")?);
    let refuse = |refusal, message: String, help: &str| {
        Err(Error::experiment(InputError::new(refusal, message, help).in_file(path)))
    };
    if application != APPLICATION_ID {
        let message = "this is an SQLite database of another program".to_owned();
        return refuse(Refusal::FormatUnknown, message, "give another file for the records");
    }
    if [BEFORE, VERSION].contains(&version) {
        let tables = connection.query_row(TABLES, [], |row| row.get::<_, i64>(0));
        return match tables.map_err(|error| failed(path, error))? {
            4 => Ok(()),
            _ => Err(damaged(path, "one of their tables is not there")),
        };
    }
    let message = format!(
        "these records have version {version} of the schema, and this calibrant reads version {VERSION}"
    );
    refuse(Refusal::FormatUnsupported, message, "use the calibrant that wrote them, or a newer one")
}
