//! Tables of the noise of the sensors and of the reference.

use crate::figure::DisplayUnit;
use crate::sheet::{Cell, Column, Table};
use calibrant_core::sensor::Axis;
use calibrant_machine::estimate::MachineCalibration;

fn growth(factor: Option<f64>) -> Cell {
    factor.map_or_else(|| Cell::Number("none".into()), |factor| Cell::significant(factor, 2))
}

pub(super) fn sensor_noise(calibration: &MachineCalibration) -> Table {
    let mut table = Table::new([
        Column::new("sensor"),
        Column::new("at rest").noted("standard deviation of one sample where the machine does not move"),
        Column::on_page("white part").noted(
            "what neighbouring samples do not share, which the sensor alone would have. A share far below 100 % means that other errors, shared by neighbours, \
             add to the sensor’s noise",
        ),
        Column::on_page("white / at rest"),
        Column::on_page("rms of residuals"),
        Column::new("unit"),
        Column::new("growth κ").noted("the variance is σ² (1 + κ a), with the activity a of the motion, whose mean is 1"),
        Column::on_page("samples"),
    ]);
    for noise in &calibration.noise {
        let symbol = calibration.sensors.unit(noise.sensor).symbol();
        let unit = DisplayUnit::suited_to(symbol, noise.rms.iter().chain(&noise.noise).copied());
        let number = |value: f64| Cell::significant(unit.factor * value, 3);
        for axis in Axis::ALL {
            let k = axis.index();
            table.row(vec![
                Cell::name(format!("{} {axis}", noise.sensor)),
                number(noise.noise[k]),
                number(noise.white_noise[k]),
                Cell::percent(noise.white_noise[k] / noise.noise[k]),
                number(noise.rms[k]),
                Cell::unit(unit.symbol),
                growth(noise.growth),
                Cell::count(noise.residuals.len()),
            ]);
        }
    }
    table
}

pub(super) fn reference_noise(calibration: &MachineCalibration) -> Table {
    let mut table = Table::new([
        Column::new("reference"),
        Column::new("sd of a sample"),
        Column::new("unit"),
        Column::new("growth κ"),
        Column::new("outliers"),
        Column::on_page("samples"),
    ]);
    for noise in &calibration.reference_noise {
        let (factor, unit) = match (noise.unit, noise.sd < 1e-4) {
            ("m", true) => (1e6, "µm"),
            ("m", false) => (1e3, "mm"),
            (_, true) => (1e6, "µrad"),
            (_, false) => (1e3, "mrad"),
        };
        table.row(vec![
            Cell::name(&*noise.name),
            Cell::significant(factor * noise.sd, 3),
            Cell::unit(unit),
            growth(noise.growth),
            Cell::count(noise.outliers),
            Cell::count(noise.samples),
        ]);
    }
    table
}
