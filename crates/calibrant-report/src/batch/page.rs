//! The sections of the page, in their order.

use super::sensors::Batch;
use super::summary::yield_box;
use super::tables;
use crate::figure::{code_bars, drifts, parameter_histograms};
use crate::html::Page;
use crate::report_context::About;

/// A batch of sensors as one HTML file: yield, the sensors that are not ok, the codes that occur most, and each parameter as a histogram and
/// over the order of the recordings.
///
/// The file is self-contained, as [`Sheet::html`](crate::Sheet::html) is. Equal batches give equal pages.
///
/// # References
/// `iso7870_2` (the control limits)
#[must_use]
pub fn batch_report(batch: &Batch, about: &About) -> String {
    let title = if about.title.is_empty() { "Batch" } else { &about.title };
    let page = Page::of_parts([
        &|| opening(batch, title, about),
        &|| distributions(batch),
        &|| order(batch),
        &|| all_sensors(batch),
    ]);
    let footer = vec![
        about.made(),
        "Values are of the readings: true → raw. sd is the standard deviation.".to_owned(),
    ];
    page.finish(title, &about.facts, &footer)
}

fn opening(batch: &Batch, title: &str, about: &About) -> Page {
    let mut page = Page::opened(title, yield_box(batch, about));
    if let Some((table, further)) = tables::not_ok(batch) {
        page.section(
            "Sensors that are not ok",
            "The worst are first. A name leads to the page of the sensor.",
        );
        page.push(table);
        if further > 0 {
            page.paragraph(&format!("{further} more are in summary.csv."));
        }
    }
    if let Some(bars) = code_bars(batch) {
        page.section(
            "Causes",
            "The diagnostics that occur most. Those that are allowed, and notes, are left out.",
        );
        page.push(bars);
    }
    page
}

fn distributions(batch: &Batch) -> Page {
    let mut page = Page::default();
    let figures = parameter_histograms(batch);
    if !figures.is_empty() {
        page.section("Distribution of the parameters", "Each parameter over the sensors that have a result.");
        figures.iter().for_each(|figure| page.push(figure.html()));
    }
    page
}

fn order(batch: &Batch) -> Page {
    let mut page = Page::default();
    let drift = drifts(batch);
    if drift.figures.is_empty() {
        return page;
    }
    page.section(
        "Parameters over the order of the recordings",
        "Sensors differ at random. A trend or a step from one sensor to the next is a change of the station: of its temperature, its level, or its reference.",
    );
    drift.findings.iter().for_each(|sentence| page.paragraph(sentence));
    drift.figures.iter().for_each(|figure| page.push(figure.html()));
    page
}

fn all_sensors(batch: &Batch) -> Page {
    let mut page = Page::default();
    if !batch.sensors.is_empty() {
        page.section(
            "All sensors",
            "In the order of the recordings. The order is the x axis of the figures above.",
        );
        page.push(tables::all(batch));
    }
    page
}
