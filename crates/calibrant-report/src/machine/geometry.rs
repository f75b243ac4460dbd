//! Corrections of the machine's geometry and zero offsets.

use super::quantity::{prior_sd, unit_of};
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
        let prior = prior_sd(calibration, setup, quantity);
        prior.is_finite().then(|| (value / prior, sd / prior))
    };
    let rows: Vec<(String, Vec<_>)> = (calibration.joints.iter().enumerate())
        .map(|(joint, name)| (name.clone(), of_joint(joint).map(scaled).collect()))
        .collect();
    let mut table = Table::new("", &["correction", "estimate ± sd", "prior sd", "unit"]);
    for quantity in all() {
        let Some((value, sd)) = calibration.estimate(quantity) else { continue };
        let (factor, unit) = unit_of(calibration, quantity);
        let prior = factor * prior_sd(calibration, setup, quantity);
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
