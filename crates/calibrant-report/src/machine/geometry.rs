//! Corrections of the machine's geometry and zero offsets.

use super::quantity::machine_unit;
use crate::figure::correction_bars;
use crate::number_format;
use crate::table::{Cell, Table};
use calibrant_machine::estimate::{MachineCalibration, MachineQuantity, MachineSetup};

/// The corrections in prior standard deviations and in their units; `None` where none were estimated.
pub(super) fn corrections(calibration: &MachineCalibration, setup: &MachineSetup) -> Option<String> {
    let of_joint = |joint: usize| {
        let geometry = (0..6).map(move |k| MachineQuantity::Geometry(joint, k));
        std::iter::once(MachineQuantity::Zero(joint)).chain(geometry)
    };
    let all = || (0..calibration.joints.len()).flat_map(of_joint);
    all().find_map(|quantity| calibration.position(quantity))?;
    let scaled = |quantity: MachineQuantity| {
        let (value, sd) = calibration.estimate(quantity)?;
        let prior = setup.prior_sd(quantity, calibration.noise.len());
        prior.is_finite().then(|| (value / prior, sd / prior))
    };
    let rows: Vec<(String, Vec<_>)> = (calibration.joints.iter().enumerate())
        .map(|(joint, name)| (name.clone(), of_joint(joint).map(scaled).collect()))
        .collect();
    let mut table = Table::new("", &["correction", "estimate ± sd", "prior sd", "unit"]);
    for quantity in all() {
        let Some((value, sd)) = calibration.estimate(quantity) else { continue };
        let (factor, unit) = machine_unit(calibration, quantity);
        let prior = factor * setup.prior_sd(quantity, calibration.noise.len());
        table.row(vec![
            Cell::Name(quantity.name(&calibration.joints)),
            Cell::Number(number_format::with_sd(factor * value, factor * sd)),
            Cell::Number(number_format::short(prior)),
            Cell::Text(unit.into()),
        ]);
    }
    let columns = ["zero", "x", "y", "z", "about x", "about y", "about z"];
    Some(format!(
        "{}<details><summary>Table of the corrections</summary>{}</details>",
        correction_bars(&columns, &rows),
        table.html()
    ))
}
