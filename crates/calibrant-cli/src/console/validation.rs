//! Validation on stdout: the errors of a calibration on data that it did not use.

use super::table::table;
use calibrant::estimate::Validation;
use calibrant::report::{validation_heading, validation_rows, validation_sentences};

/// A table and its sentences for each validation.
pub(crate) fn validations(validations: &[Validation]) -> String {
    let mut text = String::new();
    for validation in validations {
        let (header, rows) = validation_rows(validation);
        let rows: Vec<Vec<String>> = rows.into_iter().map(Vec::from).collect();
        text.push_str(&format!(
            "\n  Validation: {}\n\n{}",
            validation_heading(validation),
            table(&header, &rows)
        ));
        validation_sentences(validation)
            .iter()
            .for_each(|sentence| text.push_str(&format!("  {sentence}\n")));
    }
    text
}
