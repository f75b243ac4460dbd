//! Numbers in a C header: written as constants, and read back by name.

use calibrant_core::error::{InputError, Refusal};
use calibrant_recording::text::decoding::Checked;
use nalgebra::{Matrix3, Vector3};

/// The remedy for a broken header.
pub(super) const HELP: &str = "give a header that calibrant wrote, as it wrote it";

pub(super) fn vector(values: &Vector3<f64>) -> String {
    format!("{{ {:?}, {:?}, {:?} }}", values.x, values.y, values.z)
}

pub(super) fn matrix(values: &Matrix3<f64>) -> String {
    let row = |i: usize| vector(&values.row(i).transpose());
    format!("{{\n    {},\n    {},\n    {},\n}}", row(0), row(1), row(2))
}

/// The numbers of a constant, between its braces; `None` where there is no such constant.
pub(super) fn numbers(text: &str, name: &str, count: usize) -> Checked<Option<Vec<f64>>> {
    read_constant(text, &format!("{name}[3]"), count)
}

/// The two numbers of a constant with two.
pub(super) fn pair(text: &str, name: &str) -> Checked<Option<[f64; 2]>> {
    Ok(read_constant(text, &format!("{name}[2]"), 2)?.map(|found| [found[0], found[1]]))
}

/// The number of a constant with one number.
pub(super) fn number(text: &str, name: &str) -> Checked<Option<f64>> {
    Ok(read_constant(text, &format!("CALIBRANT_REAL {name} ="), 1)?.map(|found| found[0]))
}

fn read_constant(text: &str, name: &str, count: usize) -> Checked<Option<Vec<f64>>> {
    let Some(start) = text.find(name) else { return Ok(None) };
    let name = name.trim_end_matches("[3]");
    let line = 1 + text[..start].matches('\n').count();
    let reject = |message: String| {
        Err(Box::new(InputError::new(Refusal::CalibrationInvalid, message, HELP).at_line(line)))
    };
    let Some((value, _)) = text[start..].split_once('=').and_then(|(_, rest)| rest.split_once(';')) else {
        return reject(format!("`{name}` has no value"));
    };
    let mut numbers = Vec::with_capacity(count);
    for word in value
        .split(|c: char| c.is_whitespace() || matches!(c, '{' | '}' | ','))
        .filter(|word| !word.is_empty())
    {
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => numbers.push(number),
            _ => return reject(format!("`{name}`: not a number: {word}")),
        }
    }
    if numbers.len() != count {
        return reject(format!("`{name}` has {} numbers, not {count}", numbers.len()));
    }
    Ok(Some(numbers))
}
