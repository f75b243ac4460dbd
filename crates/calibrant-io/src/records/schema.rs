//! The schema of the database: it makes a new one, brings an older one up to date, and refuses all else.

use super::failure::failed;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use rusqlite::{Connection, TransactionBehavior};
use std::path::Path;

/// `cali`: says that a database is ours.
const APPLICATION_ID: i32 = 0x6361_6c69;

/// What leads from each version to the next; the first makes a new database.
const STEPS: [&str; 2] = [NEW, WITH_MOTION];

const NEW: &str = "
    CREATE TABLE models (
        id INTEGER PRIMARY KEY,
        text TEXT NOT NULL UNIQUE -- calibrant JSON of the sensors, with zero in place of each parameter
    ) STRICT;
    CREATE TABLE names (
        model INTEGER NOT NULL REFERENCES models (id),
        place INTEGER NOT NULL, -- from 0
        name TEXT NOT NULL,
        unit TEXT NOT NULL,
        PRIMARY KEY (model, place)
    ) STRICT, WITHOUT ROWID;
    CREATE TABLE calibrations (
        id INTEGER PRIMARY KEY,
        sensor TEXT NOT NULL,
        recorded TEXT, -- UTC: 2026-05-01, or 2026-05-01T08:30:00Z
        inserted TEXT NOT NULL, -- UTC
        station TEXT,
        program TEXT NOT NULL,
        plan TEXT NOT NULL, -- motion, holds or machine
        experiment TEXT,
        experiment_sha256 TEXT NOT NULL,
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
        UNIQUE (recording_sha256, experiment_sha256, program)
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
    CREATE VIEW latest AS
        SELECT * FROM calibrations c WHERE NOT EXISTS (
            SELECT 1 FROM calibrations d
            WHERE d.recording_sha256 = c.recording_sha256 AND (d.inserted, d.id) > (c.inserted, c.id)
        );
";

/// The motion is part of the key: a recording that is calibrated with another motion is another calibration. SQLite cannot change a key, so the table is made anew.
const WITH_MOTION: &str = "
    DROP VIEW latest;
    DROP VIEW estimates;
    CREATE TABLE with_motion (
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
        motion_sha256 TEXT NOT NULL, -- empty where there is no file of a motion, and in calibrations of version 1
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
        UNIQUE (recording_sha256, experiment_sha256, motion_sha256, program)
    ) STRICT;
    INSERT INTO with_motion
        SELECT id, sensor, recorded, inserted, station, program, plan, experiment, experiment_sha256, NULL, '',
            recording, recording_sha256, verdict, codes, status, model, reference_c, least_c, greatest_c, degrees, covariance
        FROM calibrations;
    DROP TABLE calibrations;
    ALTER TABLE with_motion RENAME TO calibrations;
    CREATE INDEX calibrations_of_sensor ON calibrations (sensor, recorded);
    CREATE VIEW estimates AS
        SELECT c.id AS calibration, c.sensor, c.recorded, c.station, c.verdict, n.name, n.unit, p.value, p.sd
        FROM calibrations c JOIN parameters p ON p.calibration = c.id
        JOIN names n ON n.model = c.model AND n.place = p.place;
    CREATE VIEW latest AS
        SELECT * FROM calibrations c WHERE NOT EXISTS (
            SELECT 1 FROM calibrations d
            WHERE d.recording_sha256 = c.recording_sha256 AND (d.inserted, d.id) > (c.inserted, c.id)
        );
";

/// The version that this program writes.
pub(super) const VERSION: i32 = STEPS.len() as i32;

/// Checks that a database is ours, and brings it to this version. Foreign keys hold in it from then on.
pub(super) fn prepare(connection: &mut Connection, path: &Path) -> Result<()> {
    let switch = |connection: &Connection, on: bool| {
        connection.pragma_update(None, "foreign_keys", on).map_err(|error| failed(path, error))
    };
    // a table that is dropped takes the rows that refer to it along where foreign keys hold
    switch(connection, false)?;
    bring_up_to_date(connection, path, VERSION)?;
    switch(connection, true)
}

/// Brings a database to a version in one transaction.
fn bring_up_to_date(connection: &mut Connection, path: &Path, target: i32) -> Result<()> {
    let write = |error| failed(path, error);
    // in one transaction: another process may make the database between two readings
    let before = connection.transaction().map_err(write)?;
    if stated(&before, path)? == Some(target) {
        return Ok(());
    }
    drop(before);
    // another process may do the same at this moment
    let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate).map_err(write)?;
    let version = stated(&transaction, path)?.unwrap_or(0);
    for step in STEPS.iter().take(target as usize).skip(version as usize) {
        transaction.execute_batch(step).map_err(write)?;
    }
    transaction.pragma_update(None, "application_id", APPLICATION_ID).map_err(write)?;
    transaction.pragma_update(None, "user_version", version.max(target)).map_err(write)?;
    transaction.commit().map_err(write)
}

/// The version of a database of ours, at most [`VERSION`]; `None` of one that is empty.
fn stated(connection: &Connection, path: &Path) -> Result<Option<i32>> {
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
        let objects = connection
            .query_row("SELECT count(*) FROM sqlite_schema", [], |row| row.get::<_, i64>(0))
            .map_err(|error| failed(path, error))?;
        if (application, version, objects) == (0, 0, 0) {
            return Ok(None);
        }
        let message = "this is an SQLite database of another program".to_owned();
        return refuse(Refusal::FormatUnknown, message, "give another file for the records");
    }
    match version {
        1..=VERSION => Ok(Some(version)),
        _ => {
            let message = format!(
                "these records have version {version} of the schema, and this calibrant reads versions 1 to {VERSION}"
            );
            refuse(Refusal::FormatUnsupported, message, "use the calibrant that wrote them, or a newer one")
        }
    }
}

/// An empty database of an older version.
#[cfg(test)]
pub(super) fn of_version(path: &Path, version: i32) -> Result<Connection> {
    let mut connection = Connection::open(path).map_err(|error| failed(path, error))?;
    bring_up_to_date(&mut connection, path, version)?;
    Ok(connection)
}
