//! Tables of the noise of the sensors and of the reference.

use super::quantity::place;
use crate::figure::DisplayUnit;
use crate::number_format;
use crate::table::{Cell, Table};
use calibrant_core::sensor::Axis;
use calibrant_machine::estimate::MachineCalibration;

fn growth(factor: Option<f64>) -> Cell {
    Cell::Number(factor.map_or_else(|| "none".into(), |factor| number_format::significant(factor, 2)))
}

/// Noise of each axis of each sensor.
pub(super) fn sensor_noise(calibration: &MachineCalibration) -> String {
    let columns = [
        "sensor",
        "at rest",
        "white part",
        "white / at rest",
        "rms of residuals",
        "unit",
        "growth κ",
        "samples",
    ];
    let mut table = Table::new("", &columns);
    for noise in &calibration.noise {
        let symbol = calibration.units[place(noise.sensor)].map_or("1", |unit| unit.symbol());
        let unit = DisplayUnit::suited_to(symbol, noise.rms.iter().chain(&noise.noise).copied());
        let number = |value: f64| Cell::Number(number_format::significant(unit.factor * value, 3));
        for axis in Axis::ALL {
            let k = axis.index();
            table.row(vec![
                Cell::Name(format!("{} {axis}", noise.sensor)),
                number(noise.noise[k]),
                number(noise.white_noise[k]),
                Cell::Number(number_format::percent(noise.white_noise[k] / noise.noise[k])),
                number(noise.rms[k]),
                Cell::Text(unit.symbol.into()),
                growth(noise.growth),
                Cell::Number(number_format::count(noise.residuals.len())),
            ]);
        }
    }
    format!(
        "{}<p>At rest: standard deviation of one sample where the machine does not move. White part: what neighbouring samples do not share, which the sensor alone would have. \
         A share far below 100 % means that other errors, shared by neighbours, add to the sensor’s noise. Growth: the variance is σ² (1 + κ a), with the activity a of the motion, whose mean is 1.</p>",
        table.html()
    )
}

/// Noise of each part of the log.
pub(super) fn reference_noise(calibration: &MachineCalibration) -> String {
    let mut table =
        Table::new("", &["reference", "sd of a sample", "unit", "growth κ", "outliers", "samples"]);
    for noise in &calibration.reference_noise {
        let (factor, unit) = match (noise.unit, noise.sd < 1e-4) {
            ("m", true) => (1e6, "µm"),
            ("m", false) => (1e3, "mm"),
            (_, true) => (1e6, "µrad"),
            (_, false) => (1e3, "mrad"),
        };
        table.row(vec![
            Cell::Name(noise.name.clone()),
            Cell::Number(number_format::significant(factor * noise.sd, 3)),
            Cell::Text(unit.into()),
            growth(noise.growth),
            Cell::Number(number_format::count(noise.outliers)),
            Cell::Number(number_format::count(noise.samples)),
        ]);
    }
    table.html()
}
