//! The sections of the sheet, in their order.

use super::capability::capability;
use super::causes;
use super::sensors::Batch;
use super::summary::yield_of;
use super::tables;
use crate::figure::{SENSORS, code_bars, drifts, parameter_histograms};
use crate::number_format::capitalised;
use crate::report_context::About;
use crate::sheet::{Section, Sheet};
use std::collections::BTreeMap;

/// What a value is.
const MEANING: &str = "Values are of the readings: true → raw. sd is the standard deviation.";

/// A batch of sensors as a sheet: yield, the codes that occur most, the sensors that are not ok, and each parameter as a histogram and
/// over the order of the recordings. It leads to `summary.csv` beside it.
///
/// # References
/// `iso7870_2` (the control limits), `iso22514` (the capability)
#[must_use]
pub fn batch_sheet<'a>(batch: &'a Batch, about: &'a About) -> Sheet<'a> {
    let sections = [
        causes_of(batch),
        Some(worst(batch)),
        scatter(batch),
        distributions(batch),
        order(batch),
        all_sensors(batch),
    ];
    let sheet =
        about.sheet("Batch", yield_of(batch, about), sections.into_iter().flatten().collect(), MEANING);
    Sheet { head: head(batch), ..sheet }
}

/// Stations, each with the number of its sensors, and the first and the last date, where they are known.
fn head(batch: &Batch) -> Vec<(String, String)> {
    let mut stations: BTreeMap<&str, usize> = BTreeMap::new();
    batch
        .sensors
        .iter()
        .filter_map(|of| of.station.as_deref())
        .for_each(|of| *stations.entry(of).or_default() += 1);
    let stations: Vec<String> = stations.iter().map(|(name, count)| format!("{name} ({count})")).collect();
    let dates = || batch.sensors.iter().filter_map(|of| of.recorded.as_deref());
    let recorded = match (dates().min(), dates().max()) {
        (Some(first), Some(last)) if first != last => format!("{first} to {last}"),
        (first, _) => first.unwrap_or_default().to_owned(),
    };
    let facts = [("Stations", stations.join(", ")), ("Recorded", recorded)];
    let known = facts.into_iter().filter(|(_, fact)| !fact.is_empty());
    known.map(|(label, fact)| (label.to_owned(), fact)).collect()
}

/// The worst first. Pages show those that are not ok, terminals the first of all.
fn worst(batch: &Batch) -> Section<'_> {
    let (table, further) = tables::worst_first(batch);
    let mut section = match further.not_ok {
        0 => Section::new(""),
        _ => Section::new("Sensors that are not ok")
            .lead("The worst are first. A name leads to the page of the sensor.")
            .on_terminal(""),
    };
    section.table(table);
    let more = if further.on_page > 0 { format!("{} more, and ", further.on_page) } else { String::new() };
    section.drawn(move || {
        let lead = capitalised(&format!("{more}all numbers of all sensors are in"));
        format!("<p>{lead} <a href=\"summary.csv\">summary.csv</a>.</p>")
    });
    if further.on_terminal > 0 {
        section.line(format!("… and {} more", further.on_terminal));
    }
    section
}

fn causes_of(batch: &Batch) -> Option<Section<'_>> {
    let causes = causes::causes(batch);
    if causes.is_empty() {
        return None;
    }
    let mut section = Section::on_page("Causes").lead(
        "Why sensors have no result, or one that is bad or doubtful. Allowed codes, and notes, are left out.",
    );
    let table = causes::table(batch, &causes);
    section.figure(move || code_bars(batch, &causes));
    section.table(table);
    Some(section)
}

fn scatter(batch: &Batch) -> Option<Section<'_>> {
    let table = capability(batch);
    let some = !table.is_empty();
    let mut section = Section::on_page("Scatter of the parameters")
        .lead("Control limits are the mean ± 2.66 times the mean difference of neighbours. Sensors whose calibration is bad by itself are left out; those that only break an acceptance limit are not.");
    section.table(table);
    some.then_some(section)
}

fn distributions(batch: &Batch) -> Option<Section<'_>> {
    let figures = parameter_histograms(batch);
    let mut section = Section::on_page("Distribution of the parameters")
        .lead("Each parameter over the sensors that have a result.");
    let some = !figures.is_empty();
    figures.into_iter().for_each(|figure| section.figure(move || Some(figure.clone())));
    some.then_some(section)
}

fn order(batch: &Batch) -> Option<Section<'_>> {
    let drift = drifts(batch);
    let mut section = Section::on_page("Parameters over the order of the recordings").lead(
        "Sensors differ at random. A trend or a step from one sensor to the next is a change of the station: of its temperature, its level, or its reference.",
    );
    let some = !drift.figures.is_empty();
    drift.findings.into_iter().for_each(|sentence| section.paragraph(sentence));
    drift.figures.into_iter().for_each(|figure| section.figure(move || Some(figure.clone())));
    some.then_some(section)
}

fn all_sensors(batch: &Batch) -> Option<Section<'_>> {
    let mut section = Section::on_page(SENSORS)
        .lead("In the order of the recordings. The order is the x axis of the figures above.");
    section.table(tables::all(batch));
    (!batch.sensors.is_empty()).then_some(section)
}
