//! The chapter on a rehearsal: plain routine against best trajectory of a machine.

use super::design::{coverage_cell, factor, is_covered};
use super::settings::setting_table;
use crate::figure::{DisplayUnit, rehearsed_errors, rehearsed_sds};
use crate::number_format::{count, counted, percent, short};
use crate::sheet::{Cell, Column, Section, Table};
use calibrant_study::Rehearsal;

/// What design, recording and calibration give for simulated sensors.
pub(super) fn chapter(study: &Rehearsal) -> Section<'_> {
    let mut section = Section::new("Rehearsal").lead(
        "Each simulated sensor is carried by the machine through a plain routine, recorded and calibrated, and again through the best trajectory. Its errors, its mount, \
         the clocks, gravity and the geometry of the machine are drawn from what is known of them.",
    );
    section.table(setting_table([
        ("sensors", count(study.sensors.len())),
        ("plain routine", study.routine.to_owned()),
        ("duration of each motion", format!("{} s", short(study.duration_s))),
        ("seed of the first sensor", study.seed.to_string()),
    ]));
    section.explanation(
        "Designed: standard deviations that the design promises. Stated: those of the calibrations (root mean square over the sensors). Realised: errors of the estimates \
         (the same mean). Factors are plain over best, above 1 is better, ± one standard error from so many sensors.",
    );
    section.line(format!(
        "{}, {} against best trajectory, {} s each, seed {}",
        counted(study.sensors.len(), "sensor"),
        study.routine,
        short(study.duration_s),
        study.seed
    ));
    section.table(table(study));
    section.table(verdicts(study));
    section.figure(|| Some(rehearsed_sds(study)));
    section.figure(|| Some(rehearsed_errors(study)));
    section
}

/// The verdict on the rehearsal: is the result as designed, and why.
pub(super) fn judge(study: &Rehearsal) -> (bool, String) {
    let all = study.sensors.len();
    let ok = study.sensors.iter().filter(|sensor| sensor.optimal.verdict == "ok").count();
    let coverage = study.summary.iter().map(|entry| entry.optimal.coverage_95).sum::<f64>()
        / study.summary.len().max(1) as f64;
    let departure = study.departure();
    let gain = study.summary.iter().map(|entry| entry.predicted.value.ln()).sum::<f64>();
    let gain = (gain / study.summary.len().max(1) as f64).exp();
    let sentence = format!(
        "On the best trajectory standard deviations are {} times smaller in the mean than with the plain routine ({}). {} {} of {} calibrations on it are ok. 95 % intervals \
         contain the truth in {} of the cases.",
        crate::number_format::significant(gain, 3),
        study.routine,
        match departure {
            Some(of) => format!(
                "{} of {} on the {} is {} times what was designed: more than chance explains.",
                if of.is_realised { "The realised error" } else { "The stated standard deviation" },
                study.parameters[of.parameter].name,
                if of.is_plain { "plain routine" } else { "best trajectory" },
                crate::number_format::significant(of.factor, 3)
            ),
            None => "Each parameter is as designed, up to chance.".to_owned(),
        },
        count(ok),
        count(all),
        percent(coverage)
    );
    (all > 0 && departure.is_none() && is_covered(coverage, all), sentence)
}

fn table(study: &Rehearsal) -> Table {
    let mut table = Table::new([
        Column::new("parameter"),
        Column::new("unit"),
        Column::new("designed sd, best"),
        Column::new("stated sd, best"),
        Column::new("realised error, best"),
        Column::on_page("coverage of 95 % intervals, best"),
        Column::on_page("designed sd, plain"),
        Column::on_page("stated sd, plain"),
        Column::on_page("realised error, plain"),
        Column::on_page("coverage of 95 % intervals, plain"),
        Column::new("stated factor"),
        Column::new("realised factor"),
    ]);
    for (k, entry) in study.summary.iter().enumerate() {
        let (plain, best) = (&entry.initial, &entry.optimal);
        let designed = study.designed_sd.each_ref().map(|sds| sds.get(k).copied().unwrap_or(f64::INFINITY));
        let numbers = [best.predicted_sd, best.realised_rms, plain.predicted_sd, plain.realised_rms];
        let unit = DisplayUnit::suited_to(best.unit, numbers);
        let shown = |value: f64| Cell::scaled(value, 3, unit.factor);
        table.row(vec![
            Cell::name(&best.name),
            unit.cell(best.unit),
            Cell::sd(designed[1], unit.factor),
            shown(best.predicted_sd),
            shown(best.realised_rms),
            coverage_cell(best.coverage_95),
            Cell::sd(designed[0], unit.factor),
            shown(plain.predicted_sd),
            shown(plain.realised_rms),
            coverage_cell(plain.coverage_95),
            Cell::Number(factor(&entry.predicted)),
            Cell::Number(factor(&entry.realised)),
        ]);
    }
    table
}

fn verdicts(study: &Rehearsal) -> Table {
    let mut table = Table::new(["calibrations", "ok", "doubtful", "bad", "codes"]);
    for (name, is_best) in [(study.routine, false), ("best trajectory", true)] {
        let all = || study.sensors.iter().map(|of| if is_best { &of.optimal } else { &of.plain });
        let of = |verdict: &str| Cell::Number(count(all().filter(|one| one.verdict == verdict).count()));
        let mut codes: Vec<&str> = all().flat_map(|one| one.codes.iter().copied()).collect();
        codes.sort_unstable();
        codes.dedup();
        table.row(vec![Cell::name(name), of("ok"), of("doubtful"), of("bad"), Cell::Text(codes.join(", "))]);
    }
    table
}
