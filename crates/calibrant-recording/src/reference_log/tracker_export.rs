//! What the exports of trackers share: several bodies in one table below some lines of a head, of which one is read.

use super::content::{Content, Values};
use super::format::ReferenceFormat;
use super::log_columns::{AngleUnit, LengthUnit};
use super::options::ReferenceLogOptions;
use super::orientation_form::OrientationForm;
use super::text_columns::TextColumns;
use crate::recording::TimeUnit;
use crate::recording::text_header::Head;
use crate::text::decoding::{Checked, refuse};
use crate::text::delimited::{Delimiter, Line, Lines};
use calibrant_core::diagnostic::reader::quoted;
use calibrant_core::error::{InputError, Refusal, TaskOption};

/// A body and its columns.
pub(super) struct Body {
    pub(super) name: String,
    /// x, y and z.
    pub(super) position: Vec<usize>,
    /// In the order of the form; empty where there are none.
    pub(super) orientation: Vec<usize>,
}

/// The orientation in an export.
pub(super) enum Form {
    /// The file says it.
    Known(OrientationForm),
    /// The user has to say it: what it may be.
    Asked(&'static str),
}

/// An export of a tracker.
pub(super) struct Export<'t> {
    pub(super) format: ReferenceFormat,
    pub(super) bodies: Vec<Body>,
    pub(super) form: Form,
    pub(super) length: LengthUnit,
    pub(super) angle: AngleUnit,
    /// The column of times; that of frames, where their rate is given, Hz.
    pub(super) time: (usize, Option<f64>),
    pub(super) delimiter: Delimiter,
    /// The line with the names of the columns.
    pub(super) header: Line<'t>,
    /// The rows.
    pub(super) rest: Lines<'t>,
}

impl<'t> Export<'t> {
    /// The columns of the body that is asked for, or of the only one.
    pub(super) fn columns(self, options: &ReferenceLogOptions) -> Checked<(Head<'t>, TextColumns)> {
        let names: Vec<String> = self.bodies.iter().map(|body| body.name.clone()).collect();
        let asked = |body: &&Body| options.topic.as_ref().is_none_or(|topic| *topic == body.name);
        let found: Vec<&Body> = self.bodies.iter().filter(asked).collect();
        let at = |error: InputError| error.at_line(self.header.number);
        let body = match found.as_slice() {
            [one] => *one,
            [] if names.is_empty() => {
                let help = "export the rigid bodies, with their orientations";
                return Err(at(InputError::new(
                    Refusal::ColumnMissing,
                    "the export has no rigid body",
                    help,
                ))
                .into());
            }
            several => {
                let message = match (several, &options.topic) {
                    ([], Some(topic)) => {
                        format!("the export has no body `{topic}`; it has {}", quoted(&names, 20))
                    }
                    _ => format!("there is more than one body: {}", quoted(&names, 20)),
                };
                let help = "name it: topic = \"…\" in [machine.log]; `inspect` takes option `topic`";
                let error = InputError::new(Refusal::TopicUnknown, message, help);
                let bodies = names.iter().map(String::as_str);
                return Err(at(error.answered_by(TaskOption::Topic, bodies)).into());
            }
        };
        let form = match (&self.form, options.columns.orientation_is) {
            _ if body.orientation.is_empty() => OrientationForm::QuaternionWxyz,
            (_, Some(said)) if said.width() == body.orientation.len() => said,
            (Form::Known(form), None) => *form,
            (Form::Known(_), Some(said)) => {
                let message = format!(
                    "the orientations of the export have {} columns, and \"{said}\" has {}",
                    body.orientation.len(),
                    said.width()
                );
                return refuse(
                    Refusal::ValueInvalid,
                    message,
                    "take orientation_is out of [machine.log.columns]",
                );
            }
            (Form::Asked(answers), _) => {
                let message = "the file does not say what its three angles of an orientation are";
                return Err(at(InputError::new(Refusal::FormatUnknown, message, *answers)).into());
            }
        };
        let row = self.rest.clone().find(|line| !line.text.trim_ascii().is_empty());
        let width = row.map_or(0, |row| row.fields(self.delimiter).count());
        if let Some(beyond) = body.position.iter().chain(&body.orientation).find(|column| **column >= width) {
            let message = format!(
                "the rows have {width} columns, and the head says that `{}` is in column {}",
                body.name,
                beyond + 1
            );
            return Err(at(InputError::new(Refusal::RowMalformed, message, "export the file again")).into());
        }
        let mut slots = vec![None; width];
        let mut factors = vec![self.length.factor(); 3];
        let angle = if form.has_unit() {
            options.columns.orientation_unit.unwrap_or(self.angle).factor()
        } else {
            1.0
        };
        factors.resize(3 + form.width(), angle);
        for (value, column) in body.position.iter().chain(&body.orientation).enumerate() {
            slots[*column] = Some(1 + value);
        }
        let (time, rate_hz) = self.time;
        slots[time] = Some(0);
        let values = Values { content: Content::Poses(form), slots, factors, assumed: None };
        let columns = TextColumns {
            format: self.format,
            values,
            names: Vec::new(),
            has_header: true,
            time_unit: Some(TimeUnit::Second),
            rest: None,
            rate_hz,
        };
        Ok((Head::above_rows(self.header, self.delimiter, self.rest), columns))
    }
}

/// The cells of a line without those that are empty at its end.
pub(super) fn cells(line: Line<'_>, delimiter: Delimiter) -> Vec<&str> {
    let mut cells: Vec<&str> = line.fields(delimiter).map(|(_, field)| field.trim()).collect();
    while cells.last().is_some_and(|cell| cell.is_empty()) {
        cells.pop();
    }
    cells
}

/// The columns below these cells, from this one on: each the first that is so named.
pub(super) fn named_after(cells: &[&str], names: &[&str], from: usize, until: usize) -> Option<Vec<usize>> {
    let column = |name: &&str| (from..until.min(cells.len())).find(|k| cells[*k] == *name);
    names.iter().map(column).collect()
}
