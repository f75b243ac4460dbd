//! Several sensors in the rows of one file: a column numbers them, as in the logs of autopilots.

use super::column::ColumnMeaning;
use super::file_layout::Draft;
use super::first_rows::FirstRows;
use super::options::ImuReadOptions;
use crate::text::decoding::{Checked, refuse};
use calibrant_core::error::{Answer, InputError, Refusal, TaskOption};

/// Names of a column that numbers sensors.
const NAMES: &[&str] = &[
    "i", "id", "instance", "imu", "imuid", "sensor", "sensorid", "device", "deviceid", "node", "nodeid",
    "unit", "unitid", "source", "address", "mac", "serial",
];
/// A column with more different values numbers no sensors.
const MOST: usize = 8;
/// The sensors of a file take turns: at least one row in this number is of another sensor than the row before.
const TURNS: usize = 10;
/// Where one row in this number follows the one before in less than a third of the mean step, two samples are there at a time.
const TOGETHER: usize = 4;

/// The rows of one sensor: a column and its value.
pub(super) type Only = Option<(usize, String)>;

/// The rows to read: those of the sensor that the options choose; `None` for all. A question where nothing chooses.
pub(super) fn chosen(draft: &mut Draft, rows: &FirstRows<'_>, options: &ImuReadOptions) -> Checked<Only> {
    let found = rows.are_enough().then(|| find(draft, rows)).flatten();
    match (found, &options.instance) {
        (None, None) => Ok(None),
        (None, Some(given)) => refuse(
            Refusal::SensorUnnamed,
            format!("the sensor `{given}` was chosen, but no column of the file numbers sensors"),
            "leave option `instance` away",
        ),
        (Some((column, values)), Some(given)) if values.contains(given) => {
            draft.columns[column].unused = Some(format!("it numbers the sensors: {given} is read"));
            Ok(Some((column, given.clone())))
        }
        (Some((column, values)), _) => {
            let name = &draft.columns[column].name;
            let message = format!(
                "the rows are those of {} sensors: column `{name}` numbers them, {}",
                values.len(),
                values.join(", ")
            );
            let values = values.iter().map(String::as_str);
            let answer = Answer::new(TaskOption::Instance, values).and(", or instance in [columns]");
            Err(InputError::question(Refusal::SensorUnnamed, message, vec![answer]).into())
        }
    }
}

/// The column that numbers sensors, and its values.
fn find(draft: &Draft, rows: &FirstRows<'_>) -> Option<(usize, Vec<String>)> {
    let time = draft.columns.iter().position(|column| column.meaning == ColumnMeaning::Time);
    let are_together = time.is_some_and(|time| two_at_a_time(&rows.times(time)));
    (0..draft.columns.len()).find_map(|k| {
        let column = &draft.columns[k];
        let plain: String = column.name.to_lowercase().chars().filter(|c| c.is_alphanumeric()).collect();
        let is_other = column.meaning == ColumnMeaning::Other;
        if !is_other || !(are_together || NAMES.contains(&plain.as_str())) {
            return None;
        }
        let fields: Vec<&str> = rows.column(k).collect();
        let turns = fields.array_windows().filter(|[one, next]| one != next).count();
        let mut values: Vec<String> = Vec::new();
        for field in &fields {
            if !values.iter().any(|value| value == field) {
                values.push((*field).to_owned());
            }
            if values.len() > MOST {
                return None;
            }
        }
        // a flag changes as often, but the rows of one of its values are no evener than all
        let is_alone = |value: &String| {
            let times = rows.times(time?);
            let own: Vec<f64> =
                times.iter().zip(&fields).filter(|(_, field)| *field == value).map(|(t, _)| *t).collect();
            Some(2 * own.len() * values.len() > fields.len() && !two_at_a_time(&own))
        };
        let is_name = |value: &String| {
            !value.is_empty() && (value.parse::<f64>().is_err() || value.parse::<i64>().is_ok())
        };
        (values.len() > 1
            && TURNS * turns > fields.len()
            && values.iter().all(is_name)
            && (!are_together || values.iter().all(|value| is_alone(value) == Some(true))))
        .then_some((k, values))
    })
}

fn two_at_a_time(times: &[f64]) -> bool {
    let steps: Vec<f64> = times.array_windows().map(|[one, next]| next - one).collect();
    let mean = steps.iter().sum::<f64>() / steps.len() as f64;
    TOGETHER * steps.iter().filter(|step| **step < mean / 3.0).count() > steps.len()
}
