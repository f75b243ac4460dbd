//! Okabe–Ito colours, told apart by all common kinds of colour vision.

pub(super) const BLACK: &str = "#000000";
pub(super) const ORANGE: &str = "#e69f00";
pub(super) const SKY: &str = "#56b4e9";
pub(super) const GREEN: &str = "#009e73";
pub(super) const BLUE: &str = "#0072b2";
pub(super) const VERMILLION: &str = "#d55e00";
pub(super) const GREY: &str = "#6e7781";
