//! The sensor that a recording names itself.

use super::chunked_reader::FileBeginning;
use super::text_header::Head;
use crate::text_decoding::{self, Checked};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use std::path::Path;

/// The sensor by a line `# KEY: value` above the header of a text, or by the first row of the column KEY.
///
/// # Errors
/// [`Error::Recording`] where the file is no text, or names nothing by that key.
pub(crate) fn sensor_named_in(path: &Path, key: &str) -> Result<String> {
    let named = || -> Checked<Option<String>> {
        let beginning = FileBeginning::read(path, |_| false)?;
        let head = Head::find(text_decoding::as_text(&beginning.bytes)?)?;
        Ok(head.value(key).map(str::to_owned).or_else(|| first_of_column(head, key)))
    };
    let missing = || {
        let message =
            format!("this recording has neither a line `# {key}: …` above its header nor a column {key:?}");
        let help = "name what has the sensor, or name the sensor by the file's name";
        Box::new(InputError::new(Refusal::ColumnMissing, message, help))
    };
    named()
        .and_then(|sensor| sensor.ok_or_else(missing))
        .map_err(|error| Error::recording(error.in_file(path)))
}

fn first_of_column(head: Head<'_>, key: &str) -> Option<String> {
    let column = head.names.iter().position(|name| name.eq_ignore_ascii_case(key))?;
    let row = head.first_row.into_iter().chain(head.rest).find(|line| !line.is_void())?;
    let (_, field) = row.fields(head.delimiter).nth(column)?;
    Some(field.trim_matches(['"', ' ']).to_owned())
}
