//! Saturation: readings that stopped at the end of the sensor's range.

use super::{Axis, Recording};
use nalgebra::Vector3;

/// Fewest samples of a plateau at the extreme value that counts as a stop.
const PLATEAU: usize = 8;
/// The plateau must be this many times longer than any plateau at another value. (The readings of a
/// stationary sensor repeat everywhere, or nowhere.)
const PLATEAU_RATIO: usize = 4;
/// No plateau at another value may be longer than this. Otherwise the noise is much finer than the
/// quantisation step. Holds then repeat their value throughout or not, depending on where between two steps
/// it lies. Noise of half a step seldom repeats a value 25 times in a recording.
const LONGEST_REPEAT: usize = 25;
/// Samples at the end of the range from which on a segment touches it: one sample may be a tail that just
/// reaches it.
const TOUCHES: usize = 2;

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

impl Saturation {
    /// Do readings of the same recording touch this end of the range?
    pub(crate) fn is_reached(&self, readings: &[Vector3<f64>]) -> bool {
        self.touches(readings) >= TOUCHES
    }

    /// How many readings of the same recording are at this end of the range.
    pub(crate) fn touches(&self, readings: &[Vector3<f64>]) -> usize {
        readings.iter().filter(|y| y[self.axis.index()] == self.value).count()
    }
}

impl Recording {
    /// Ends of the range at which an axis stopped for several samples in a row, far longer than it does at any other value.
    #[must_use]
    pub fn saturations(&self) -> Vec<Saturation> {
        let extremes = self.extremes();
        let stops = self.longest_stops(&extremes);
        let ends = |axis: Axis| extremes.map(|extreme| extreme[axis.index()]);
        self.active_axes()
            .iter()
            .flat_map(|&axis| [(axis, false), (axis, true)])
            .filter_map(|(axis, is_largest)| {
                let (ends, (samples, end)) = (ends(axis), stops[usize::from(is_largest)][axis.index()]);
                if samples < PLATEAU || ends[0] >= ends[1] {
                    return None;
                }
                let value = ends[usize::from(is_largest)];
                let first = end - samples;
                let elsewhere = self.longest_between(axis, ends);
                let stands_out = samples > PLATEAU_RATIO * elsewhere && elsewhere <= LONGEST_REPEAT;
                stands_out.then_some(Saturation { axis, value, is_largest, first, samples })
            })
            .collect()
    }

    /// For each axis, the longest run at each of these values: its number of samples and its end.
    fn longest_stops(&self, values: &[Vector3<f64>; 2]) -> [[(usize, usize); 3]; 2] {
        // number of samples and end of the last run
        let (mut longest, mut last) = ([[(0, 0); 3]; 2], [[(0, 0); 3]; 2]);
        for (k, reading) in self.readings.iter().enumerate() {
            for ((longest, last), value) in longest.iter_mut().zip(&mut last).zip(values) {
                for axis in 0..3 {
                    // this is rare, so most samples cost one comparison
                    if reading[axis] == value[axis] {
                        let (samples, end) = last[axis];
                        last[axis] = (if end == k { samples + 1 } else { 1 }, k + 1);
                        longest[axis] =
                            if last[axis].0 > longest[axis].0 { last[axis] } else { longest[axis] };
                    }
                }
            }
        }
        longest
    }

    /// The longest run of an axis at any value but these two.
    fn longest_between(&self, axis: Axis, ends: [f64; 2]) -> usize {
        let of = |reading: &Vector3<f64>| reading[axis.index()];
        let runs = self.readings.chunk_by(|one, next| of(one) == of(next));
        runs.filter(|run| !ends.contains(&of(&run[0]))).map(<[_]>::len).max().unwrap_or(0)
    }
}
