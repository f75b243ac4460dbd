//! Axes in a sentence.

use crate::sensor::Axis;

/// `x_rot, y_rot and z_rot`: axes with an ending.
pub(crate) fn axes_in_words(axes: &[Axis], ending: &str) -> String {
    let names: Vec<String> = axes.iter().map(|axis| format!("{axis}{ending}")).collect();
    match names.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
        None => String::new(),
    }
}
