//! The noise of a sensor at rest: a page of its own, and a section for the pages of calibrations.

use super::About;
use super::figure::allan_figure;
use super::html::{Page, escape, facts, verdict_box};
use super::number;
use super::table::{Cell, Table};
use crate::noise::{AxisNoise, Coefficient, PowerLaw, TriadNoise, coefficient_units};

/// The noise of one or two sensors as one HTML file: what is determined, the Allan deviation plots, tables in SI and in customary units.
///
/// Self-contained as [`calibration_report`](super::calibration_report) is.
#[must_use]
pub fn noise_report(noise: &[TriadNoise], about: &About) -> String {
    let mut page = Page::default();
    let title = if about.title.is_empty() { "Noise" } else { &about.title };
    page.push(format!("<h1>{}</h1>", escape(title)));
    page.push(facts(about.facts.iter().map(|(label, value)| (label.as_str(), value.as_str()))));
    page.push(verdict(noise, about));
    for triad in noise {
        noise_section(&mut page, triad);
    }
    page.finish(title, &about.footer())
}

/// The section on one sensor: plot, coefficients, samples.
pub(super) fn noise_section(page: &mut Page, noise: &TriadNoise) {
    let stretch = &noise.stretch;
    page.section(
        &format!("Noise of the {}", noise.triad),
        &format!(
            "From {} samples at rest, {} to {} s, at {} Hz.",
            number::count(stretch.samples()),
            number::significant(stretch.start_s, 5),
            number::significant(stretch.end_s, 5),
            number::significant(stretch.rate_hz(), 5)
        ),
    );
    page.push(allan_figure(noise).html());
    page.subsection("Coefficients");
    page.push(coefficient_table(noise));
    page.subsection("White noise of one sample");
    page.push(sample_table(noise));
}

/// Name of a coefficient.
pub fn coefficient_name(noise: &TriadNoise, process: PowerLaw) -> &'static str {
    use crate::sensor::Triad;
    match (process, noise.triad) {
        (PowerLaw::Quantisation, _) => "quantisation Q",
        (PowerLaw::White, Triad::Accelerometer) => "velocity random walk N",
        (PowerLaw::White, Triad::Gyroscope) => "angle random walk N",
        (PowerLaw::Flicker, _) => "bias instability B",
        (PowerLaw::RandomWalk, _) => "rate random walk K",
    }
}

fn coefficient_table(noise: &TriadNoise) -> String {
    let mut table = Table::new("", &["", "value ± sd", "95 % interval", "unit", "customary"]);
    let order = [PowerLaw::White, PowerLaw::Flicker, PowerLaw::RandomWalk, PowerLaw::Quantisation];
    for process in order {
        let units = coefficient_units(noise.triad, process, noise.unit);
        for axis in &noise.axes {
            let name = Cell::Name(format!("{} {}", coefficient_name(noise, process), axis.axis));
            let unit = Cell::Text(units[0].symbol.to_string());
            match axis.fit.model.coefficient(process) {
                Coefficient::Determined(found) => {
                    let mut customary: Vec<String> = units[1..]
                        .iter()
                        .map(|unit| {
                            format!(
                                "{} {}",
                                number::with_sd(unit.factor * found.value, unit.factor * found.sd),
                                unit.symbol
                            )
                        })
                        .collect();
                    if let (PowerLaw::Flicker, Some(tau)) = (process, axis.fit.flat_tau_s) {
                        customary.push(format!("clearest at {} s", number::significant(tau, 2)));
                    }
                    table.row(vec![
                        name,
                        Cell::Number(number::with_sd(found.value, found.sd)),
                        Cell::Number(format!(
                            "{} to {}",
                            number::significant(found.low, 3),
                            number::significant(found.high, 3)
                        )),
                        unit,
                        Cell::Words(customary.join("; ")),
                    ]);
                }
                Coefficient::NotDetermined { limit, reason } => table.row(vec![
                    name,
                    Cell::Number("not determined".to_string()),
                    Cell::Number(limit.map_or_else(
                        || number::UNKNOWN.to_string(),
                        |limit| format!("below {}", number::significant(limit, 2)),
                    )),
                    unit,
                    Cell::Words(capitalised(reason)),
                ]),
            }
        }
    }
    table.html()
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| format!("{}{}.", first.to_uppercase(), letters.as_str()))
}

fn sample_table(noise: &TriadNoise) -> String {
    let unit = noise.unit.symbol();
    let (white, sd) = (format!("σ = N √rate ({unit})"), format!("sd of the samples ({unit})"));
    let mut table = Table::new("", &["axis", &white, &sd, "ratio", "what it means"]);
    for axis in &noise.axes {
        let sigma = axis.fit.model.white_noise_per_sample(noise.stretch.rate_hz());
        let shown = |value: Option<f64>, digits| {
            Cell::Number(
                value.map_or_else(|| number::UNKNOWN.to_string(), |value| number::significant(value, digits)),
            )
        };
        table.row(vec![
            Cell::Name(axis.axis.to_string()),
            shown(sigma, 3),
            shown(Some(axis.sample_sd), 3),
            shown(sigma.map(|sigma| axis.sample_sd / sigma), 3),
            Cell::Words(meaning(axis, sigma).to_string()),
        ]);
    }
    table.html()
}

fn meaning(axis: &AxisNoise, sigma: Option<f64>) -> &'static str {
    match sigma.map(|sigma| axis.sample_sd / sigma) {
        None => "The white noise is not determined: use the samples' standard deviation.",
        Some(ratio) if ratio > 1.15 => {
            "The samples scatter more than their means: disturbances that average out fast. σ is what a mean of many samples has."
        }
        Some(ratio) if ratio < 0.87 => {
            "The samples scatter less than their means: they are correlated, as after a filter. σ is what a mean of many samples has."
        }
        Some(_) => "Both agree: the samples are independent.",
    }
}

fn verdict(noise: &[TriadNoise], about: &About) -> String {
    let axes = || noise.iter().flat_map(|triad| &triad.axes);
    let explained = axes().all(|axis| axis.fit.explains());
    let drifts = axes().any(|axis| axis.fit.drift.is_significant());
    let determined = |process: PowerLaw| {
        axes().filter(|axis| axis.fit.model.coefficient(process).estimate().is_some()).count()
    };
    let total = axes().count();
    let of = |process: PowerLaw, name: &str| match determined(process) {
        0 => format!("{name} on none"),
        n if n == total => format!("{name} on all axes"),
        n => format!("{name} on {n} of {total}"),
    };
    let (class, word) = match () {
        () if !explained => ("bad", "✗ Not explained."),
        () if drifts || determined(PowerLaw::White) < total => ("caution", "! Look closer."),
        () => ("good", "✓ The noise is determined as far as this recording goes."),
    };
    let sentence = format!(
        "Determined: {}; {}; {}.",
        of(PowerLaw::White, "white noise"),
        of(PowerLaw::Flicker, "bias instability"),
        of(PowerLaw::RandomWalk, "rate random walk")
    );
    let warnings = noise.iter().flat_map(|triad| triad.warnings.clone()).collect();
    verdict_box(class, word, &sentence, &[("Warnings", warnings), ("Findings", about.findings.clone())])
}
