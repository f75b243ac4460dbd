//! Units that keep the numbers on an axis readable.

use crate::number_format::significant;
use crate::sheet::Cell;

/// A unit for display: multiply by the factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DisplayUnit {
    /// Displayed number over number in the original unit.
    pub(crate) factor: f64,
    /// Symbol; empty for a pure number.
    pub(crate) symbol: &'static str,
}

impl DisplayUnit {
    /// A unit that shows `largest`, given in `unit`, without leading zeros: mm/s² or µm/s² for m/s², mrad/s for rad/s, the same for a g-sensitivity, % or ppm
    /// for `1`.
    pub(crate) fn suited(unit: &'static str, largest: f64) -> Self {
        let small = largest > 0.0 && largest < 0.03;
        match unit {
            "1" if small && largest > 2e-3 => Self { factor: 100.0, symbol: "%" },
            "m/s²" if small && largest < 3e-5 => Self { factor: 1e6, symbol: "µm/s²" },
            "m/s²" if small => Self { factor: 1e3, symbol: "mm/s²" },
            "rad/s" if small => Self { factor: 1e3, symbol: "mrad/s" },
            "(rad/s)/(m/s²)" if small => Self { factor: 1e3, symbol: "(mrad/s)/(m/s²)" },
            "1" if small => Self { factor: 1e6, symbol: "ppm" },
            "1" => Self { factor: 1.0, symbol: "" },
            other => Self { factor: 1.0, symbol: other },
        }
    }

    /// The same, suited to the largest magnitude of these values.
    pub(crate) fn suited_to(unit: &'static str, values: impl IntoIterator<Item = f64>) -> Self {
        Self::suited(
            unit,
            values.into_iter().filter(|v| v.is_finite()).fold(0.0, |most, v| most.max(v.abs())),
        )
    }

    /// A number in the original unit, with this many significant digits: `1.2 mm/s²`.
    pub(crate) fn text(self, value: f64, digits: usize) -> String {
        format!("{} {}", significant(value * self.factor, digits), self.symbol).trim_end().to_owned()
    }

    /// The cell of the unit in a table: `unit` on terminals, this one on pages.
    pub(crate) fn cell(self, unit: &str) -> Cell {
        Cell::Unit { symbol: unit.to_owned(), on_page: self.symbol.to_owned() }
    }

    /// A label with this unit: `residual (mm/s²)`.
    pub(crate) fn label(self, quantity: &str) -> String {
        if self.symbol.is_empty() { quantity.to_string() } else { format!("{quantity} ({})", self.symbol) }
    }
}
