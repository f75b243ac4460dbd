//! Tables of the holds of a static calibration.

use super::quality::bias_drift;
use crate::number_format;
use crate::table::{Cell, Table};
use calibrant_core::estimate::{Calibration, HoldCalibration, HoldResult};
use calibrant_core::sensor::ReadingUnit;

/// Fewest degrees of freedom that show a scatter along gravity.
const FEWEST: usize = 3;
/// An unused hold beyond this number of standard deviations is called an outlier.
const OUTLYING: f64 = 3.0;

/// The table of what all holds have in common.
pub(super) fn hold_summary(calibration: &Calibration, holds: &HoldCalibration) -> String {
    let used = holds.used().count();
    let mut table = Table::explained();
    let mut row = |name: &str, value: String, meaning: &str| table.explain(name, value, meaning);
    let found = if holds.detected {
        "Found in the recording as stationary intervals."
    } else {
        "As given by the user."
    };
    row("holds used", format!("{used} of {}", holds.holds.len()), found);
    row(
        "gravity g",
        match holds.gravity.sd_mps2 {
            sd if sd > 0.0 => format!("{} m/s²", number_format::with_sd(holds.gravity.magnitude_mps2, sd)),
            _ => format!("{} m/s²", number_format::significant(holds.gravity.magnitude_mps2, 6)),
        },
        "Assumed. A relative error of g is the same relative error of all scale factors. Their sd includes that of g.",
    );
    match holds.degrees_of_freedom {
        0 => row(
            "magnitude residual",
            "no data left to check".into(),
            "The holds are no more than the parameters, so the fit is exact. Add holds.",
        ),
        _ => row(
            "magnitude residual, rms",
            format!("{} mm/s²", number_format::significant(1e3 * holds.magnitude_residual_rms_mps2, 3)),
            "Corrected magnitude less g, over the used holds.",
        ),
    }
    if let Some(tilt) = &holds.tilt {
        row(
            "tilt of the faces, sd",
            format!("{}°", number_format::significant(tilt.sd_rad.to_degrees(), 2)),
            &format!(
                "Face alignment about each axis: {}. It decides the standard deviations of the cross-axis terms. Along gravity, only the square of a tilt acts.",
                tilt.source_in_words()
            ),
        );
    }
    let (name, nothing) = match holds.tilt {
        Some(_) => ("scatter along gravity, sd", holds.degrees_of_freedom < FEWEST),
        None => ("scatter between holds, sd", false),
    };
    if nothing {
        row(
            name,
            "not determined".into(),
            "The noise of the samples and the tilt decide the standard deviations of biases and scale factors. To determine it, repeat each face.",
        );
    } else {
        row(
            name,
            format!("{} mm/s²", number_format::significant(1e3 * holds.between_holds_sd_mps2, 3)),
            if holds.between_holds_dominates {
                "It exceeds the noise of the samples, so it decides the standard deviations."
            } else {
                "The noise of the samples explains it, and decides the standard deviations."
            },
        );
    }
    if let Some((drift, unit)) = bias_drift(calibration) {
        row(
            "bias drift (x, y, z)",
            format!("{drift} {unit}"),
            "From the first hold to the last. The holds are freed from it, and its uncertainty is part of the standard deviations.",
        );
    }
    row(
        "condition number",
        number_format::significant(holds.condition_number, 3),
        "How unevenly the orientations determine the parameters. Below about 100 is good.",
    );
    table.html()
}

/// One row for each hold.
pub(super) fn hold_table(holds: &HoldCalibration, unit: ReadingUnit) -> String {
    let mean = |axis: &str| format!("mean {axis} ({})", unit.symbol());
    let (x, y, z) = (mean("x"), mean("y"), mean("z"));
    let columns =
        ["hold", "start (s)", "end (s)", "samples", &x, &y, &z, "|s| − g (mm/s²)", "studentised", "used"];
    let mut table = Table::new("", &columns);
    for (i, result) in holds.holds.iter().enumerate() {
        let hold = &result.hold;
        let decimals = if unit == ReadingUnit::Counts { 2 } else { 5 };
        let mut cells = vec![
            Cell::Name((i + 1).to_string()),
            Cell::Number(number_format::fixed(hold.start_s, 2)),
            Cell::Number(number_format::fixed(hold.end_s, 2)),
            Cell::Number(number_format::count(hold.samples())),
        ];
        cells.extend(hold.mean.iter().map(|&mean| Cell::Number(number_format::fixed(mean, decimals))));
        cells.push(Cell::Number(number_format::fixed(1e3 * result.magnitude_residual_mps2, 2)));
        cells.push(Cell::Number(number_format::fixed(result.studentised_residual, 2)));
        if result.used {
            cells.push(Cell::Text("yes".to_string()));
            table.row(cells);
        } else {
            cells.push(Cell::Mark(why_not(result)));
            table.row_left_out(cells);
        }
    }
    table.html()
}

fn why_not(result: &HoldResult) -> String {
    if result.reason.is_some() {
        "no: saturated".to_string()
    } else if result.studentised_residual.abs() > OUTLYING {
        "no: outlier".to_string()
    } else {
        "no: see the warnings".to_string()
    }
}
