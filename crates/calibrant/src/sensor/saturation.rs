//! Readings that stopped at the end of the sensor's range.

use super::{Axis, Recording};
use nalgebra::Vector3;

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
        let Some(&first) = self.readings.first() else { return Vec::new() };
        let (least, most) =
            self.readings.iter().fold((first, first), |(least, most), y| (least.inf(y), most.sup(y)));
        self.active_axes()
            .iter()
            .map(|&axis| (axis, [least[axis.index()], most[axis.index()]]))
            .filter(|(_, [least, most])| least < most)
            .flat_map(|(axis, ends)| [false, true].map(|is_largest| self.saturation(axis, ends, is_largest)))
            .flatten()
            .collect()
    }

    /// The longest stop at the least or the largest value, where it is far longer than any in between.
    fn saturation(&self, axis: Axis, ends: [f64; 2], is_largest: bool) -> Option<Saturation> {
        let value = ends[usize::from(is_largest)];
        let of = |reading: &Vector3<f64>| reading[axis.index()];
        let (mut samples, mut end, mut run) = (0, 0, 0);
        for (k, reading) in self.readings.iter().enumerate() {
            run = if of(reading) == value { run + 1 } else { 0 };
            if run > samples {
                (samples, end) = (run, k + 1);
            }
        }
        if samples < PLATEAU {
            return None;
        }
        let runs = self.readings.chunk_by(|one, next| of(one) == of(next));
        let elsewhere = runs.filter(|run| !ends.contains(&of(&run[0]))).map(<[_]>::len).max().unwrap_or(0);
        let first = end - samples;
        (samples > PLATEAU_RATIO * elsewhere).then_some(Saturation {
            axis,
            value,
            is_largest,
            first,
            samples,
        })
    }
}
