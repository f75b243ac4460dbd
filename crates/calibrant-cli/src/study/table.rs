//! The tables of the studies on the console.

use crate::console;
use calibrant::report::number_format;
use calibrant::study::{DesignStudy, Factor, Improvement, ParameterSummary, Studies, Study};

/// A table for each study, and the studies that did not run.
pub(super) fn studies(studies: &Studies) -> String {
    let mut parts = Vec::new();
    parts.extend(studies.calibration.as_ref().map(calibration));
    parts.extend(studies.design.as_ref().map(design));
    parts.extend(studies.noisy.as_ref().map(design));
    parts.join("\n")
}

fn calibration(study: &Study) -> String {
    let rows: Vec<_> = study
        .summary
        .iter()
        .map(|row| {
            vec![
                row.name.clone(),
                row.unit.to_owned(),
                number_format::significant(row.predicted_sd, 3),
                number_format::significant(row.realised_rms, 3),
                format!("{:.3}", row.realised_rms / row.predicted_sd),
                percent(row.coverage_95),
            ]
        })
        .collect();
    let header =
        ["parameter", "unit", "predicted sd", "realised rms error", "ratio", "coverage of 95 % intervals"];
    let title = format!(
        "{}, trust {}, {} intervals, {} Hz, seed {}\n",
        sensors(study.outcomes.len()),
        study.trust,
        study.motion.intervals(),
        number_format::short(study.rate_hz),
        study.seed
    );
    title + &console::table(&header, &rows)
}

fn design(study: &DesignStudy) -> String {
    let rows: Vec<_> = study.summary.iter().map(row).collect();
    let header = [
        "parameter",
        "unit",
        "initial: predicted",
        "realised",
        "95 %",
        "optimal: predicted",
        "realised",
        "95 %",
        "better: predicted",
        "realised",
    ];
    let title = format!(
        "{}, trust {}, initial against optimal motion, {} intervals, {} Hz, seed {}\n",
        sensors(study.outcomes.len()),
        study.trust.name(),
        study.intervals,
        number_format::short(study.rate_hz),
        study.seed
    );
    let trace = format!(
        "  trace of the covariance, median: {} initial, {} optimal\n",
        number_format::significant(study.trace.initial.median, 3),
        number_format::significant(study.trace.optimal.median, 3)
    );
    title + &console::table(&header, &rows) + &trace
}

fn row(improvement: &Improvement) -> Vec<String> {
    let Improvement { initial, optimal, predicted, realised } = improvement;
    let mut cells = vec![initial.name.clone(), initial.unit.to_owned()];
    for ParameterSummary { predicted_sd, realised_rms, coverage_95, .. } in [initial, optimal] {
        cells.push(number_format::significant(*predicted_sd, 3));
        cells.push(number_format::significant(*realised_rms, 3));
        cells.push(percent(*coverage_95));
    }
    cells.push(factor(predicted));
    cells.push(factor(realised));
    cells
}

fn factor(factor: &Factor) -> String {
    match factor.standard_error {
        // every sensor may have the same initial motion
        Some(error) if error > 1e-9 * factor.value => {
            format!("×{}", number_format::with_sd(factor.value, error))
        }
        _ => format!("×{}", number_format::significant(factor.value, 3)),
    }
}

fn percent(fraction: f64) -> String {
    format!("{:.1} %", 100.0 * fraction)
}

fn sensors(count: usize) -> String {
    format!("{} sensor{}", number_format::count(count), if count == 1 { "" } else { "s" })
}
