//! The noise of a sensor at rest: a page of its own, and a section for the pages of calibrations.

use super::About;
use super::figure::allan_figure;
use super::number_format;
use crate::sheet::{Cell, Grade, Section, Sheet, SheetVerdict, Table};
use crate::words::{capitalised, message};
use calibrant_core::noise::{AxisNoise, Coefficient, PowerLaw, SensorNoise, coefficient_units};

/// Samples are disturbed if they scatter by more than this factor times white noise.
const DISTURBED: f64 = 1.05;
/// Samples are correlated if they scatter by less than this factor times white noise.
const FILTERED: f64 = 0.95;

/// The noise of one or two sensors as a sheet: verdict, Allan deviation plots, tables in SI and in customary units.
#[must_use]
pub fn noise_sheet<'a>(noise: &'a [SensorNoise], about: &'a About) -> Sheet<'a> {
    Sheet {
        title: if about.title.is_empty() { "Noise".into() } else { about.title.clone() },
        verdict: Some(verdict(noise, about)),
        sections: noise_sections(noise),
        inputs: about.facts.clone(),
        footer: about.footer(),
    }
}

/// A section on each sensor: its figure, coefficients, samples.
pub(super) fn noise_sections(noise: &[SensorNoise]) -> Vec<Section<'_>> {
    noise.iter().map(noise_section).collect()
}

fn noise_section(noise: &SensorNoise) -> Section<'_> {
    let segment = &noise.segment;
    let mut section = Section::new(format!("Noise of the {}", noise.sensor_kind)).lead(format!(
        "From {} samples, {} to {} s, at {} Hz.",
        number_format::count(segment.samples()),
        number_format::fixed(segment.start_s, 2),
        number_format::fixed(segment.end_s, 2),
        number_format::significant(segment.rate_hz(), 5)
    ));
    section.table(coefficient_table(noise));
    section.figure(|| Some(allan_figure(noise)));
    section.subheading("White noise of one sample");
    sample_table(&mut section, noise);
    section
}

/// Name of a coefficient.
pub fn coefficient_name(noise: &SensorNoise, process: PowerLaw) -> &'static str {
    use calibrant_core::sensor::SensorKind;
    match (process, noise.sensor_kind) {
        (PowerLaw::Quantisation, _) => "quantisation Q",
        (PowerLaw::White, SensorKind::Accelerometer) => "velocity random walk N",
        (PowerLaw::White, SensorKind::Gyroscope) => "angle random walk N",
        (PowerLaw::Flicker, _) => "bias instability B",
        (PowerLaw::RandomWalk, _) => "rate random walk K",
    }
}

fn coefficient_table(noise: &SensorNoise) -> Table {
    let columns =
        ["", "value ± sd", "95 % interval, also in customary units; or the reason why it is not determined"];
    let mut table = Table::new(columns);
    for process in [PowerLaw::White, PowerLaw::Flicker, PowerLaw::RandomWalk, PowerLaw::Quantisation] {
        for axis in &noise.axes {
            let name = format!("{} {}", coefficient_name(noise, process), axis.axis);
            let (value, words) = coefficient_in_words(noise, axis, process);
            table.explain(&name, value, &words);
        }
    }
    table
}

/// A coefficient with its unit, and its interval or its reason.
fn coefficient_in_words(noise: &SensorNoise, axis: &AxisNoise, process: PowerLaw) -> (String, String) {
    let units = coefficient_units(noise.sensor_kind, process, noise.unit);
    let unit = units[0].symbol;
    match axis.fit.model.coefficient(process) {
        Coefficient::Determined(found) => {
            let ends = [found.low, found.high].map(|end| number_format::significant(end, 3));
            let mut words = vec![format!("95 %: {} to {}", ends[0], ends[1])];
            words.extend(units[1..].iter().map(|unit| {
                let found = found.scaled(unit.factor);
                format!("{} {}", number_format::with_sd(found.value, found.sd), unit.symbol)
            }));
            if let (PowerLaw::Flicker, Some(tau)) = (process, axis.fit.flat_tau_s) {
                words.push(format!("clearest at {} s", number_format::significant(tau, 2)));
            }
            (format!("{} {unit}", number_format::with_sd(found.value, found.sd)), words.join("; "))
        }
        Coefficient::NotDetermined { limit, reason } => {
            let limit = limit.map_or_else(String::new, |limit| {
                let limits: Vec<String> = units
                    .iter()
                    .map(|unit| {
                        format!("{} {}", number_format::significant(unit.factor * limit, 2), unit.symbol)
                    })
                    .collect();
                format!("95 %: below {}. ", limits.join(" = "))
            });
            ("not determined".to_string(), format!("{limit}{}.", capitalised(reason)))
        }
    }
}

/// The white noise of one sample beside the scatter of the samples.
fn sample_table(section: &mut Section<'_>, noise: &SensorNoise) {
    let unit = noise.unit.symbol();
    let (white, sd) = (format!("N √rate ({unit})"), format!("sd of samples ({unit})"));
    let mut table = Table::new(["axis", &white, &sd, "ratio", "samples"]);
    for axis in &noise.axes {
        let sigma = axis.fit.model.white_noise_per_sample(noise.segment.rate_hz());
        let ratio = sigma.map(|sigma| axis.sample_sd / sigma);
        let shown = |value: Option<f64>| {
            Cell::Number(value.map_or_else(
                || number_format::UNKNOWN.to_string(),
                |value| number_format::significant(value, 3),
            ))
        };
        let what = match ratio {
            None => number_format::UNKNOWN,
            Some(ratio) if ratio > DISTURBED => "disturbed",
            Some(ratio) if ratio < FILTERED => "correlated",
            Some(_) => "independent",
        };
        table.row(vec![
            Cell::Name(axis.axis.to_string()),
            shown(sigma),
            shown(Some(axis.sample_sd)),
            shown(ratio),
            Cell::Text(what.to_string()),
        ]);
    }
    section.table(table);
    section.explanation("N √rate is the noise that a sample would have if it were independent of the others: the one that says how well a mean of many is known, and \
                       the one to calibrate with. Samples that scatter less are correlated, as after a filter; those that scatter more are disturbed by something that averages out.");
}

fn verdict(noise: &[SensorNoise], about: &About) -> SheetVerdict {
    let axes = || noise.iter().flat_map(|sensor_kind| &sensor_kind.axes);
    let explained = axes().all(|axis| axis.fit.explains());
    let drifts = axes().any(|axis| axis.fit.drift.is_significant());
    let determined = |process: PowerLaw| {
        axes().filter(|axis| axis.fit.model.coefficient(process).estimate().is_some()).count()
    };
    let total = axes().count();
    let of = |process: PowerLaw, name: &str| match determined(process) {
        0 => format!("{name}: on no axis"),
        n if n == total => format!("{name}: on all axes"),
        n => format!("{name}: on {n} of {total} axes"),
    };
    let slow = determined(PowerLaw::Flicker) + determined(PowerLaw::RandomWalk);
    let doubtful = noise.iter().any(|sensor_kind| sensor_kind.caveat.is_some());
    let (grade, word) = match () {
        () if doubtful => (Grade::Bad, "✗ This is not only the noise of a sensor at rest."),
        () if !explained => (Grade::Bad, "✗ The model does not explain the noise."),
        () if drifts || determined(PowerLaw::White) < total => (Grade::Caution, "! Look closer."),
        () if slow == 0 => {
            (Grade::Caution, "! White noise is determined. The recording is too short for slow noise.")
        }
        () => (Grade::Good, "✓ White noise and slow noise are determined."),
    };
    let sentence = format!(
        "White noise (N): {}; {}; {}.",
        of(PowerLaw::White, "").trim_start_matches(": "),
        of(PowerLaw::Flicker, "bias instability (B)"),
        of(PowerLaw::RandomWalk, "rate random walk (K)")
    );
    let caveats = noise.iter().filter_map(|sensor_kind| {
        Some(format!("{}: {}", sensor_kind.sensor_kind, sensor_kind.caveat.as_ref()?))
    });
    let warnings = caveats
        .chain(noise.iter().flat_map(|sensor_kind| sensor_kind.warnings.iter().map(message)))
        .collect();
    SheetVerdict::new(grade, word, sentence)
        .with("Warnings", warnings)
        .with("Findings", about.findings.clone())
}
