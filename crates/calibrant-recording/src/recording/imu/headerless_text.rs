//! A text without a header: the question to the user, and the answer in `[columns]`.

use super::column_names::sensor_named;
use super::unit::ImuUnit;
use crate::recording::text_header::Head;
use calibrant_core::error::{InputError, Refusal};

/// The question about the meaning of the columns.
pub(super) fn question(head: &Head<'_>) -> InputError {
    let columns = head.fields();
    let message = format!("{columns} columns without a header: nothing says what they hold");
    let means = match columns {
        3 => "; where each row is the mean of a hold, say option `rows_are_holds` too",
        _ => "",
    };
    let help = format!(
        "begin the file with a line like t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps{means}{}",
        in_columns(head).map_or_else(String::new, |stated| format!("; or {stated}"))
    );
    InputError::new(Refusal::HeaderMissing, message, help).at_line(head.line())
}

/// The entry in `[columns]` for the usual order of this number of columns, with the units that the first row
/// suggests. `None` where there are too few.
pub(super) fn in_columns(head: &Head<'_>) -> Option<String> {
    if let Some(stated) = of_sensor_rows(head) {
        return Some(stated);
    }
    let values: Vec<f64> = head.first_row.map_or_else(Vec::new, |row| {
        row.fields(head.delimiter).map(|(_, field)| field.parse().unwrap_or(f64::NAN)).collect()
    });
    let (time, first, has_gyroscope) = match head.fields() {
        0..=2 => return None,
        3 => (false, 0, false),
        4 | 5 => (true, 1, false),
        6 => (false, 0, true),
        _ => (true, 1, true),
    };
    let unit = accelerometer_unit(values.get(first..first + 3).unwrap_or_default());
    let mut keys = match time {
        true => vec!["time = \"1\"".to_owned(), "time_unit = \"s\"".to_owned()],
        false => vec!["rate_hz = 100".to_owned()],
    };
    let mut sensor = |name: &str, first: usize, unit: ImuUnit| {
        let columns: Vec<String> = (first..first + 3).map(|column| format!("\"{}\"", column + 1)).collect();
        keys.push(format!("{name} = [{}]", columns.join(", ")));
        keys.push(format!("{name}_unit = \"{}\"", unit.symbol()));
    };
    sensor("accelerometer", first, unit);
    if has_gyroscope {
        let unit = if unit == ImuUnit::Counts { unit } else { ImuUnit::RadianPerSecond };
        sensor("gyroscope", first + 3, unit);
    }
    Some(stated(&keys))
}

fn stated(keys: &[String]) -> String {
    format!(
        "say what they hold in [columns] of an experiment file (of a file of its own for option `columns`), a line each, such as {}",
        keys.join(", ")
    )
}

/// The same for rows of one sensor each, where a field names it: both sensors are given the same three columns.
fn of_sensor_rows(head: &Head<'_>) -> Option<String> {
    let row: Vec<&str> = head.first_row?.fields(head.delimiter).map(|(_, field)| field.trim()).collect();
    row.iter().find(|field| sensor_named(field).is_some())?;
    let numbers = (1..=row.len()).filter(|column| row[column - 1].parse::<f64>().is_ok());
    let [time, x, y, z, ..] = *numbers.collect::<Vec<_>>() else { return None };
    let reading: Vec<f64> = [x, y, z].iter().filter_map(|column| row[column - 1].parse().ok()).collect();
    let unit = accelerometer_unit(&reading);
    let rate = if unit == ImuUnit::Counts { unit } else { ImuUnit::RadianPerSecond };
    let mut keys = vec![format!("time = \"{time}\""), "time_unit = \"s\"".to_owned()];
    for (name, unit) in [("accelerometer", unit), ("gyroscope", rate)] {
        keys.push(format!("{name} = [\"{x}\", \"{y}\", \"{z}\"]"));
        keys.push(format!("{name}_unit = \"{}\"", unit.symbol()));
    }
    Some(stated(&keys))
}

/// The unit that gravity suggests.
fn accelerometer_unit(reading: &[f64]) -> ImuUnit {
    match reading.iter().map(|value| value * value).sum::<f64>().sqrt() {
        magnitude if magnitude > 200.0 => ImuUnit::Counts,
        magnitude if (0.5..2.0).contains(&magnitude) => ImuUnit::StandardGravity,
        _ => ImuUnit::MetrePerSecondSquared,
    }
}
