//! What the readings alone show of their digits: saturation at the end of the range, and the quantisation step.

use super::{Axis, Recording, lesser};
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

/// Steps up to this multiple of the smallest are examined; larger ones show little.
const LARGEST_MULTIPLE: f64 = 8.0;
/// Steps are multiples of the smallest if this share of them is within a fifth of a multiple. For readings
/// that are not quantised, two in five are so by chance.
const MULTIPLES: f64 = 0.95;
/// A step is a multiple of the smallest within this share of it.
const MULTIPLE_TOLERANCE: f64 = 0.2;
/// Fewer steps determine nothing.
const FEWEST_STEPS: usize = 8;
/// Number of changes that are examined. More of them add nothing: steps that matter occur in every few
/// changes.
const MOST_STEPS: usize = 8192;

impl Recording {
    /// The quantisation step of each axis, in the unit of the readings. The readings are multiples of it. 0 without a step.
    ///
    /// It is the smallest change from one sample to the next, if the other small changes are multiples of it.
    /// A long recording is examined at some thousands of changes, spread evenly over it.
    #[must_use]
    pub fn resolution(&self) -> Vector3<f64> {
        let every = (self.len() / MOST_STEPS).max(1);
        let changes = || {
            let pairs = self.readings.windows(2).step_by(every);
            // no branch: the processor could not predict it
            pairs.map(|pair| {
                (pair[1] - pair[0]).abs().map(|step| if step > 0.0 { step } else { f64::INFINITY })
            })
        };
        let smallest =
            changes().fold(Vector3::repeat(f64::INFINITY), |least, step| least.zip_map(&step, lesser));
        let (mut near, mut multiples) = ([0_usize; 3], [0_usize; 3]);
        for step in changes() {
            for axis in 0..3 {
                let ratio = step[axis] / smallest[axis];
                if ratio < LARGEST_MULTIPLE {
                    near[axis] += 1;
                    multiples[axis] +=
                        usize::from((ratio - f64::from((ratio + 0.5) as i32)).abs() < MULTIPLE_TOLERANCE);
                }
            }
        }
        Vector3::from_fn(|axis, _| {
            let enough =
                near[axis] >= FEWEST_STEPS && multiples[axis] as f64 >= MULTIPLES * near[axis] as f64;
            if enough { smallest[axis] } else { 0.0 }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::ReadingUnit;

    #[test]
    fn readings_that_are_rounded_have_a_step_and_others_have_none() {
        let wave =
            |k: usize, axis: f64| (0.37 * (k as f64).powf(1.1) + axis).sin() + 0.2 * (1.7 * k as f64).cos();
        let rounded = |y: f64, step: f64| (y / step).round() * step;
        let readings =
            |k| Vector3::new(rounded(wave(k, 0.0), 0.01), wave(k, 1.0), rounded(wave(k, 2.0), 1.0 / 16.4));
        let recording = Recording {
            times_s: (0..2000).map(f64::from).collect(),
            readings: (0..2000).map(readings).collect(),
            axes: 3,
            unit: ReadingUnit::RadianPerSecond,
        };
        let found = recording.resolution();
        assert!((found - Vector3::new(0.01, 0.0, 1.0 / 16.4)).amax() < 1e-12, "{found}");
    }
}
