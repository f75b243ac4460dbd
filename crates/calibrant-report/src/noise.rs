//! The noise of a sensor at rest: a page of its own, and a section for the pages of calibrations.

use super::figure::allan_figure;
use super::report_context::{About, READINGS};
use crate::number_format::{capitalised, count, fixed, significant, with_sd};
use crate::sheet::{Cell, Column, Grade, Section, Sheet, SheetVerdict, Table};
use calibrant_core::noise::{
    AxisNoise, Coefficient, CoefficientUnit, PowerLaw, SensorNoise, coefficient_units, noise_line,
};

/// Samples are disturbed if they scatter by more than this factor times white noise.
const DISTURBED: f64 = 1.05;
/// Samples are correlated if they scatter by less than this factor times white noise.
const FILTERED: f64 = 0.95;

/// The noise of one or two sensors as a sheet: verdict, Allan deviation plots, tables in SI and in customary units.
///
/// `examined` names the part of the recording that was examined, where that is not nearly all of it.
#[must_use]
pub fn noise_sheet<'a>(noise: &'a [SensorNoise], examined: Option<&str>, about: &'a About) -> Sheet<'a> {
    let sections = noise.iter().map(|sensor| with_line(noise_section(sensor, examined), sensor));
    about.sheet("Noise", verdict(noise, about), sections.collect(), READINGS)
}

/// A section on each sensor: its figure, coefficients, samples.
pub(super) fn noise_sections(noise: &[SensorNoise]) -> Vec<Section<'_>> {
    noise.iter().map(|sensor| noise_section(sensor, None)).collect()
}

fn noise_section<'a>(noise: &'a SensorNoise, examined: Option<&str>) -> Section<'a> {
    let segment = &noise.segment;
    let mut section = Section::new(format!("Noise of the {}", noise.sensor_kind));
    section.paragraph(format!(
        "From {} samples, {} to {} s, at {} Hz.",
        count(segment.samples()),
        fixed(segment.start_s, 2),
        fixed(segment.end_s, 2),
        significant(segment.rate_hz(), 5)
    ));
    examined.into_iter().for_each(|words| section.line(words));
    section.table(coefficient_table(noise));
    section.list(reasons(noise));
    section.figure(|| Some(allan_figure(noise)));
    section.subheading("White noise of one sample");
    section.table(sample_table(noise));
    section
}

/// With the line of an experiment file, which stands alone to be copied; or why there is none.
fn with_line<'a>(mut section: Section<'a>, noise: &SensorNoise) -> Section<'a> {
    match (noise_line(noise), &noise.caveat) {
        (_, Some(caveat)) => {
            section.paragraph(format!("No noise for an experiment file. {}", caveat.sentence()));
        }
        (None, None) => {
            section.paragraph("No noise for an experiment file: white noise is not determined on all axes.")
        }
        (Some(found), None) => {
            section.paragraph(format!("For an experiment file, in [{}]:", found.section));
            section.paragraph(found.line);
            if !noise.explains() {
                section.paragraph(
                    "(The model does not explain the noise: read the warnings before you use it.)",
                );
            }
        }
    }
    section
}

fn coefficient_name(noise: &SensorNoise, process: PowerLaw) -> &'static str {
    use calibrant_core::sensor::SensorKind;
    match (process, noise.sensor_kind) {
        (PowerLaw::Quantisation, _) => "quantisation Q",
        (PowerLaw::White, SensorKind::Accelerometer) => "velocity random walk N",
        (PowerLaw::White, SensorKind::Gyroscope) => "angle random walk N",
        (PowerLaw::Flicker, _) => "bias instability B",
        (PowerLaw::RandomWalk, _) => "rate random walk K",
    }
}

const PROCESSES: [PowerLaw; 4] =
    [PowerLaw::White, PowerLaw::Flicker, PowerLaw::RandomWalk, PowerLaw::Quantisation];

/// Each coefficient in SI and in customary units, with its interval or its upper limit.
fn coefficient_table(noise: &SensorNoise) -> Table {
    let mut table = Table::new(["coefficient", "value ± sd", "unit", "95 %", "customary"]);
    for process in PROCESSES {
        for axis in &noise.axes {
            let name = format!("{} {}", coefficient_name(noise, process), axis.axis);
            let [value, unit, interval, customary] = coefficient(noise, axis, process);
            table.row(vec![Cell::Name(name), value, unit, interval, customary]);
        }
    }
    table
}

fn coefficient(noise: &SensorNoise, axis: &AxisNoise, process: PowerLaw) -> [Cell; 4] {
    let units = coefficient_units(noise.sensor_kind, process, noise.unit);
    let (unit, others) = (Cell::unit(units[0].symbol), &units[1..]);
    match axis.fit.model.coefficient(process) {
        Coefficient::Determined(found) => {
            let [low, high] = [found.low, found.high].map(|end| significant(end, 3));
            let mut words: Vec<String> = others
                .iter()
                .map(|unit| {
                    let found = found.scaled(unit.factor);
                    format!("{} {}", with_sd(found.value, found.sd), unit.symbol)
                })
                .collect();
            if let (PowerLaw::Flicker, Some(tau)) = (process, axis.fit.flat_tau_s) {
                words.push(format!("clearest at {} s", significant(tau, 2)));
            }
            let interval = Cell::Number(format!("{low} to {high}"));
            [Cell::estimate(found.value, found.sd), unit, interval, in_short(&words)]
        }
        Coefficient::NotDetermined { limit, .. } => {
            let below = |limit: f64| format!("< {}", significant(limit, 2));
            let in_unit = |unit: &CoefficientUnit| {
                limit.map(|limit| format!("{} {}", below(unit.factor * limit), unit.symbol))
            };
            let words: Vec<String> = others.iter().filter_map(in_unit).collect();
            let limit = limit.map_or(Cell::Missing, |limit| Cell::Number(below(limit)));
            [Cell::Number("not determined".into()), unit, limit, in_short(&words)]
        }
    }
}

fn in_short(words: &[String]) -> Cell {
    if words.is_empty() { Cell::Missing } else { Cell::Words(words.join("; ")) }
}

/// Why coefficients are not determined, each reason once.
fn reasons(noise: &SensorNoise) -> Vec<String> {
    let mut reasons: Vec<(PowerLaw, &String, String)> = Vec::new();
    for process in PROCESSES {
        for axis in &noise.axes {
            let Coefficient::NotDetermined { reason, .. } = axis.fit.model.coefficient(process) else {
                continue;
            };
            match reasons.iter_mut().find(|(of, known, _)| *of == process && *known == reason) {
                Some((_, _, axes)) => axes.push_str(&format!(", {}", axis.axis)),
                None => reasons.push((process, reason, axis.axis.to_string())),
            }
        }
    }
    let in_words = |(process, reason, axes): &(PowerLaw, &String, String)| {
        capitalised(&format!("{} {axes} not determined: {reason}.", coefficient_name(noise, *process)))
    };
    reasons.iter().map(in_words).collect()
}

/// The white noise of one sample beside the scatter of the samples.
fn sample_table(noise: &SensorNoise) -> Table {
    let unit = noise.unit.symbol();
    let white = "the noise that a sample would have if it were independent of the others: the one that says how well a mean of many is known, and \
                 the one to calibrate with. Samples that scatter less are correlated, as after a filter; those that scatter more are disturbed by something that averages out";
    let mut table = Table::new([
        Column::new("axis"),
        Column::new("N √rate").in_unit(unit).noted(white),
        Column::new("sd of samples").in_unit(unit),
        Column::new("ratio"),
        Column::new("samples"),
    ]);
    for axis in &noise.axes {
        let sigma = axis.fit.model.white_noise_per_sample(noise.segment.rate_hz());
        let ratio = sigma.map(|sigma| axis.sample_sd / sigma);
        let shown = |value: Option<f64>| value.map_or(Cell::Missing, |value| Cell::significant(value, 3));
        let what = ratio.map_or(Cell::Missing, |ratio| {
            Cell::text(match ratio {
                ratio if ratio > DISTURBED => "disturbed",
                ratio if ratio < FILTERED => "correlated",
                _ => "independent",
            })
        });
        let [white, sd] = [sigma, Some(axis.sample_sd)].map(shown);
        table.row(vec![Cell::name(axis.axis.to_string()), white, sd, shown(ratio), what]);
    }
    table
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
    let warnings = noise.iter().flat_map(SensorNoise::diagnostics);
    let warnings = warnings.map(|found| found.message().to_owned()).collect();
    SheetVerdict::new(grade, word, sentence)
        .with("Warnings", warnings)
        .with("Findings", about.findings.clone())
}
