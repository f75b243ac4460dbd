//! Okabe–Ito colours, which readers with all common kinds of colour vision can distinguish.

/// Black.
pub(super) const BLACK: &str = "#000000";
/// Orange.
pub(super) const ORANGE: &str = "#e69f00";
/// Sky blue.
pub(super) const SKY: &str = "#56b4e9";
/// Bluish green.
pub(super) const GREEN: &str = "#009e73";
/// Blue.
pub(super) const BLUE: &str = "#0072b2";
/// Vermillion, an orange red.
pub(super) const VERMILLION: &str = "#d55e00";
/// Grey.
pub(super) const GREY: &str = "#6e7781";
