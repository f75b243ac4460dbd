//! `calibrant records fleet`: how the parameters differ from sensor to sensor.

use crate::console;
use crate::exit::Exit;
use calibrant::io::to_json;
use calibrant::records::{Fleet, FleetParameter, Records};
use calibrant::report::number_format::{counted, rounded_to, short, signed, significant};
use std::path::PathBuf;

/// The most sensors that are named as left out. JSON has all.
const MOST_LEFT_OUT: usize = 10;

/// Show the distribution of each parameter over all sensors, and the sensors that are farthest off.
///
/// The latest calibration of each sensor counts, unless it is bad. All are brought to the gauge and the reference temperature of the first.
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
        let fleet = Records::open_existing(&self.records)?.fleet()?;
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
        let rows = || fleet.parameters.iter().map(row).collect::<Vec<_>>();
        console::json_or(self.json, || to_json(&fleet), || console::table(&header, &rows()) + &about(&fleet));
        Ok(Exit::DONE)
    }
}

/// The frame and the temperature of the parameters, and the sensors that are not among them.
fn about(fleet: &Fleet) -> String {
    let facts = [
        fleet.gauge.map(|gauge| format!("{} gauge", gauge.name())),
        fleet.reference_c.map(|reference_c| format!("at {} °C", short(reference_c))),
        (fleet.without_temperature > 0).then(|| {
            format!(
                "{} without temperature terms at the temperature of its recording",
                counted(fleet.without_temperature, "sensor")
            )
        }),
    ];
    let facts: Vec<String> = facts.into_iter().flatten().collect();
    let mut text = if facts.is_empty() { String::new() } else { format!("\n{}\n", facts.join(", ")) };
    if !fleet.left_out.is_empty() {
        text.push_str(&format!("\n{} left out:\n", counted(fleet.left_out.len(), "sensor")));
    }
    for out in fleet.left_out.iter().take(MOST_LEFT_OUT) {
        text.push_str(&format!("  {} (calibration {}): {}\n", out.sensor, out.id, out.reason));
    }
    let further = fleet.left_out.len().saturating_sub(MOST_LEFT_OUT);
    if further > 0 {
        text.push_str(&format!("  and {further} more\n"));
    }
    text
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
        parameter.unit.to_owned(),
    ]
}
