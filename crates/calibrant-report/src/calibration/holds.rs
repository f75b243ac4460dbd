//! Tables of the holds of a static calibration.

use super::quality::{bias_drift, earlier_biases};
use crate::number_format::{significant, with_sd_or_exact};
use crate::sheet::{Cell, Column, Table};
use calibrant_core::estimate::{Calibration, HoldCalibration, HoldResult};
use calibrant_core::sensor::{Axis, ReadingUnit, SensorKind};

/// Fewest degrees of freedom that show a scatter along gravity.
const FEWEST: usize = 3;
/// An unused hold beyond this number of standard deviations is called an outlier.
const OUTLYING: f64 = 3.0;

/// The table of what all holds have in common.
pub(super) fn hold_summary(calibration: &Calibration, holds: &HoldCalibration) -> Table {
    let used = holds.used().count();
    let mut table = Table::explained();
    let (how, found) = match holds.detected {
        true => ("detected", "Found in the recording as stationary intervals."),
        false => ("given", "As given by the user."),
    };
    table.explain("holds used", format!("{used} of {}, {how}", holds.holds.len()), found);
    let gravity = with_sd_or_exact(holds.gravity.magnitude_mps2, holds.gravity.sd_mps2);
    table.explain(
        "gravity g",
        format!("{gravity} m/s²"),
        "Assumed. A relative error of g is the same relative error of all scale factors. Their sd includes that of g.",
    );
    match holds.degrees_of_freedom {
        0 => table.explain_on_page(
            "magnitude residual",
            "no data left to check".into(),
            "The holds are no more than the parameters, so the fit is exact. Add holds.",
        ),
        _ => table.explain_on_page(
            "magnitude residual, rms",
            format!("{} mm/s²", significant(1e3 * holds.magnitude_residual_rms_mps2, 3)),
            "Corrected magnitude less g, over the used holds.",
        ),
    }
    if let Some(tilt) = &holds.tilt {
        table.explain_on_page(
            "tilt of the faces, sd",
            format!("{}°", significant(tilt.sd_rad.to_degrees(), 2)),
            &format!(
                "Face alignment about each axis: {}. It decides the standard deviations of the cross-axis terms. Along gravity, only the square of a tilt acts.{}",
                tilt.source_in_words(),
                tilt.assumed_in_words().map_or_else(String::new, |assumed| format!(" And {assumed}."))
            ),
        );
    }
    let (name, nothing) = match holds.tilt {
        Some(_) => ("scatter along gravity, sd", holds.degrees_of_freedom < FEWEST),
        None => ("scatter between holds, sd", false),
    };
    if nothing {
        table.explain(
            name,
            "not determined".into(),
            "The noise of the samples and the tilt decide the standard deviations of biases and scale factors. To determine it, repeat each face.",
        );
    } else {
        table.explain(
            name,
            format!(
                "{} mm/s², {}",
                significant(1e3 * holds.between_holds_sd_mps2, 3),
                if holds.between_holds_dominates { "decides the sd" } else { "explained by the noise" }
            ),
            if holds.between_holds_dominates {
                "It exceeds the noise of the samples, so it decides the standard deviations."
            } else {
                "The noise of the samples explains it, and decides the standard deviations."
            },
        );
    }
    let of = (SensorKind::Accelerometer, calibration.unit(SensorKind::Accelerometer));
    earlier_biases(&mut table, of, holds.recording_biases.as_deref());
    if let Some((drift, unit)) = bias_drift(calibration) {
        table.explain(
            "bias drift (x, y, z)",
            format!("{drift} {unit}"),
            "From the first hold to the last. The holds are freed from it: the biases are those of the middle between both. Its uncertainty is part of the \
             standard deviations.",
        );
    }
    table.explain(
        "condition number",
        significant(holds.condition_number, 3),
        "How unevenly the orientations determine the parameters. Below about 100 is good.",
    );
    table
}

pub(super) fn hold_table(holds: &HoldCalibration, unit: ReadingUnit) -> Table {
    let seconds = |heading: &str| Column::new(heading).in_unit("s");
    let mean = |axis: Axis| Column::new(format!("mean {axis}")).in_unit(unit.symbol());
    let mut columns = vec![Column::new("hold"), seconds("start"), seconds("end"), Column::new("samples")];
    columns.extend(Axis::ALL.map(mean));
    columns.push(Column::new("|s| − g").in_unit("mm/s²"));
    columns.extend(["studentised", "used"].map(Column::new));
    let mut table = Table::new(columns);
    let decimals = if unit == ReadingUnit::Counts { 2 } else { 5 };
    for (i, result) in holds.holds.iter().enumerate() {
        let hold = &result.hold;
        let mut cells = vec![
            Cell::name((i + 1).to_string()),
            Cell::fixed(hold.start_s, 2),
            Cell::fixed(hold.end_s, 2),
            Cell::count(hold.samples()),
        ];
        cells.extend(hold.mean.iter().map(|&mean| Cell::fixed(mean, decimals)));
        cells.push(Cell::fixed(1e3 * result.magnitude_residual_mps2, 2));
        cells.push(Cell::fixed(result.studentised_residual, 2));
        table.row_used(cells, if result.used { None } else { Some(why_not(result)) });
    }
    table
}

fn why_not(result: &HoldResult) -> &'static str {
    if result.reason.is_some() {
        "saturated"
    } else if result.studentised_residual.abs() > OUTLYING {
        "outlier"
    } else {
        "see the warnings"
    }
}
