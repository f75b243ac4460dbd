//! Readings that stopped at the end of the sensor's range.

use super::{Axis, Recording};

/// A plateau at the extreme value is noticed from this many samples on …
const PLATEAU: usize = 8;
/// … if it is this many times longer than any plateau at another value. (The readings of a sensor that lies still repeat
/// everywhere, or nowhere.)
const PLATEAU_RATIO: usize = 4;

/// The end of its range at which an axis stopped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Saturation {
    /// The axis.
    pub axis: Axis,
    /// The value that it did not pass, in the unit of the readings.
    pub value: f64,
    /// Is it the largest value? Otherwise it is the smallest.
    pub is_largest: bool,
    /// First sample of the longest stop, from 0.
    pub first: usize,
    /// Number of samples of the longest stop.
    pub samples: usize,
}

impl Recording {
    /// Ends of the range at which an axis stopped for several samples in a row, far longer than it does at any other value.
    #[must_use]
    pub fn saturations(&self) -> Vec<Saturation> {
        self.active_axes().iter().flat_map(|&axis| self.saturations_of(axis)).collect()
    }

    fn saturations_of(&self, axis: Axis) -> Vec<Saturation> {
        let of = |reading: &nalgebra::Vector3<f64>| reading[axis.index()];
        let (least, most) = self
            .readings
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), y| (l.min(of(y)), m.max(of(y))));
        if least >= most {
            return Vec::new();
        }
        // the longest runs: at the least value, at the largest (length and first sample), and anywhere else
        let (mut at_least, mut at_most, mut elsewhere) = ((0, 0), (0, 0), 0);
        let mut first = 0;
        for run in self.readings.chunk_by(|one, next| of(one) == of(next)) {
            let (value, length) = (of(&run[0]), run.len());
            if value == least && length > at_least.0 {
                at_least = (length, first);
            } else if value == most && length > at_most.0 {
                at_most = (length, first);
            } else if value != least && value != most {
                elsewhere = elsewhere.max(length);
            }
            first += length;
        }
        [(least, at_least, false), (most, at_most, true)]
            .into_iter()
            .filter(|(_, (samples, _), _)| *samples >= PLATEAU && *samples > PLATEAU_RATIO * elsewhere)
            .map(|(value, (samples, first), is_largest)| Saturation {
                axis,
                value,
                is_largest,
                first,
                samples,
            })
            .collect()
    }
}
