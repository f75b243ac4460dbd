//! The script of the figures.

/// Shows values, and zooms, in panels that state the ranges of their axes. It reads the drawings and the legends.
pub(crate) const CHART_SCRIPT: &str = include_str!("chart.js");
