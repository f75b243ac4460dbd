//! The sensor that a recording names itself.

use super::chunked_reader::FileBeginning;
use super::text_header::Head;
use crate::text::decoding::{self, Checked};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use std::path::Path;

/// The sensor by a line `# KEY: value` above the header of a text, or by the column KEY. Capitals do not count. The beginning of a long file is read.
///
/// # Errors
/// [`Error::Recording`] where the file is no text, or names nothing by that key, or names two sensors.
pub fn sensor_named_in(path: &Path, key: &str) -> Result<String> {
    let refuse = |message: String| {
        let help = "name what has the sensor, or name the sensor by the file's name";
        Box::new(InputError::new(Refusal::ColumnMissing, message, help))
    };
    let named = || -> Checked<String> {
        let beginning = FileBeginning::read(path, |_| false)?;
        let head = Head::find(decoding::as_text(&beginning.bytes)?)?;
        let mut names = of_lines(&head, key);
        names.extend(of_column(head, key));
        let other = names.iter().find(|name| Some(*name) != names.first());
        match (names.first(), other) {
            (Some(name), None) => Ok(name.clone()),
            (Some(name), Some(other)) => {
                Err(refuse(format!("this recording names two sensors by {key:?}: {name:?} and {other:?}")))
            }
            (None, _) => Err(refuse(format!(
                "this recording has neither a line `# {key}: …` above its header nor a column {key:?}"
            ))),
        }
    };
    named().map_err(|error| Error::recording(error.in_file(path)))
}

/// The values of the lines `KEY: value` above the header.
fn of_lines(head: &Head<'_>, key: &str) -> Vec<String> {
    let value = |text: &str| {
        let (name, value) = text.trim_matches(['#', '/', '%', ' ', '\t']).split_once(':')?;
        let value = value.trim_matches([' ', '\t', ',', ';', '"']);
        (name.trim().eq_ignore_ascii_case(key) && !value.is_empty()).then(|| value.to_owned())
    };
    head.preamble.iter().filter_map(|line| value(line.text)).collect()
}

/// The values of the column KEY.
fn of_column(head: Head<'_>, key: &str) -> Vec<String> {
    let column = head.names.iter().position(|name| name.trim_matches('"').eq_ignore_ascii_case(key));
    let Some(column) = column else { return Vec::new() };
    let rows = head.first_row.into_iter().chain(head.rest).filter(|line| !line.is_void());
    let fields =
        rows.filter_map(|row| Some(row.fields(head.delimiter).nth(column)?.1.trim_matches(['"', ' '])));
    fields.filter(|field| !field.is_empty()).map(str::to_owned).collect()
}
