//! The chapter on calibrations of a population of sensors: the thesis's chapter 3.

use crate::calibration::parameter_table;
use crate::figure::{
    DisplayUnit, acceleration_figure, motion_error_figure, p_values, parameter_errors,
    parameters_against_truth, standardised_errors, state_and_jerk_figure,
};
use crate::number_format;
use crate::sheet::{Cell, Column, Section, Table};
use calibrant_core::estimate::Recovered;
use calibrant_core::sensor::SensorKind;
use calibrant_study::{SingleCase, Study};

/// The thesis's chapter 3: calibrations of many sensors, and one of them in detail (Figures 4 to 6).
pub(super) fn chapter(study: &Study) -> Section<'_> {
    let mut section = Section::new("Calibration of a population").lead(
        "Each sensor makes the same commanded motion, is recorded and calibrated. Then the estimate is compared with the truth.",
    );
    section.table(settings(study));
    section.heading_on_page("One sensor in detail");
    section.explanation(rates("The population's rate", &study.single));
    single(&mut section, &study.single);
    section.heading_on_page("The same sensor at the higher rate");
    section.explanation(rates("Recorded faster", &study.fine));
    fine(&mut section, &study.fine);
    section.heading_on_page("All sensors");
    section.explanation(
        "If the covariances are right, the realised error equals the stated standard deviation, the mean error is near zero, and \
         95 % of the intervals contain the truth.",
    );
    section.line(format!(
        "{}, trust {}, {} intervals, {} Hz, seed {}",
        number_format::counted(study.outcomes.len(), "sensor"),
        study.trust,
        study.motion.intervals(),
        number_format::short(study.rate_hz),
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

fn rates(what: &str, case: &SingleCase) -> String {
    format!(
        "{what}, {} Hz: {} samples, {} intervals.",
        number_format::tick(case.recording.rate_hz()),
        number_format::count(case.recording.len()),
        case.true_motion.intervals()
    )
}

fn estimates(case: &SingleCase) -> Table {
    parameter_table(&case.calibration, SensorKind::Accelerometer, Some(&case.truth)).on_page()
}

fn single<'a>(section: &mut Section<'a>, case: &'a SingleCase) {
    section.table(estimates(case));
    if let Recovered::Motion(recovered) = &case.calibration.recovered {
        let title = "Figure 4 of the thesis: actual, measured and estimated acceleration";
        let truth = Some(&case.true_motion);
        let figure = move || acceleration_figure(title, &case.calibration, recovered, &case.recording, truth);
        section.figure(move || Some(figure()));
        section.figure(move || motion_error_figure(recovered, &case.recording, truth));
    }
}

fn fine<'a>(section: &mut Section<'a>, case: &'a SingleCase) {
    section.table(estimates(case));
    if let Recovered::Motion(recovered) = &case.calibration.recovered {
        let title = "Figure 5 of the thesis: actual and estimated states and inputs";
        let truth = Some(&case.true_motion);
        section.figure(move || Some(state_and_jerk_figure(title, recovered, &case.recording, truth)));
    }
}

/// The verdict on the population: are the covariances right, and why.
pub(super) fn judge(study: &Study) -> (bool, String) {
    let all = study.outcomes.len();
    let converged = study.outcomes.iter().filter(|outcome| outcome.status == "converged").count();
    let coverage =
        study.summary.iter().map(|entry| entry.coverage_95).sum::<f64>() / study.summary.len().max(1) as f64;
    // estimates of one sensor are correlated, so the sensors alone count
    let chance = 2.0 * (0.95 * 0.05 / all.max(1) as f64).sqrt();
    let honest = (coverage - 0.95).abs() <= chance;
    let judged = if all == 0 || study.summary.is_empty() {
        "There is nothing to judge.".to_string()
    } else if honest {
        format!(
            "95 % intervals contain the truth in {} of the cases, as expected.",
            number_format::percent(coverage)
        )
    } else {
        format!(
            "95 % intervals contain the truth in {} of the cases, which chance does not explain. The stated standard deviations are too {}.",
            number_format::percent(coverage),
            if coverage < 0.95 { "small" } else { "large" }
        )
    };
    let sentence = format!(
        "{} of {} calibrations converged. {judged}",
        number_format::count(converged),
        number_format::count(all)
    );
    (honest && converged == all && all > 0, sentence)
}

fn settings(study: &Study) -> Table {
    let sensor = &study.sensor;
    let per_axis = |values: &nalgebra::Vector3<f64>| {
        let mut texts: Vec<String> =
            sensor.active_axes().iter().map(|axis| number_format::short(values[axis.index()])).collect();
        texts.dedup();
        texts.join(", ")
    };
    let unknown = || number_format::UNKNOWN.to_string();
    let mut table = Table::new(["setting", "value"]);
    let mut row =
        |name: &str, value: String| table.row(vec![Cell::Name(name.to_string()), Cell::Text(value)]);
    row("sensors", number_format::count(study.outcomes.len()));
    row("axes", sensor.axes.to_string());
    row("unit of the readings", sensor.unit.symbol().to_string());
    let noise = sensor.noise_counts.as_ref().map(|n| format!("{} counts", per_axis(n)));
    let noise = noise.or_else(|| sensor.noise_mps2.as_ref().map(|n| format!("{} m/s²", per_axis(n))));
    row("noise of one sample, sd", noise.unwrap_or_else(unknown));
    row(
        "bias, sd over the population",
        sensor.bias_sd_mps2.as_ref().map_or_else(unknown, |sd| format!("{} m/s²", per_axis(sd))),
    );
    row("scale factor, sd over the population", sensor.scale_sd.as_ref().map_or_else(unknown, per_axis));
    row("trust in the motion", study.trust.to_string());
    let intervals = study.motion.intervals();
    let duration = study.motion.times_s()[intervals] - study.motion.times_s()[0];
    row("motion", format!("{intervals} intervals in {} s", number_format::tick(duration)));
    row("sample rate", format!("{} Hz", number_format::tick(study.rate_hz)));
    row("seed", study.seed.to_string());
    table.on_page()
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
