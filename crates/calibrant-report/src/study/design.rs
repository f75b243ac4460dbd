//! The chapter on initial against optimal motions over many sensors: the thesis's chapter 4.

use super::settings::settings;
use crate::design::{axes, limit_table, motion_figures, times, uses};
use crate::figure::{DisplayUnit, Drawn, absolute_errors, confidence_ellipses, optimal_motions, traces};
use crate::number_format::{count, counted, percent, short, significant, with_sd};
use crate::sheet::{Cell, Column, Section, Table};
use calibrant_study::{DesignStudy, Factor, ParameterSummary};

/// Predicted and realised factors differ significantly beyond this number of standard errors, of many sensors.
const CHANCE: f64 = 3.0;
/// Fewer sensors do not tell their scatter.
const FEWEST: usize = 5;

/// The titles of a chapter and of its figures.
pub(super) struct Chapter {
    heading: &'static str,
    lead: &'static str,
    motion: &'static str,
    motions: &'static str,
    traces: &'static str,
    errors: &'static str,
}

pub(super) const OPTIMAL: Chapter = Chapter {
    heading: "Initial against optimal motion",
    lead: "Each sensor goes round a loop: calibrated on a random initial motion, the best motion designed at that \
           estimate, calibrated again on it. The loop is Figure 2 of the thesis.",
    motion: "Figure 8 of the thesis: initial against optimal jerk (a) and acceleration (b), first sensor",
    motions: "Figure 9 of the thesis: optimal motions on each axis",
    traces: "Figure 10 of the thesis: trace of the covariance, sensor by sensor",
    errors: "Figure 11 of the thesis: absolute errors of biases (a) and scale factors (b)",
};

pub(super) const NOISY: Chapter = Chapter {
    heading: "Initial against optimal motion, with process noise",
    lead: "The arm follows its command only up to noise on the jerk, which is estimated along with the parameters. Motions and figures are those of the \
           section before.",
    motion: "As Figure 8, with process noise: initial against optimal jerk (a) and acceleration (b), first sensor",
    motions: "As Figure 9, with process noise: optimal motions on each axis",
    traces: "Figure 13 of the thesis: trace of the covariance with process noise, sensor by sensor",
    errors: "Figure 14 of the thesis: absolute errors with process noise, of biases (a) and scale factors (b)",
};

/// One study with its tables and figures.
pub(super) fn chapter<'a>(study: &'a DesignStudy, chapter: &Chapter) -> Section<'a> {
    let mut section = Section::new(chapter.heading).lead(chapter.lead);
    section.table(settings(study));

    section.heading_on_page("Improvement");
    section.explanation(
        "Promised: standard deviations that the calibrations state (root mean square over the sensors). Realised: errors of the estimates (the same \
         mean). Factors are initial over optimal, above 1 is better, ± one standard error from so many sensors. Good: promised and realised \
         agree within their errors.",
    );
    section.line(format!(
        "{}, trust {}, initial against optimal motion, {} intervals, {} Hz, seed {}",
        counted(study.outcomes.len(), "sensor"),
        study.trust.name(),
        study.intervals,
        short(study.rate_hz),
        study.seed
    ));
    section.table(improvement_table(study));
    section.table(trace_table(study));

    let design = &study.design;
    let axes = axes(&study.parameters);
    let motions =
        [Drawn::before("initial", &design.initial.motion), Drawn::after("optimal", &design.optimal.motion)];
    let title = chapter.motion;
    section.drawn(move || motion_figures(title, &motions, axes, &study.limits));
    section.table(
        limit_table(&uses(&study.limits, &study.parameters, &design.optimal.motion), "optimal motion")
            .on_page(),
    );
    let (of_motions, of_traces, of_errors) = (chapter.motions, chapter.traces, chapter.errors);
    section.figure(move || (study.motions_shown > 1).then(|| optimal_motions(of_motions, study, axes)));
    section.figure(move || Some(traces(of_traces, study)));
    section.figure(move || Some(absolute_errors(of_errors, study)));
    section.figure(move || {
        let (initial, optimal) = (("initial", &design.initial), Some(("optimal", &design.optimal)));
        confidence_ellipses(&study.parameters, initial, optimal)
    });
    section
}

/// The verdict on the study: is the result as predicted, and why.
pub(super) fn judge(name: &str, study: &DesignStudy) -> (bool, String) {
    let all = study.outcomes.len();
    let better = study.outcomes.iter().filter(|o| o.optimal.trace <= o.initial.trace).count();
    let by_gain = |a: &&calibrant_study::Improvement, b: &&calibrant_study::Improvement| {
        a.predicted.value.total_cmp(&b.predicted.value)
    };
    let gain = match study.summary.iter().max_by(by_gain) {
        Some(entry) => format!(
            " The largest improvement is that of {}: a factor of {} predicted, {} realised.",
            entry.optimal.name,
            factor(&entry.predicted),
            factor(&entry.realised)
        ),
        None => String::new(),
    };
    let kept = study.summary.iter().all(|entry| agrees(entry, all));
    let kept_words = if kept {
        "Predicted and realised factors agree."
    } else {
        "For some parameter, predicted and realised factors differ by more than chance explains."
    };
    let coverage = coverage(study);
    let sentence = format!(
        "{name}: the trace of the covariance is smaller than with the initial motion for {} of {} sensors.{gain} {kept_words} 95 % intervals contain \
         the truth in {} of the cases.",
        count(better),
        count(all),
        percent(coverage)
    );
    (all > 0 && better == all && kept && is_covered(coverage, all), sentence)
}

/// Do so many of the 95 % intervals contain the truth, up to chance? Estimates of one sensor are correlated, so the sensors alone count.
pub(super) fn is_covered(coverage: f64, sensors: usize) -> bool {
    (coverage - 0.95).abs() <= 2.0 * (0.95 * 0.05 / sensors.max(1) as f64).sqrt()
}

fn coverage(study: &DesignStudy) -> f64 {
    study.summary.iter().map(|entry| entry.optimal.coverage_95).sum::<f64>()
        / study.summary.len().max(1) as f64
}

/// Do predicted and realised factor agree over so many sensors, up to chance?
fn agrees(entry: &calibrant_study::Improvement, sensors: usize) -> bool {
    if sensors < FEWEST {
        return true;
    }
    let error = |factor: &Factor| factor.standard_error.unwrap_or(f64::INFINITY);
    let both = error(&entry.predicted).hypot(error(&entry.realised));
    // few sensors tell their scatter badly: Student's quantile in place of the normal one, by its expansion in 1/ν
    let (z, nu) = (CHANCE, sensors.saturating_sub(1).max(1) as f64);
    let student =
        z + (z.powi(3) + z) / (4.0 * nu) + (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / (96.0 * nu * nu);
    (entry.predicted.value - entry.realised.value).abs() <= student * both
}

/// A factor with its standard error.
pub(super) fn factor(factor: &Factor) -> String {
    match factor.standard_error {
        Some(error) if error > 5e-4 * factor.value => with_sd(factor.value, error),
        Some(_) => significant(factor.value, 4),
        None => significant(factor.value, 3),
    }
}

fn improvement_table(study: &DesignStudy) -> Table {
    let mut table = Table::new([
        Column::new("parameter"),
        Column::new("unit"),
        Column::new("predicted sd, initial"),
        Column::new("predicted sd, optimal"),
        Column::new("predicted factor"),
        Column::new("realised error, initial"),
        Column::new("realised error, optimal"),
        Column::new("realised factor"),
        Column::new("coverage of 95 % intervals, initial"),
        Column::new("coverage of 95 % intervals, optimal"),
    ]);
    for entry in &study.summary {
        let (before, after) = (&entry.initial, &entry.optimal);
        let numbers = |s: &ParameterSummary| [s.predicted_sd, s.realised_rms];
        let unit = DisplayUnit::suited_to(before.unit, numbers(before).into_iter().chain(numbers(after)));
        let shown = |value: f64| Cell::scaled(value, 3, unit.factor);
        table.row(vec![
            Cell::name(&after.name),
            unit.cell(before.unit),
            shown(before.predicted_sd),
            shown(after.predicted_sd),
            Cell::Number(factor(&entry.predicted)),
            shown(before.realised_rms),
            shown(after.realised_rms),
            Cell::Number(factor(&entry.realised)),
            coverage_cell(before.coverage_95),
            coverage_cell(after.coverage_95),
        ]);
    }
    table
}

/// A coverage in per cent, with one decimal.
pub(super) fn coverage_cell(coverage: f64) -> Cell {
    Cell::Number(format!("{:.1} %", 100.0 * coverage))
}

fn trace_table(study: &DesignStudy) -> Table {
    let mut table = Table::new(["trace of the covariance (SI)", "least", "median", "most"]);
    for (name, range) in [("initial motion", &study.trace.initial), ("optimal motion", &study.trace.optimal)]
    {
        let shown = |value: f64| Cell::significant(value, 4);
        table.row(vec![Cell::name(name), shown(range.least), shown(range.median), shown(range.most)]);
    }
    let (initial, optimal) = (&study.trace.initial, &study.trace.optimal);
    let ratio = |initial: f64, optimal: f64| Cell::Number(times(initial / optimal));
    table.row(vec![
        Cell::name("initial over optimal"),
        ratio(initial.least, optimal.least),
        ratio(initial.median, optimal.median),
        ratio(initial.most, optimal.most),
    ]);
    table
}
