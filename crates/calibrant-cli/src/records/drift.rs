//! `calibrant records drift`: what changes from calibration to calibration, and per year.

use crate::console;
use crate::exit::Exit;
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::estimate::ComparedQuantity;
use calibrant::io::to_json;
use calibrant::records::QuantityAging;
use calibrant::records::{Records, SensorChange, SensorDrift, SensorHistory};
use calibrant::report::number_format;
use std::path::PathBuf;

/// The most sensors that the table shows. JSON has all.
const MOST_ROWS: usize = 20;
/// A change of this probability is called significant.
const SIGNIFICANT: f64 = 0.01;

/// Show how a sensor changes from calibration to calibration, and per year. Without a sensor: which sensors changed most.
///
/// Changes are compared as by `calibrant compare`. The aging is a line through the dated calibrations that are not bad, by weighted least squares.
/// Where they scatter by more than their standard deviations, that of the aging is widened by the Birge ratio.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The records.
    records: PathBuf,
    /// The sensor.
    sensor: Option<String>,
    /// Print JSON instead of the tables.
    #[arg(long)]
    json: bool,
}

impl Arguments {
    pub(super) fn run(&self) -> calibrant::Result<Exit> {
        let records = Records::open_existing(&self.records)?;
        match &self.sensor {
            Some(sensor) => {
                let history = records.history(sensor)?;
                if history.calibrations.is_empty() {
                    let message = format!("there is no calibration of sensor {sensor:?}");
                    let help = "`calibrant records list` shows the sensors";
                    let error = InputError::new(Refusal::ValueInvalid, message, help).in_file(&self.records);
                    return Err(Error::experiment(error));
                }
                console::json_or(self.json, || to_json(&history), || of_sensor(&history));
            }
            None => {
                let drifts = records.drifts()?;
                console::json_or(self.json, || to_json(&drifts), || of_all(&drifts));
            }
        }
        Ok(Exit::DONE)
    }
}

fn of_sensor(history: &SensorHistory) -> String {
    let mut text = format!(
        "sensor {}: {}, {} with a date and not bad\n\n",
        history.sensor,
        number_format::counted(history.calibrations.len(), "calibration"),
        history.aging_from
    );
    let rows = history.calibrations.iter().map(|kept| {
        let change = history.changes.iter().find(|change| change.to == kept.id);
        let mut row = vec![
            kept.id.to_string(),
            kept.record.recorded.map_or_else(dash, |time| time.to_string()),
            kept.record.verdict.name().to_owned(),
        ];
        row.extend(change.map_or_else(|| [dash(), dash(), dash()].into(), changed));
        row
    });
    let rows: Vec<_> = rows.collect();
    text.push_str(&console::table(
        &["id", "recorded", "verdict", "χ² of the change", "p", "largest change"],
        &rows,
    ));
    if history.aging.is_empty() {
        return text + "\nno aging: it needs two calibrations of different dates\n";
    }
    text.push_str("\naging\n");
    let rows: Vec<_> = history.aging.iter().map(aged).collect();
    text + &console::table(&["quantity", "per year", "in sd", "p", "Birge ratio", "unit"], &rows)
}

/// χ² with its degrees of freedom, probability, and the quantity that changed most.
fn changed(change: &SensorChange) -> Vec<String> {
    let overall = change.comparison.overall;
    let in_sd = |quantity: &ComparedQuantity| quantity.in_sd.map_or(0.0, f64::abs);
    let largest =
        change.comparison.quantities.iter().max_by(|one, other| in_sd(one).total_cmp(&in_sd(other)));
    vec![
        overall.map_or_else(dash, |overall| {
            format!("{} ({})", number_format::significant(overall.chi2, 3), overall.degrees_of_freedom)
        }),
        overall.map_or_else(dash, |overall| number_format::probability(overall.p_value)),
        largest.filter(|largest| in_sd(largest) > 0.0).map_or_else(dash, |largest| {
            format!(
                "{} {} sd",
                largest.invariant.name(),
                number_format::signed(largest.in_sd.unwrap_or(0.0), 1)
            )
        }),
    ]
}

fn aged(of: &QuantityAging) -> Vec<String> {
    let aging = &of.aging;
    let [per_year, unit] = per_year(of);
    vec![
        of.invariant.name(),
        per_year,
        number_format::signed(aging.per_year / aging.sd, 1),
        number_format::probability(aging.p_value),
        aging.birge_ratio.map_or_else(dash, |ratio| format!("{ratio:.2}")),
        unit,
    ]
}

/// The change per year with its standard deviation, and the unit. Angles are in degrees.
fn per_year(QuantityAging { unit, aging, .. }: &QuantityAging) -> [String; 2] {
    let (scale, unit) = if *unit == "rad" { (1f64.to_degrees(), "°") } else { (1.0, *unit) };
    [number_format::with_sd(scale * aging.per_year, scale * aging.sd), unit.to_owned()]
}

fn of_all(drifts: &[SensorDrift]) -> String {
    if drifts.is_empty() {
        return "no sensor has two calibrations to compare\n".to_owned();
    }
    let row = |drift: &SensorDrift| {
        let (change, aging) = (drift.last_change, drift.largest_aging.as_ref());
        let [per_year, unit] = aging.map_or_else(|| [dash(), dash()], per_year);
        vec![
            drift.sensor.clone(),
            drift.calibrations.to_string(),
            drift.dates.map_or_else(dash, |[first, last]| format!("{first} to {last}")),
            change.map_or_else(dash, |change| number_format::probability(change.p_value)),
            aging.map_or_else(dash, |of| of.invariant.name()),
            per_year,
            unit,
            drift.aging_p_value.map_or_else(dash, number_format::probability),
        ]
    };
    let header = [
        "sensor",
        "calibrations",
        "recorded",
        "p of the last change",
        "largest aging",
        "per year",
        "unit",
        "p of the aging",
    ];
    let mut text = console::table(&header, &drifts.iter().take(MOST_ROWS).map(row).collect::<Vec<_>>());
    let further = drifts.len().saturating_sub(MOST_ROWS);
    if further > 0 {
        text.push_str(&format!("  and {further} more\n"));
    }
    let significant = |p_value: fn(&SensorDrift) -> Option<f64>| {
        let known = drifts.iter().filter_map(p_value);
        let (all, below) =
            known.fold((0, 0), |(all, below), p| (all + 1, below + usize::from(p < SIGNIFICANT)));
        format!(
            "{below} of {all}, where chance alone gives {}",
            number_format::short(SIGNIFICANT * all as f64)
        )
    };
    text + &format!(
        "\np below {SIGNIFICANT}: last change {}; aging {}\n",
        significant(|drift| drift.last_change.map(|change| change.p_value)),
        significant(|drift| drift.aging_p_value)
    )
}

fn dash() -> String {
    "–".to_owned()
}
