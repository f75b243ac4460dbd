//! The table of the fit: how well the model fits, each number with its meaning.

use super::figure::DisplayUnit;
use super::number_format;
use super::table::Table;
use calibrant_core::estimate::{Calibration, Recovered};
use calibrant_core::sensor::{Axis, Recording};
use nalgebra::Vector3;

/// The statistics of the fit with one line of explanation each.
pub(super) fn fit_table(calibration: &Calibration, recording: &Recording) -> String {
    let fit = &calibration.fit;
    let axes = recording.active_axes();
    let mut table = Table::explained();
    let mut row = |name: &str, value: String, meaning: &str| table.explain(name, value, meaning);
    let status = match calibration.status.name() {
        "iteration_limit" => "iteration limit",
        name => name,
    };
    row("status", status.to_string(), "How the iteration ended; only “converged” is an optimum.");
    row("iterations", calibration.iterations.to_string(), "Steps of the estimator; a handful is usual.");
    row(
        "gradient norm",
        number_format::significant(calibration.gradient_norm, 2),
        "Distance from the optimum in standard deviations of the parameters; good is far below 1.",
    );
    row(
        "χ²",
        number_format::significant(fit.chi2, 5),
        "Sum of squared residuals over the assumed noise; good is near the degrees of freedom.",
    );
    row(
        "degrees of freedom",
        number_format::count(fit.degrees_of_freedom),
        "Data less unknowns: how much checks the fit. χ² scatters about it by √(2·dof).",
    );
    let p = fit.p_value.map_or(number_format::UNKNOWN.to_string(), number_format::probability);
    let meaning = match fit.p_value {
        Some(_) => {
            "Chance of a χ² at least this large if model and noise are right; suspicious below 0.001 and above 0.999."
        }
        None => "Not available: no degrees of freedom, or the noise was estimated from this fit.",
    };
    row("p-value", p, meaning);

    let unit =
        DisplayUnit::suited_to(calibration.unit.symbol(), fit.residual_rms.iter().map(|rms| 3.0 * rms));
    let per_axis = |values: &Vector3<f64>| {
        let values: Vec<String> = axes
            .iter()
            .map(|axis| number_format::significant(values[axis.index()] * unit.factor, 3))
            .collect();
        format!("{} {}", values.join(", "), unit.symbol)
    };
    let (names, holds) = (axis_names(axes), matches!(calibration.recovered, Recovered::Holds(_)));
    let what = if holds {
        "Root mean square of what the fit leaves of the holds' means"
    } else {
        "Root mean square of the residuals"
    };
    row(&format!("residual rms {names}"), per_axis(&fit.residual_rms), &format!("{what}, per axis."));
    match &fit.assumed_noise {
        Some(noise) => row(
            &format!("assumed noise {names}"),
            per_axis(noise),
            "Standard deviation of one sample's noise that went into χ².",
        ),
        None => row(
            "assumed noise",
            number_format::UNKNOWN.to_string(),
            "None was given: the noise was estimated from this fit.",
        ),
    }
    if let Some(noise) = &fit.noise_estimate {
        row(
            &format!("noise estimate {names}"),
            per_axis(noise),
            "The same as the residuals show it; good is close to the assumed noise.",
        );
    }
    for (test, axis) in fit.whiteness.iter().zip(axes) {
        row(
            &format!("whiteness {axis}, p"),
            number_format::probability(test.p_value),
            &format!(
                "Ljung–Box test of {} lags (Q = {}); below 0.001 the residuals are not white and the stated sd too small.",
                test.lags,
                number_format::significant(test.statistic, 3)
            ),
        );
    }
    table.html()
}

fn axis_names(axes: &[Axis]) -> String {
    axes.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
