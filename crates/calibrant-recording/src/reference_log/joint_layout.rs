//! Where the positions of joints are among the columns: as the user says, or by their names.

use super::column_faults::{check_repeated, named, nothing_to_read};
use super::content::{Content, Values};
use super::joint_columns::{JointColumn, joint_column, rtde_column};
use super::log_columns::JointUnit;
use crate::text::decoding::{Checked, refuse};
use calibrant_core::error::Refusal;
use std::collections::BTreeMap;

/// The joints of a log of RTDE, whose columns have numbers; `None` where there are none.
pub(super) fn of_rtde(names: &[String]) -> Checked<Option<Values>> {
    let rtde: Vec<_> = names.iter().map(|name| rtde_column(name)).collect();
    let numbers = || rtde.iter().flatten().filter(|(_, is_velocity)| !is_velocity).map(|(number, _)| *number);
    let Some(last) = numbers().max() else { return Ok(None) };
    if let Some(missing) = (0..last).find(|number| !numbers().any(|known| known == *number)) {
        let message = format!("the column `actual_q_{missing}` is missing");
        let help = "record actual_q with all of its joints";
        return refuse(Refusal::ColumnMissing, message, help);
    }
    let joint = |number: usize| format!("actual_q_{number}");
    let column = |(number, is_velocity)| JointColumn {
        joint: joint(number),
        derivative: usize::from(is_velocity),
        turns: true,
        factor: 1.0,
    };
    let columns: Vec<_> = rtde.iter().map(|found| found.map(column)).collect();
    of_joints((0..=last).map(joint).collect(), names, &columns).map(Some)
}

/// The joints whose columns the user names.
pub(super) fn as_said(
    said: &BTreeMap<String, String>,
    unit: Option<JointUnit>,
    names: &[String],
) -> Checked<Values> {
    let mut columns = vec![None; names.len()];
    for (joint, name) in said {
        let column = named(names, name)?;
        let by_name = joint_column(name).filter(|of| of.derivative == 0);
        let by_unit = || joint_column(&format!("{joint}_{}", unit?.symbol()));
        let Some(found) = by_name.or_else(by_unit) else {
            let message = format!("nothing says the unit of the joint `{joint}` in the column `{name}`");
            let help = "joints_unit = \"rad\" (or \"deg\", \"m\", \"mm\") in [machine.log.columns]";
            return refuse(Refusal::UnitUnknown, message, help);
        };
        columns[column] = Some(JointColumn { joint: joint.clone(), ..found });
    }
    of_joints(said.keys().cloned().collect(), names, &columns)
}

/// The joints whose columns have their names and units.
pub(super) fn by_names(names: &[String]) -> Checked<Values> {
    let columns: Vec<_> = names.iter().map(|name| joint_column(name)).collect();
    let mut joints: Vec<String> = Vec::new();
    for column in columns.iter().flatten().filter(|column| column.derivative == 0) {
        if !joints.contains(&column.joint) {
            joints.push(column.joint.clone());
        }
    }
    if joints.is_empty() {
        return Err(nothing_to_read(names).into());
    }
    of_joints(joints, names, &columns)
}

/// The columns of these joints.
fn of_joints(joints: Vec<String>, names: &[String], columns: &[Option<JointColumn>]) -> Checked<Values> {
    let mut slots = vec![None; names.len()];
    let mut factors = vec![1.0; 3 * joints.len()];
    let mut has = [true, false, false];
    let mut turning = vec![None; joints.len()];
    for (k, column) in columns.iter().enumerate() {
        let Some(JointColumn { joint, derivative, turns, factor }) = column else { continue };
        let Some(number) = joints.iter().position(|known| known == joint) else { continue };
        let value = derivative * joints.len() + number;
        check_repeated(&slots, 1 + value, k, names)?;
        slots[k] = Some(1 + value);
        factors[value] = *factor;
        has[*derivative] = true;
        if *derivative == 0 {
            turning[number] = Some(*turns);
        }
    }
    let derivatives = has.iter().rposition(|has| *has).unwrap_or(0);
    factors.truncate((1 + derivatives) * joints.len());
    let content = Content::Joints { names: joints, turns: turning, has_velocities: has[1], derivatives };
    Ok(Values { content, slots, factors, assumed: None })
}
