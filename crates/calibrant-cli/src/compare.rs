//! `calibrant compare`: compares two calibrations, whatever their conventions.

use crate::calibration_file::{Reading, in_words};
use crate::{Exit, console};
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::estimate::{ComparedQuantity, Comparison};
use calibrant::io::{ComparisonFile, to_json};
use calibrant::report::number_format;
use calibrant::sensor::InvariantValue;
use std::path::PathBuf;

/// Compare two calibrations by quantities that do not depend on the true frame: gains, angles between axes, biases, g-sensitivity.
///
/// Each file is in a format that `calibrant convert` reads, or the truth.json of a simulation, whose values are exact. With a covariance, the
/// difference is also given in standard deviations, and as one χ² of all parameters.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The first calibration.
    a: PathBuf,
    /// The second.
    b: PathBuf,
    #[command(flatten)]
    reading: Reading,
    /// Print JSON instead of the table.
    #[arg(long)]
    json: bool,
}

impl crate::run::Run for Arguments {
    fn run(&self) -> calibrant::Result<Exit> {
        run(self)
    }
}

fn run(arguments: &Arguments) -> calibrant::Result<Exit> {
    let (a, b) = (arguments.reading.read(&arguments.a)?.imu, arguments.reading.read(&arguments.b)?.imu);
    let comparison = Comparison::of(&a, &b);
    if comparison.quantities.is_empty() {
        let message = format!(
            "{} and {} have no sensor in common: {}; {}",
            arguments.a.display(),
            arguments.b.display(),
            in_words(&a),
            in_words(&b)
        );
        return Err(Error::Experiment(Box::new(InputError::new(
            Refusal::CalibrationUnsuited,
            message,
            "compare calibrations of one sensor",
        ))));
    }
    let (name_a, name_b) = (arguments.a.display().to_string(), arguments.b.display().to_string());
    if arguments.json {
        console::print_always(&to_json(&ComparisonFile { comparison: &comparison, a: &name_a, b: &name_b }));
        return Ok(Exit::DONE);
    }
    console::print(&format!("A: {name_a} ({})\nB: {name_b} ({})\n\n", in_words(&a), in_words(&b)));
    let rows: Vec<_> = comparison.quantities.iter().map(row).collect();
    let header = ["quantity", "A", "B", "B − A", "in sd", "p", "unit"];
    console::print(&console::table(&header, &rows));
    if let Some(overall) = comparison.overall {
        let verdict = if overall.p_value < 0.01 {
            "they differ by more than their uncertainties explain"
        } else {
            "their uncertainties explain the difference"
        };
        let behind = match overall.degrees_behind {
            behind if behind.is_finite() => {
                format!(
                    "; the least known scatter has {} degrees of freedom",
                    number_format::significant(behind, 2)
                )
            }
            _ => String::new(),
        };
        console::print(&format!(
            "  all parameters together: {verdict}; χ² {} with {} degrees of freedom, p-value {}{behind}\n",
            number_format::significant(overall.chi2, 5),
            number_format::count(overall.degrees_of_freedom),
            number_format::probability(overall.p_value)
        ));
    }
    for note in &comparison.notes {
        console::note(note);
    }
    Ok(Exit::DONE)
}

/// A row of the table, angles in degrees.
fn row(quantity: &ComparedQuantity) -> Vec<String> {
    let is_angle = quantity.unit_a == "rad";
    let scale = if is_angle { 1f64.to_degrees() } else { 1.0 };
    let value = |value: &InvariantValue| match value.sd {
        Some(sd) => number_format::with_sd(scale * value.value, scale * sd),
        None => number_format::significant(scale * value.value, 8),
    };
    let unit = match (is_angle, quantity.unit_a == quantity.unit_b) {
        (true, _) => "°".to_owned(),
        (false, true) => quantity.unit_a.to_owned(),
        (false, false) => format!("{} | {}", quantity.unit_a, quantity.unit_b),
    };
    // a difference by rounding does not count
    let rounding = 1e-12 * quantity.a.value.abs().max(quantity.b.value.abs());
    let equal = quantity.difference.is_some_and(|difference| difference.abs() <= rounding);
    let [difference, in_sd] =
        [quantity.difference, quantity.in_sd].map(|found| found.map(|found| if equal { 0.0 } else { found }));
    let dash = || "–".to_owned();
    let in_digits = |difference: f64| match quantity.sd {
        Some(sd) if scale * sd >= 1e-5 && difference != 0.0 => {
            number_format::rounded_to(scale * difference, scale * sd)
        }
        Some(_) => number_format::significant(scale * difference, 2),
        None => number_format::significant(scale * difference, 3),
    };
    let p_value = quantity.p_value.map(|p_value| if equal { 1.0 } else { p_value });
    vec![
        quantity.invariant.name(),
        value(&quantity.a),
        value(&quantity.b),
        difference.map_or_else(dash, in_digits),
        in_sd.map_or_else(dash, |in_sd| number_format::signed(in_sd, 1)),
        p_value.map_or_else(dash, number_format::probability),
        unit,
    ]
}
