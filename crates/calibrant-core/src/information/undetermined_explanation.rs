//! The explanation of why a motion does not determine some parameters, in the user's words.

use super::Undetermined;
use crate::error::UndeterminedGroup;
use crate::number_format::plain;
use crate::sensor::{Axis, ParameterList, Quantity, SensorModel};
use nalgebra::Vector3;

/// The part of the motion that was examined when the information was found too small.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// The motion as commanded.
    Command,
    /// Its two ends alone.
    Ends,
    /// The motion with its process noise. Without that noise the commanded motion would suffice.
    Noise,
}

/// The facts about a motion in which the reasons are sought.
#[derive(Debug, Clone, Copy)]
pub struct MotionFacts<'a> {
    /// The sensor's model.
    pub model: SensorModel,
    /// Accelerations at the nodes.
    pub nodes: &'a [Vector3<f64>],
    /// Number of samples within the motion.
    pub samples: usize,
    /// The part of the motion that was examined.
    pub view: View,
}

/// Explains why the data cannot separate the parameters of each of these groups. `slots` are the places of
/// their parameters in the list.
#[must_use]
pub fn explain(
    list: &ParameterList,
    groups: &[Undetermined],
    slots: &[usize],
    facts: MotionFacts<'_>,
) -> Vec<UndeterminedGroup> {
    groups
        .iter()
        .map(|group| {
            let mut places: Vec<usize> = group.parameters.iter().map(|&k| slots[k]).collect();
            places.sort_unstable();
            let quantities: Vec<Quantity> = places.iter().map(|&k| list.quantities()[k]).collect();
            let (reason, remedy) = reason(facts, &quantities);
            UndeterminedGroup {
                parameters: quantities.iter().map(|quantity| quantity.name()).collect(),
                free_combinations: group.free_combinations,
                reason,
                remedy,
            }
        })
        .collect()
}

fn reason(facts: MotionFacts<'_>, quantities: &[Quantity]) -> (String, String) {
    let MotionFacts { model, nodes, samples, view } = facts;
    if view == View::Noise {
        return (
            "the process noise is so large beside the measurement noise that the command says nothing of the sensor".into(),
            "check motion.input_noise and sensor.noise_mps2, or use trust = \"unknown\" with both ends known".into(),
        );
    }
    let mut columns: Vec<Axis> = quantities
        .iter()
        .filter_map(|quantity| match *quantity {
            Quantity::Bias(_) | Quantity::Nonlinear(..) => None,
            Quantity::Scale(axis) | Quantity::CrossAxis(_, axis) | Quantity::Symmetric(_, axis) => Some(axis),
        })
        .collect();
    columns.sort_unstable();
    columns.dedup();
    if view == View::Ends {
        if model == SensorModel::Full {
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
                plain(nodes[0][axis.index()], 4)
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
                plain(nodes[0][axis.index()], 4)
            ),
            format!("move the sensor along axis {axis}"),
        ),
        [] => ("the samples are too few".into(), "record more".into()),
        [axis] => (
            format!("the {samples} samples within the motion see too little movement along axis {axis}"),
            "record more samples, or move more".into(),
        ),
        // several axes: a full sensor. Which of them depend on each other is chance
        _ if nodes.len() <= 3 => (
            format!(
                "the motion has {} nodes, too few for the accelerations along x, y and z to be independent of each other",
                nodes.len(),
            ),
            "use at least 3 intervals".into(),
        ),
        several => (
            format!("the accelerations along {} depend on each other linearly", words(several)),
            "move the axes independently of each other".into(),
        ),
    }
}

/// The axes as words: `x, y and z`.
fn words(axes: &[Axis]) -> String {
    match axes.split_last() {
        Some((last, [])) => last.to_string(),
        Some((last, rest)) => {
            format!("{} and {last}", rest.iter().map(Axis::to_string).collect::<Vec<_>>().join(", "))
        }
        None => String::new(),
    }
}
