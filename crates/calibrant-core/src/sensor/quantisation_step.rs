//! The quantisation step: the resolution in which a sensor's readings come, found from the readings alone.

use super::{Recording, lesser};
use nalgebra::Vector3;

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
