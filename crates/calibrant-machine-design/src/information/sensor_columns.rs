//! The sensor's parameters as combinations of the 24 entries of two full sensors.

use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::{Axis, ImuQuantity, Quantity};
use nalgebra::DMatrix;

/// Number of entries: for each sensor and row, the bias and three of the matrix.
pub(crate) const ENTRIES: usize = 24;

/// The place of an entry: sensor (0, 1), row, and 0 for the bias or 1 + column.
pub(crate) fn entry(sensor: usize, row: usize, column: usize) -> usize {
    12 * sensor + 4 * row + column
}

/// The map from parameters to entries.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SensorColumns {
    /// 24 × p.
    pub(crate) entries: DMatrix<f64>,
    /// The entries of each parameter: one, or two that are equal.
    places: Vec<Vec<usize>>,
}

impl SensorColumns {
    /// # Errors
    /// A quantity that no motion of a machine determines: a temperature coefficient, or the g-sensitivity, which is not designed for.
    pub(crate) fn new(quantities: &[ImuQuantity]) -> Result<Self> {
        let refused = |quantity: &ImuQuantity| {
            Err(Error::experiment(InputError::new(
                Refusal::ValueInvalid,
                format!("a trajectory cannot be designed for {}", quantity.name()),
                "leave it out of the parameters of the design",
            )))
        };
        let mut entries = DMatrix::zeros(ENTRIES, quantities.len());
        for (k, quantity) in quantities.iter().enumerate() {
            let ImuQuantity::Of(kind, of) = *quantity else { return refused(quantity) };
            let sensor = kind as usize;
            let mut set = |row: Axis, column: usize| entries[(entry(sensor, row.index(), column), k)] = 1.0;
            match of {
                Quantity::Bias(axis) => set(axis, 0),
                Quantity::Scale(axis) => set(axis, 1 + axis.index()),
                Quantity::CrossAxis(row, column) => set(row, 1 + column.index()),
                Quantity::Symmetric(row, column) => {
                    set(row, 1 + column.index());
                    set(column, 1 + row.index());
                }
                Quantity::Nonlinear(..) => return refused(quantity),
            }
        }
        let of = |column: usize| (0..ENTRIES).filter(|row| entries[(*row, column)] != 0.0).collect();
        Ok(Self { places: (0..entries.ncols()).map(of).collect(), entries })
    }

    /// Number of parameters.
    pub(crate) fn len(&self) -> usize {
        self.entries.ncols()
    }

    /// `Lᵀ F L`: the information on the parameters from that on the entries.
    pub(crate) fn of_parameters(&self, entries: &DMatrix<f64>) -> DMatrix<f64> {
        let p = self.len();
        let of = |a: usize, b: usize| {
            self.places[a].iter().flat_map(move |i| self.places[b].iter().map(move |j| (*i, *j)))
        };
        DMatrix::from_fn(p, p, |a, b| of(a, b).map(|place| entries[place]).sum())
    }

    /// `L Ω Lᵀ`.
    pub(crate) fn of_entries(&self, parameters: &DMatrix<f64>) -> DMatrix<f64> {
        let mut entries = DMatrix::zeros(ENTRIES, ENTRIES);
        for (a, rows) in self.places.iter().enumerate() {
            for (b, columns) in self.places.iter().enumerate() {
                for (i, j) in rows.iter().flat_map(|i| columns.iter().map(move |j| (*i, *j))) {
                    entries[(i, j)] += parameters[(a, b)];
                }
            }
        }
        entries
    }
}
