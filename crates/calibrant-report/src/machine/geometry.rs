//! Corrections of the machine's geometry and zero offsets.

use super::quantity::machine_unit;
use crate::figure::correction_bars;
use crate::number_format::significant;
use crate::sheet::{Cell, Section, Table};
use calibrant_machine::estimate::{MachineCalibration, MachineQuantity, MachineSetup};

/// The corrections in prior standard deviations and in their units; `None` where none were estimated.
pub(super) fn corrections<'a>(
    calibration: &'a MachineCalibration,
    setup: &'a MachineSetup,
) -> Option<Section<'a>> {
    let mut section = Section::new("Geometry").lead("How the machine differs from its file, each correction held near 0 by what was known beforehand. Translations and rotations are in the frame of the joint.");
    section.paragraph(largest(calibration, setup)?);
    section.drawn(|| bars(calibration, setup));
    let mut within = Section::default();
    within.table(table(calibration, setup));
    section.folded("Table of the corrections", within);
    Some(section)
}

fn of_joint(joint: usize) -> impl Iterator<Item = MachineQuantity> {
    let geometry = (0..6).map(move |k| MachineQuantity::Geometry(joint, k));
    std::iter::once(MachineQuantity::Zero(joint)).chain(geometry)
}

fn prior_sd(calibration: &MachineCalibration, setup: &MachineSetup, quantity: MachineQuantity) -> f64 {
    setup.prior_sd(quantity, calibration.noise.len())
}

/// The joint whose correction is the farthest from what its file says, in what was known of it.
fn largest(calibration: &MachineCalibration, setup: &MachineSetup) -> Option<String> {
    let estimated = (0..calibration.joints.len()).flat_map(of_joint).filter_map(|quantity| {
        let (value, _) = calibration.estimate(quantity)?;
        Some((quantity, value.abs() / prior_sd(calibration, setup, quantity)))
    });
    let estimated: Vec<_> = estimated.collect();
    let (quantity, deviations) = estimated.iter().max_by(|one, other| one.1.total_cmp(&other.1))?;
    Some(format!(
        "{} corrections of the joints, the largest {} standard deviations of what is known ({}).",
        estimated.len(),
        significant(*deviations, 2),
        quantity.name(&calibration.joints)
    ))
}

fn bars(calibration: &MachineCalibration, setup: &MachineSetup) -> String {
    let scaled = |quantity: MachineQuantity| {
        let (value, sd) = calibration.estimate(quantity)?;
        let prior = prior_sd(calibration, setup, quantity);
        prior.is_finite().then(|| (value / prior, sd / prior))
    };
    let rows: Vec<(String, Vec<_>)> = (calibration.joints.iter().enumerate())
        .map(|(joint, name)| (name.clone(), of_joint(joint).map(scaled).collect()))
        .collect();
    correction_bars(&["zero", "x", "y", "z", "about x", "about y", "about z"], &rows)
}

fn table(calibration: &MachineCalibration, setup: &MachineSetup) -> Table {
    let mut table = Table::new(["correction", "estimate ± sd", "prior sd", "unit"]);
    for quantity in (0..calibration.joints.len()).flat_map(of_joint) {
        let Some((value, sd)) = calibration.estimate(quantity) else { continue };
        let (factor, unit) = machine_unit(calibration, quantity);
        table.row(vec![
            Cell::Name(quantity.name(&calibration.joints)),
            Cell::estimate(factor * value, factor * sd),
            Cell::short(factor * prior_sd(calibration, setup, quantity)),
            Cell::unit(unit),
        ]);
    }
    table
}
