//! `calibrant records fleet`: how the parameters differ from sensor to sensor.

use crate::{Exit, console};
use calibrant::io::{FleetParameter, Records, fleet_json};
use calibrant::report::number_format::{rounded_to, short, signed, significant};
use std::path::PathBuf;

/// Show the distribution of each parameter over all sensors, and the sensors that are farthest off.
///
/// The latest calibration of each sensor counts, unless it is bad.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The records.
    records: PathBuf,
    /// Print JSON instead of the table.
    #[arg(long)]
    json: bool,
}

impl Arguments {
    pub(super) fn run(&self) -> calibrant::Result<Exit> {
        let parameters = Records::open_existing(&self.records)?.fleet()?;
        if self.json {
            console::print_always(&fleet_json(&parameters));
            return Ok(Exit::DONE);
        }
        let header = [
            "parameter",
            "sensors",
            "mean",
            "sd",
            "5 %",
            "median",
            "95 %",
            "sd of a calibration",
            "farthest",
            "unit",
        ];
        console::print(&console::table(&header, &parameters.iter().map(row).collect::<Vec<_>>()));
        Ok(Exit::DONE)
    }
}

fn row(parameter: &FleetParameter) -> Vec<String> {
    let of = &parameter.values;
    let [_, low, median, high, _] = of.quantiles;
    let number = |value: f64| if of.sd > 0.0 { rounded_to(value, of.sd) } else { short(value) };
    let farthest = parameter.farthest.first();
    vec![
        parameter.name.clone(),
        of.count.to_string(),
        number(of.mean),
        significant(of.sd, 2),
        number(low),
        number(median),
        number(high),
        parameter.calibration_sd.map_or_else(|| "–".to_owned(), |sd| significant(sd, 2)),
        farthest.map_or_else(
            || "–".to_owned(),
            |(sensor, _, distance)| format!("{sensor} ({} sd)", signed(*distance, 1)),
        ),
        parameter.unit.clone(),
    ]
}
