//! Parameters and motion that the recording cannot determine, in words.

use super::Axis;
use super::context::Context;
use crate::arrowhead;
use crate::error::UndeterminedGroup;
use crate::information::{MotionFacts, Undetermined, explain as explain_motion, with_biases};

pub(super) use crate::information::View;

/// The reason why these groups of parameters cannot be separated. `slots` are the chain's parameters in the list.
pub(super) fn explain(
    context: &Context<'_>,
    groups: &[Undetermined],
    slots: &[usize],
    view: View,
) -> Vec<UndeterminedGroup> {
    let facts = MotionFacts {
        model: context.problem.sensor.model,
        nodes: context.command.motion.acceleration_mps2(),
        samples: context.positions.samples(),
        view,
    };
    let list = context.problem.sensor.parameter_list();
    let groups = with_biases(groups, &list, slots, context.command.gravity.as_ref());
    let mut groups = explain_motion(&list, &groups, slots, facts);
    for name in groups.iter_mut().flat_map(|group| &mut group.parameters) {
        *name = format!("accelerometer.{name}");
    }
    groups
}

/// The part of the motion that the samples do not determine, in words.
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
