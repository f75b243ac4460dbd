//! The table of the least-squares fit of an IMU.

use crate::number_format;
use crate::table::Table;
use calibrant_core::estimate::ImuCalibration;
use nalgebra::Vector3;

/// The statistics of the fit with one line of explanation each.
pub(super) fn fit_table(calibration: &ImuCalibration) -> String {
    let mut table = Table::explained();
    let mut row = |name: &str, value: String, meaning: &str| table.explain(name, value, meaning);
    let status = calibration.status.name().replace('_', " ");
    row("status", status, "How the iteration ended; only “converged” is an optimum.");
    row("iterations", calibration.iterations.to_string(), "Steps of the joint problem; a handful is usual.");
    row(
        "gradient norm",
        number_format::significant(calibration.gradient_norm, 2),
        "Distance from the optimum in standard deviations of the parameters; good is far below 1.",
    );
    row(
        "χ²",
        number_format::significant(calibration.chi2, 4),
        "Sum of weighted squared residuals. The weights come from these data, so it is near the degrees of freedom and tests nothing.",
    );
    row(
        "degrees of freedom",
        number_format::count(calibration.degrees_of_freedom),
        "Data less unknowns: how much checks the fit.",
    );
    let unit = calibration.gyroscope_unit.symbol();
    let axes = |values: &Vector3<f64>| {
        let values: Vec<String> = values.iter().map(|&value| number_format::significant(value, 3)).collect();
        format!("{} {unit}", values.join(", "))
    };
    row(
        "gyroscope's noise x, y, z",
        axes(&calibration.still.noise),
        &format!("Standard deviation of one sample, from: {}.", calibration.still.noise_source),
    );
    row(
        "between holds x, y, z",
        axes(&calibration.still.between_holds_sd),
        "Standard deviation of the gyroscope's mean from hold to hold beyond this noise: a wandering bias, the Earth's rotation.",
    );
    table.html()
}
