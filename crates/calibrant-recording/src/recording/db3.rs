//! Reads the messages of ROS 2 bags in SQLite databases, `.db3`.
//!
//! ```text
//! topics     id, name, type, serialization_format, …
//! messages   id, topic_id, timestamp in ns, data
//! ```

use super::bag::{Bag, Connection, MessageType};
use super::sqlite::{Database, Table, Value};
use crate::text::decoding::{Checked, refuse};
use calibrant_core::error::{InputError, Refusal};
use std::collections::BTreeMap;

pub(super) fn read<'t, M>(bytes: &[u8], types: &'t [MessageType<M>]) -> Checked<Bag<'t, M>> {
    let database = Database::open(bytes).map_err(damaged)?;
    let tables = database.tables().map_err(damaged)?;
    let table = |name: &str| tables.iter().find(|table| table.name == name);
    let (Some(topics), Some(messages)) = (table("topics"), table("messages")) else {
        let names: Vec<&str> = tables.iter().map(|table| table.name.as_str()).take(10).collect();
        let message = match names.as_slice() {
            [] => "this SQLite database is empty".to_owned(),
            names => format!("this SQLite database is no bag of ROS 2: its tables are {}", names.join(", ")),
        };
        let help = match database.has_log {
            true => {
                "a recorder that was killed leaves the messages in a file …-wal beside it: `sqlite3 FILE.db3 'PRAGMA wal_checkpoint(TRUNCATE)'` puts them into this one"
            }
            false => {
                "a bag has the tables topics and messages; save another table as CSV: `sqlite3 -header -csv FILE 'SELECT * FROM TABLE' > log.csv`"
            }
        };
        return refuse(Refusal::FormatUnknown, message, help);
    };
    let mut bag = Bag::new(types);
    let mut connections: BTreeMap<i64, Connection<'t, M>> = BTreeMap::new();
    let [name, kind, encoding] = columns(topics, ["name", "type", "serialization_format"])?;
    let id = topics.column("id");
    database.rows(topics, damaged, |number, row| {
        let text = |column: usize| row.get(column).map_or("", Value::text);
        let number = id.and_then(|id| row.get(id)?.integer()).unwrap_or(number);
        connections.insert(number, bag.connect(text(name), text(kind), text(encoding))?);
        Ok(())
    })?;
    let [topic, time, data] = columns(messages, ["topic_id", "timestamp", "data"])?;
    database.rows(messages, damaged, |_, row| {
        let integer = |column: usize| row.get(column).and_then(Value::integer);
        let Some(connection) = integer(topic).and_then(|topic| connections.get(&topic)) else {
            return Ok(());
        };
        let log_time_ns = integer(time).and_then(|time| u64::try_from(time).ok()).unwrap_or(0);
        bag.take(connection, log_time_ns, row.get(data).map_or(&[], Value::bytes))
    })?;
    Ok(bag)
}

/// The places of columns in the rows of a table.
fn columns<const N: usize>(table: &Table, names: [&str; N]) -> Checked<[usize; N]> {
    let mut places = [0; N];
    for (place, name) in places.iter_mut().zip(names) {
        let Some(column) = table.column(name) else {
            let message = format!("the table {} has no column {name}: this is no bag of ROS 2", table.name);
            return refuse(
                Refusal::FormatUnknown,
                message,
                "give the .db3 that `ros2 bag record` has written",
            );
        };
        *place = column;
    }
    Ok(places)
}

fn damaged(why: &'static str) -> InputError {
    InputError::new(
        Refusal::FileDamaged,
        format!("the SQLite database is damaged: {why}"),
        "copy it again, or try `sqlite3 FILE.db3 .recover | sqlite3 NEW.db3`",
    )
}
