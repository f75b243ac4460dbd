//! Cells that several tables have.

use crate::aging::QuantityAging;
use calibrant_report::Cell;

/// A short text, where it is known.
pub(super) fn text_or_missing(of: Option<impl ToString>) -> Cell {
    of.map_or(Cell::Missing, |of| Cell::Text(of.to_string()))
}

/// The change per year with its standard deviation, and the unit. Angles are in degrees.
pub(super) fn per_year(QuantityAging { unit, aging, .. }: &QuantityAging) -> [Cell; 2] {
    let (scale, unit) = if *unit == "rad" { (1f64.to_degrees(), "°") } else { (1.0, *unit) };
    [Cell::estimate(scale * aging.per_year, scale * aging.sd), Cell::unit(unit)]
}
