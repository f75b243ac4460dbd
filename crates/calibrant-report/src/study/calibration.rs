//! The chapter on calibrations of a population of sensors: the thesis's chapter 3.

use super::settings::{per_axis, setting_table};
use crate::calibration::parameter_table;
use crate::figure::{
    DisplayUnit, acceleration_figure, motion_error_figure, p_values, parameter_errors,
    parameters_against_truth, standardised_errors, state_and_jerk_figure,
};
use crate::number_format::{UNKNOWN, count, counted, percent, short, tick};
use crate::sheet::{Cell, Column, Section, Table};
use calibrant_core::estimate::Recovered;
use calibrant_core::sensor::SensorKind;
use calibrant_study::Study;

/// The thesis's chapter 3: calibrations of many sensors, and one of them in detail (Figures 4 to 6).
pub(super) fn chapter(study: &Study) -> Section<'_> {
    let mut section = Section::new("Calibration of a population").lead(
        "Each sensor makes the same commanded motion, is recorded and calibrated. Then the estimate is compared with the truth.",
    );
    section.table(settings(study));
    for (is_fine, heading, what, case) in [
        (false, "One sensor in detail", "The population's rate", &study.single),
        (true, "The same sensor at the higher rate", "Recorded faster", &study.fine),
    ] {
        section.heading_on_page(heading);
        section.explanation(format!(
            "{what}, {} Hz: {} samples, {} intervals.",
            tick(case.recording.rate_hz()),
            count(case.recording.len()),
            case.true_motion.intervals()
        ));
        let truth = Some(&case.truth);
        section.table(parameter_table(&case.calibration, SensorKind::Accelerometer, truth).on_page());
        let Recovered::Motion(recovered) = &case.calibration.recovered else { continue };
        let (recording, truth) = (&case.recording, Some(&case.true_motion));
        if is_fine {
            let title = "Figure 5 of the thesis: actual and estimated states and inputs";
            section.figure(move || Some(state_and_jerk_figure(title, recovered, recording, truth)));
        } else {
            let title = "Figure 4 of the thesis: actual, measured and estimated acceleration";
            let of = &case.calibration;
            section.figure(move || Some(acceleration_figure(title, of, recovered, recording, truth)));
            section.figure(move || motion_error_figure(recovered, recording, truth));
        }
    }
    section.heading_on_page("All sensors");
    section.explanation(
        "If the covariances are right, the realised error equals the stated standard deviation, the mean error is near zero, and \
         95 % of the intervals contain the truth.",
    );
    section.line(format!(
        "{}, trust {}, {} intervals, {} Hz, seed {}",
        counted(study.outcomes.len(), "sensor"),
        study.trust,
        study.motion.intervals(),
        short(study.rate_hz),
        study.seed
    ));
    section.table(summary_table(study));
    section.figure(|| Some(parameters_against_truth(study)));
    section.figure(|| Some(parameter_errors(study)));
    section.drawn(|| {
        let figures = [standardised_errors(study), p_values(study)];
        let figures: String = figures.iter().flatten().map(|figure| figure.html()).collect();
        format!("<div class=\"pair\">{figures}</div>")
    });
    section
}

/// The verdict on the population: are the covariances right, and why.
pub(super) fn judge(study: &Study) -> (bool, String) {
    let all = study.outcomes.len();
    let converged = study.outcomes.iter().filter(|outcome| outcome.status == "converged").count();
    let coverage =
        study.summary.iter().map(|entry| entry.coverage_95).sum::<f64>() / study.summary.len().max(1) as f64;
    let honest = super::design::is_covered(coverage, all);
    let judged = if all == 0 || study.summary.is_empty() {
        "There is nothing to judge.".to_string()
    } else if honest {
        format!("95 % intervals contain the truth in {} of the cases, as expected.", percent(coverage))
    } else {
        format!(
            "95 % intervals contain the truth in {} of the cases, which chance does not explain. The stated standard deviations are too {}.",
            percent(coverage),
            if coverage < 0.95 { "small" } else { "large" }
        )
    };
    let sentence = format!("{} of {} calibrations converged. {judged}", count(converged), count(all));
    (honest && converged == all && all > 0, sentence)
}

fn settings(study: &Study) -> Table {
    let sensor = &study.sensor;
    let axes = sensor.active_axes();
    let with = |values: &Option<nalgebra::Vector3<f64>>, unit: &str| {
        values.as_ref().map(|values| format!("{} {unit}", per_axis(values, axes)).trim_end().to_owned())
    };
    let known = |text: Option<String>| text.unwrap_or_else(|| UNKNOWN.to_string());
    let noise = with(&sensor.noise_counts, "counts").or_else(|| with(&sensor.noise_mps2, "m/s²"));
    let intervals = study.motion.intervals();
    let duration = study.motion.times_s()[intervals] - study.motion.times_s()[0];
    setting_table([
        ("sensors", count(study.outcomes.len())),
        ("axes", sensor.axes.to_string()),
        ("unit of the readings", sensor.unit.symbol().to_string()),
        ("noise of one sample, sd", known(noise)),
        ("bias, sd over the population", known(with(&sensor.bias_sd_mps2, "m/s²"))),
        ("scale factor, sd over the population", known(with(&sensor.scale_sd, ""))),
        ("trust in the motion", study.trust.to_string()),
        ("motion", format!("{intervals} intervals in {} s", tick(duration))),
        ("sample rate", format!("{} Hz", tick(study.rate_hz))),
        ("seed", study.seed.to_string()),
    ])
}

fn summary_table(study: &Study) -> Table {
    let mut table = Table::new([
        Column::new("parameter"),
        Column::new("unit"),
        Column::new("predicted sd"),
        Column::new("realised rms error"),
        Column::new("ratio"),
        Column::on_page("mean error"),
        Column::new("coverage of 95 % intervals"),
    ]);
    for entry in &study.summary {
        let unit = DisplayUnit::suited(entry.unit, entry.predicted_sd.max(entry.realised_rms));
        let shown = |value: f64| Cell::scaled(value, 3, unit.factor);
        table.row(vec![
            Cell::name(&entry.name),
            unit.cell(entry.unit),
            shown(entry.predicted_sd),
            shown(entry.realised_rms),
            Cell::fixed(entry.realised_rms / entry.predicted_sd, 3),
            shown(entry.mean_error),
            super::design::coverage_cell(entry.coverage_95),
        ]);
    }
    table
}
