//! The sections of the sheet, in their order.

use super::sensors::Batch;
use super::summary::yield_of;
use super::tables;
use crate::figure::{code_bars, drifts, parameter_histograms};
use crate::report_context::About;
use crate::sheet::{Section, Sheet};

/// A batch of sensors as a sheet: yield, the sensors that are not ok, the codes that occur most, and each parameter as a histogram and
/// over the order of the recordings.
///
/// # References
/// `iso7870_2` (the control limits)
#[must_use]
pub fn batch_sheet<'a>(batch: &'a Batch, about: &'a About) -> Sheet<'a> {
    let sections =
        [Some(worst(batch)), causes(batch), distributions(batch), order(batch), all_sensors(batch)];
    Sheet {
        title: if about.title.is_empty() { "Batch".into() } else { about.title.clone() },
        verdict: Some(yield_of(batch, about)),
        sections: sections.into_iter().flatten().collect(),
        inputs: about.facts.clone(),
        footer: vec![
            About::made(),
            "Values are of the readings: true → raw. sd is the standard deviation.".to_owned(),
        ],
    }
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
    if further.on_page > 0 {
        section.explanation(format!("{} more are in summary.csv.", further.on_page));
    }
    if further.on_terminal > 0 {
        section.line(format!("… and {} more", further.on_terminal));
    }
    section
}

fn causes(batch: &Batch) -> Option<Section<'_>> {
    let bars = code_bars(batch)?;
    let mut section = Section::on_page("Causes")
        .lead("The diagnostics that occur most. Those that are allowed, and notes, are left out.");
    section.drawn(move || bars.clone());
    Some(section)
}

fn distributions(batch: &Batch) -> Option<Section<'_>> {
    let figures = parameter_histograms(batch);
    let mut section = Section::on_page("Distribution of the parameters")
        .lead("Each parameter over the sensors that have a result.");
    let some = !figures.is_empty();
    figures.into_iter().for_each(|figure| section.drawn(move || figure.html()));
    some.then_some(section)
}

fn order(batch: &Batch) -> Option<Section<'_>> {
    let drift = drifts(batch);
    let mut section = Section::on_page("Parameters over the order of the recordings").lead(
        "Sensors differ at random. A trend or a step from one sensor to the next is a change of the station: of its temperature, its level, or its reference.",
    );
    let some = !drift.figures.is_empty();
    drift.findings.into_iter().for_each(|sentence| section.paragraph(sentence));
    drift.figures.into_iter().for_each(|figure| section.drawn(move || figure.html()));
    some.then_some(section)
}

fn all_sensors(batch: &Batch) -> Option<Section<'_>> {
    let mut section = Section::on_page("All sensors")
        .lead("In the order of the recordings. The order is the x axis of the figures above.");
    section.table(tables::all(batch));
    (!batch.sensors.is_empty()).then_some(section)
}
