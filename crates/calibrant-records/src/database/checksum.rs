//! Checksums in the database: SQLite has none, and a number of which a byte has changed is still a number.

use rusqlite::types::ValueRef;
use rusqlite::{CachedStatement, Connection, Row, params};
use sha2::{Digest, Sha256};

/// The columns that a row is read from, in their order; the last is the checksum.
pub(super) const COLUMNS: &str =
    "id, sensor, recorded, inserted, station, program, plan, experiment, experiment_sha256, motion,
    motion_sha256, recording, recording_sha256, verdict, codes, status, model, reference_c, least_c, greatest_c, degrees, covariance, checksum";
/// The number of columns of which the checksum is.
pub(super) const VALUES: usize = 22;

/// The parameters of a calibration, in their order.
pub(super) const PARAMETERS: &str = "SELECT value, sd FROM parameters WHERE calibration = ? ORDER BY place";
/// The shared errors of a calibration, where it has some.
pub(super) const SHARED: &str = "SELECT sources, root FROM shared_errors WHERE calibration = ?";
pub(super) const MODEL: &str = "SELECT id, text, checksum FROM models WHERE id = ?";

/// Shared errors as they stand in the table: their sources, and what they do.
pub(super) type SharedText = (String, Vec<u8>);

/// The estimates of a calibration, its shared errors as they stand in the table, and the checksum of all that is kept of it.
pub(super) fn parameters(
    statement: &mut CachedStatement<'_>,
    shared: Option<&mut CachedStatement<'_>>,
    row: &Row<'_>,
) -> rusqlite::Result<(Vec<f64>, Option<SharedText>, Vec<u8>)> {
    let mut checksum = Checksum::default();
    checksum.take(row, VALUES)?;
    let (mut estimates, mut rows) = (Vec::new(), statement.query([row.get::<_, i64>(0)?])?);
    while let Some(parameter) = rows.next()? {
        checksum.take(parameter, 2)?;
        estimates.push(parameter.get(0)?);
    }
    let mut errors = None;
    if let Some(statement) = shared {
        let mut rows = statement.query([row.get::<_, i64>(0)?])?;
        if let Some(found) = rows.next()? {
            checksum.take(found, 2)?;
            errors = Some((found.get(0)?, found.get(1)?));
        }
    }
    Ok((estimates, errors, checksum.bytes()))
}

/// The text of a model, the checksum that is kept, and the one that it has.
pub(super) fn model_row(row: &Row<'_>) -> rusqlite::Result<(String, Option<Vec<u8>>, Vec<u8>)> {
    let mut checksum = Checksum::default();
    checksum.take(row, 2)?;
    Ok((row.get(1)?, row.get(2)?, checksum.bytes()))
}

/// Enters the checksum of a calibration, once all of it is there.
pub(super) fn seal(connection: &Connection, id: i64) -> rusqlite::Result<()> {
    let (mut of_parameters, mut shared) =
        (connection.prepare_cached(PARAMETERS)?, connection.prepare_cached(SHARED)?);
    let (_, _, checksum) = connection
        .prepare_cached(&format!("SELECT {COLUMNS} FROM calibrations WHERE id = ?"))?
        .query_row([id], |row| parameters(&mut of_parameters, Some(&mut shared), row))?;
    connection
        .prepare_cached("UPDATE calibrations SET checksum = ? WHERE id = ?")?
        .execute(params![checksum, id])?;
    Ok(())
}

/// Enters the checksum of a model.
pub(super) fn seal_model(connection: &Connection, id: i64) -> rusqlite::Result<()> {
    let (_, _, checksum) = connection.query_row(MODEL, [id], model_row)?;
    connection.execute("UPDATE models SET checksum = ? WHERE id = ?", params![checksum, id])?;
    Ok(())
}

/// The checksum of values as they stand in tables.
#[derive(Default)]
struct Checksum(Sha256);

impl Checksum {
    /// Takes this number of values from the beginning of a row: each with its type and its length.
    fn take(&mut self, row: &Row<'_>, values: usize) -> rusqlite::Result<()> {
        for place in 0..values {
            match row.get_ref(place)? {
                ValueRef::Null => self.value(b'n', &[]),
                ValueRef::Integer(number) => self.value(b'i', &number.to_le_bytes()),
                ValueRef::Real(number) => self.value(b'r', &number.to_le_bytes()),
                ValueRef::Text(bytes) => self.value(b't', bytes),
                ValueRef::Blob(bytes) => self.value(b'b', bytes),
            }
        }
        Ok(())
    }

    fn value(&mut self, kind: u8, bytes: &[u8]) {
        self.0.update([kind]);
        self.0.update((bytes.len() as u64).to_le_bytes());
        self.0.update(bytes);
    }

    /// Its bytes, as they are kept.
    fn bytes(self) -> Vec<u8> {
        self.0.finalize().to_vec()
    }
}
