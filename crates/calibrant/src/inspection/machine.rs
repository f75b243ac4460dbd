//! The joints of a machine.

use calibrant_io::{Urdf, missing_limits};
use calibrant_machine::chain::{Joint, JointKind, KinematicChain, reach_m};
use calibrant_report::number_format::{UNKNOWN, counted, short, significant};
use calibrant_report::{Cell, Section, Sheet, Table};

/// A machine as a sheet: the joints of a chain of it with their limits, and what is missing. `name`: what the file is called.
#[must_use]
pub fn chain_sheet(machine: &Urdf, chain: &KinematicChain, name: &str) -> Sheet<'static> {
    let links = counted(machine.links().count(), "link");
    let mut section = Section::new(format!("{name}: machine {}, {links}", machine.name));
    let reach = reach_m(chain).map_or_else(String::new, |of| format!(", reach {} m", significant(of, 3)));
    let joints = counted(chain.joints.len(), "joint");
    section.paragraph(format!("from {} to {}: {joints}{reach}", chain.base, chain.tip));
    let mut table = Table::new(["joint", "kind", "position", "velocity", "effort"]);
    chain.joints.iter().for_each(|joint| table.row(row(joint)));
    section.table(table);
    for joint in &chain.joints {
        let missing = missing_limits(joint);
        if !missing.is_empty() {
            section.paragraph(format!("joint {}: no limit of {}", joint.name, missing.join(", ")));
        }
    }
    section.paragraph(match chain.joints.is_empty() {
        true => "No joint moves between them.",
        false => "URDF has no limits of acceleration and jerk.",
    });
    Sheet { title: name.to_owned(), sections: vec![section], ..Sheet::default() }
}

fn row(joint: &Joint) -> Vec<Cell> {
    let unit = joint.kind.unit();
    let effort_unit = if joint.kind.turns() { "N·m" } else { "N" };
    let limits = &joint.limits;
    let end = |value: Option<f64>| value.map_or_else(|| UNKNOWN.to_owned(), short);
    let with_unit = |value: Option<f64>, unit: &str| {
        value.map_or(Cell::Missing, |value| Cell::Number(format!("{} {unit}", short(value))))
    };
    vec![
        Cell::name(&joint.name),
        Cell::text(joint.kind.name()),
        match joint.kind {
            JointKind::Continuous => Cell::text("any"),
            _ => Cell::Number(format!("{} to {} {unit}", end(limits.lower), end(limits.upper))),
        },
        with_unit(limits.velocity, &format!("{unit}/s")),
        with_unit(limits.effort, effort_unit),
    ]
}
