//! Okabe–Ito colours, which readers with all common kinds of colour vision can distinguish.

pub(super) const BLACK: &str = "#000000";
pub(super) const ORANGE: &str = "#e69f00";
pub(super) const SKY: &str = "#56b4e9";
pub(super) const GREEN: &str = "#009e73";
pub(super) const BLUE: &str = "#0072b2";
pub(super) const VERMILLION: &str = "#d55e00";
pub(super) const PURPLE: &str = "#cc79a7";
pub(super) const YELLOW: &str = "#f0e442";
pub(super) const BROWN: &str = "#7f4f24";
pub(super) const GREY: &str = "#6e7781";
/// Those of the axes x, y and z.
pub(super) const AXES: [&str; 3] = [VERMILLION, GREEN, BLUE];

#[cfg(feature = "study")]
/// The look of each of many lines: a colour and SVG's dashes. The first ten have colours of their own, which also differ in lightness from
/// their neighbours.
pub(super) fn look(place: usize) -> (&'static str, &'static str) {
    const COLOURS: [&str; 10] =
        [BLACK, ORANGE, BLUE, SKY, VERMILLION, GREEN, PURPLE, GREY, "#8f8600", "#5d3a9b"];
    const DASHES: [&str; 3] = ["", "7 3", "2 3"];
    (COLOURS[place % COLOURS.len()], DASHES[(place / (COLOURS.len() / 2)) % DASHES.len()])
}
