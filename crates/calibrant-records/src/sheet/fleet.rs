//! How the parameters differ from sensor to sensor.

use crate::fleet::{Fleet, FleetParameter, LeftOut};
use calibrant_report::number_format::{counted, short, signed};
use calibrant_report::{Cell, Digits, Section, Sheet, Table};

/// The most sensors that are named as left out.
const MOST_LEFT_OUT: usize = 10;

/// The fleet as a sheet: the distribution of each parameter, the frame and the temperature, and the sensors that are left out.
#[must_use]
pub fn fleet_sheet(fleet: &Fleet) -> Sheet<'static> {
    let mut parameters = Section::default();
    let mut table = Table::new([
        "parameter",
        "sensors",
        "mean",
        "sd",
        "unit",
        "5 %",
        "median",
        "95 %",
        "sd of a calibration",
        "farthest",
    ]);
    fleet.parameters.iter().for_each(|parameter| table.row(row(parameter)));
    parameters.table(table);
    let facts = frame(fleet);
    if !facts.is_empty() {
        parameters.paragraph(facts.join(", "));
    }
    let mut sections = vec![parameters];
    if !fleet.left_out.is_empty() {
        sections.push(left_out(&fleet.left_out));
    }
    Sheet { title: "Fleet".into(), sections, ..Sheet::default() }
}

/// The frame and the temperature of the parameters.
fn frame(fleet: &Fleet) -> Vec<String> {
    let without = fleet.without_temperature;
    let facts = [
        fleet.gauge.map(|gauge| format!("{} gauge", gauge.name())),
        fleet.reference_c.map(|reference_c| format!("at {} °C", short(reference_c))),
        (without > 0).then(|| {
            let sensors = counted(without, "sensor");
            format!("{sensors} without temperature terms at the temperature of its recording")
        }),
    ];
    facts.into_iter().flatten().collect()
}

/// The sensors that are not among them.
fn left_out(sensors: &[LeftOut]) -> Section<'static> {
    let mut section = Section::new(format!("{} left out", counted(sensors.len(), "sensor")));
    let named = |out: &LeftOut| format!("{} (calibration {}): {}", out.sensor, out.id, out.reason);
    section.list(sensors.iter().take(MOST_LEFT_OUT).map(named).collect());
    let further = sensors.len().saturating_sub(MOST_LEFT_OUT);
    if further > 0 {
        section.paragraph(format!("and {further} more"));
    }
    section
}

fn row(parameter: &FleetParameter) -> Vec<Cell> {
    let of = &parameter.values;
    let digits = if of.sd > 0.0 { Digits::RoundedTo(of.sd) } else { Digits::Short };
    let number = |value: f64| Cell::Value { value, digits };
    let farthest = parameter.farthest.first();
    vec![
        Cell::name(&parameter.name),
        Cell::count(of.sensors),
        number(of.mean),
        Cell::significant(of.sd, 2),
        Cell::unit(parameter.unit),
        number(of.quantile_05),
        number(of.median),
        number(of.quantile_95),
        parameter.calibration_sd.map_or(Cell::Missing, |sd| Cell::significant(sd, 2)),
        farthest.map_or(Cell::Missing, |far| {
            Cell::Text(format!("{} ({} sd)", far.sensor, signed(far.in_robust_sd, 1)))
        }),
    ]
}
