//! The table of the fit: each statistic with its meaning.

use super::quality::earlier_biases;
use crate::figure::DisplayUnit;
use crate::number_format::{count, probability, significant};
use crate::sheet::{Shown, Table, explained};
use calibrant_core::estimate::{Calibration, FitStatistics};
use calibrant_core::sensor::{Axis, SensorKind};
use nalgebra::Vector3;

/// The rows on χ². Where the noise was estimated, `from_data` says so, and what χ² then means. The p-value is shown there.
pub(crate) fn chi2_rows(table: &mut Table, fit: &FitStatistics, from_data: [&str; 2], p_value: Shown) {
    let [suffix, meaning] = match fit.p_value {
        Some(_) => {
            ["", "Sum of squared residuals over the assumed noise. Good: near the degrees of freedom."]
        }
        None => from_data,
    };
    table.explain("χ²", significant(fit.chi2, 5) + suffix, meaning);
    let meaning = "Number of data less number of unknowns. χ² scatters about it by √(2·dof).";
    table.explain("degrees of freedom", count(fit.degrees_of_freedom), meaning);
    if let Some(p) = fit.p_value {
        let meaning = "Probability of a χ² at least this large if model and noise are right. Suspicious: below 0.001 and above 0.999.";
        table.row_shown(p_value, explained("p-value", probability(p), meaning));
    }
}

/// The statistics of the fit with one line of explanation each.
pub(super) fn fit_table(calibration: &Calibration) -> Table {
    let fit = &calibration.fit;
    let axes = &Axis::ALL[..calibration.axes()];
    let mut table = Table::explained();
    let status = calibration.status.name().replace('_', " ");
    table.explain("status", status, "How the iteration ended. Only “converged” is an optimum.");
    table.explain(
        "iterations",
        calibration.iterations.to_string(),
        "Steps of the estimator. A handful is usual.",
    );
    table.explain_on_page(
        "gradient norm",
        significant(calibration.gradient_norm, 2),
        "Distance from the optimum in standard deviations of the parameters. Good: far below 1.",
    );
    let from_data = "Sum of weighted squared residuals. The weights come from these data, so it is always near the degrees of freedom and tests nothing.";
    chi2_rows(&mut table, fit, [", weights from the data", from_data], Shown::OnPage);
    let rms = fit.residual_rms.unwrap_or_else(Vector3::zeros);
    let unit = DisplayUnit::suited_to(
        calibration.unit(SensorKind::Accelerometer).symbol(),
        rms.iter().map(|rms| 3.0 * rms),
    );
    let names = axes.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let per_axis = |values: &Vector3<f64>, factor: f64, symbol: &str| {
        let number = |axis: &Axis| significant(values[axis.index()] * factor, 3);
        format!("{} {symbol}", axes.iter().map(number).collect::<Vec<_>>().join(", "))
    };
    let rows = [
        (Shown::OnPage, "residual rms", fit.residual_rms, "Root mean square of the residuals of each axis."),
        (
            Shown::Everywhere,
            "assumed noise",
            fit.assumed_noise,
            "Standard deviation of one sample, as χ² assumes it.",
        ),
        (
            Shown::Everywhere,
            "noise estimate",
            fit.noise_estimate,
            "Standard deviation of one sample, from the data. Good: close to the assumed noise, if one was given.",
        ),
    ];
    for (shown, name, values, meaning) in rows {
        if let Some(values) = values {
            let value = per_axis(&values, unit.factor, unit.symbol);
            table.row_shown(shown, explained(&format!("{name} {names}"), value, meaning));
        }
    }
    for (test, axis) in fit.whiteness.iter().zip(axes) {
        table.explain_on_page(
            &format!("whiteness {axis}, p"),
            probability(test.p_value),
            &format!(
                "Ljung–Box test of {} lags (Q = {}). Below 0.001, the residuals are not white, and the stated sd are too small.",
                test.lags,
                significant(test.statistic, 3)
            ),
        );
    }
    if let Some(gyroscope) = &calibration.gyroscope {
        let (still, symbol) = (&gyroscope.still, gyroscope.unit.symbol());
        table.explain(
            "gyroscope's noise x, y, z",
            format!("{}, from: {}", per_axis(&still.noise, 1.0, symbol), still.noise_source),
            "Standard deviation of one sample.",
        );
        table.explain_on_page(
            "between holds x, y, z",
            per_axis(&still.between_holds_sd, 1.0, symbol),
            "Standard deviation of the gyroscope's mean from hold to hold, beyond this noise. Causes: a wandering bias, the Earth's rate.",
        );
        let of = (SensorKind::Gyroscope, gyroscope.unit);
        earlier_biases(&mut table, of, gyroscope.recording_biases.as_ref());
    }
    table
}
