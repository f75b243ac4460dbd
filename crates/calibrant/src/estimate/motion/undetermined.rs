//! What the recording cannot determine, in the user's words.

use super::Axis;
use super::chain::Context;
use crate::arrowhead;
use crate::error::UndeterminedGroup;
use crate::information::Undetermined;
use crate::sensor::{Quantity, SensorModel};

/// What was looked at when the information was found wanting.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum View {
    /// The motion as commanded.
    Command,
    /// Its two ends alone.
    Ends,
    /// The motion with its process noise; as commanded, it would do.
    Noise,
}

/// Says why these groups of parameters cannot be told apart. `slots` are the chain's parameters in the list.
pub(super) fn explain(
    context: &Context<'_>,
    groups: &[Undetermined],
    slots: &[usize],
    view: View,
) -> Vec<UndeterminedGroup> {
    let list = context.problem.sensor.parameter_list();
    groups
        .iter()
        .map(|group| {
            let mut places: Vec<usize> = group.parameters.iter().map(|&k| slots[k]).collect();
            places.sort_unstable();
            let quantities: Vec<Quantity> = places.iter().map(|&k| list.quantities()[k]).collect();
            let (reason, remedy) = reason(context, &quantities, view);
            UndeterminedGroup {
                parameters: quantities.iter().map(|quantity| quantity.name()).collect(),
                free_combinations: group.free_combinations,
                reason,
                remedy,
            }
        })
        .collect()
}

fn reason(context: &Context<'_>, quantities: &[Quantity], view: View) -> (String, String) {
    if view == View::Noise {
        return (
            "the process noise is so large beside the measurement noise that the command says nothing of the sensor".into(),
            "check motion.input_noise and sensor.noise_mps2, or use trust = \"unknown\" with both ends known".into(),
        );
    }
    let samples = context.positions.samples();
    let nodes = context.command.motion.acceleration_mps2();
    let mut columns: Vec<Axis> = quantities
        .iter()
        .filter_map(|quantity| match *quantity {
            Quantity::Bias(_) => None,
            Quantity::Scale(axis) | Quantity::CrossAxis(_, axis) | Quantity::Symmetric(_, axis) => Some(axis),
        })
        .collect();
    columns.sort_unstable();
    columns.dedup();
    if view == View::Ends {
        if context.problem.sensor.model == SensorModel::Full {
            return (
                "with an unknown motion only the two known ends speak of the sensor: two equations for the four unknowns of each \
                 reading (its bias and its row of S)"
                    .into(),
                "use model = \"scale-bias\", or trust = \"known\" or \"noisy\", or give a prior".into(),
            );
        }
        let axis = columns.first().map_or(Axis::X, |&axis| axis);
        return (
            format!(
                "axis {axis} has the same acceleration, {} m/s², at both ends, and with trust unknown only the ends speak of the sensor",
                short(nodes[0][axis.index()])
            ),
            format!("let axis {axis} end at another acceleration than it starts with"),
        );
    }
    if samples < 2 {
        return (format!("only {samples} sample lies within the motion"), "record more".into());
    }
    let still = |axis: Axis| {
        nodes
            .iter()
            .all(|a| (a[axis.index()] - nodes[0][axis.index()]).abs() <= 1e-9 * nodes[0][axis.index()].abs())
    };
    match columns.as_slice() {
        [axis] if still(*axis) => (
            format!(
                "axis {axis} does not move, its acceleration is {} m/s² throughout",
                short(nodes[0][axis.index()])
            ),
            format!("move the sensor along axis {axis}"),
        ),
        [] => ("the samples are too few".into(), "record more".into()),
        [axis] => (
            format!("the {samples} samples within the motion see too little movement along axis {axis}"),
            "record more samples, or move more".into(),
        ),
        several => (
            format!("the accelerations along {} depend on each other linearly", words(several)),
            "move the axes independently of each other".into(),
        ),
    }
}

/// A number to four decimals, without zeros behind.
fn short(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// `x, y and z`
fn words(axes: &[Axis]) -> String {
    match axes.split_last() {
        Some((last, [])) => last.to_string(),
        Some((last, rest)) => {
            format!("{} and {last}", rest.iter().map(Axis::to_string).collect::<Vec<_>>().join(", "))
        }
        None => String::new(),
    }
}

/// Says which part of the motion the samples do not determine.
pub(super) fn explain_node<const D: usize>(
    context: &Context<'_>,
    axes: [usize; D],
    at: arrowhead::Undetermined,
) -> UndeterminedGroup {
    let axis = Axis::ALL[axes[at.coordinate]];
    UndeterminedGroup {
        parameters: Vec::new(),
        free_combinations: 1,
        reason: format!(
            "the motion itself is not determined: too few samples to tell the acceleration along {axis} at {} s",
            context.command.motion.times_s()[at.node]
        ),
        remedy:
            "sample faster than the motion's intervals, close the recording's gaps, or use trust = \"noisy\""
                .into(),
    }
}
