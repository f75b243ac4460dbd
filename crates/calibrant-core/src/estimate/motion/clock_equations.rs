//! The normal equations of parameters and clock, and the step of the clock that they give.

use crate::estimate::RecoveredClock;
use crate::information;
use crate::motion::MotionClock;
use nalgebra::{DMatrix, DVector};

/// The normal equations of parameters, delay and rate, without the motion and without what is known of the clock.
pub(super) struct ClockEquations {
    pub(super) information: DMatrix<f64>,
    pub(super) rhs: DVector<f64>,
}

/// A step of the clock, and the covariance of parameters, delay and rate.
pub(super) struct ClockStep {
    pub(super) delay_s: f64,
    pub(super) rate: f64,
    pub(super) covariance: DMatrix<f64>,
}

impl ClockEquations {
    /// The equations of several chains, which share only the clock.
    pub(super) fn sum(size: usize, parts: impl Iterator<Item = (Vec<usize>, Self)>) -> Self {
        let mut whole =
            Self { information: DMatrix::zeros(size + 2, size + 2), rhs: DVector::zeros(size + 2) };
        for (mut slots, part) in parts {
            slots.extend([size, size + 1]);
            for (i, &row) in slots.iter().enumerate() {
                whole.rhs[row] += part.rhs[i];
                for (j, &column) in slots.iter().enumerate() {
                    whole.information[(row, column)] += part.information[(i, j)];
                }
            }
        }
        whole
    }

    /// The step from this clock, with what is known of it. What is known exactly makes none. `None` where something is not determined.
    pub(super) fn step(&self, now: &RecoveredClock, given: &MotionClock) -> Option<ClockStep> {
        let size = self.rhs.len();
        let known =
            [(size - 2, given.delay_sd_s, given.delay_s - now.delay_s), (size - 1, given.rate_sd, -now.rate)];
        let (mut equations, mut rhs) = (self.information.clone(), self.rhs.clone());
        for (place, sd, less) in known {
            if sd > 0.0 {
                equations[(place, place)] += sd.powi(-2);
                rhs[place] += less / (sd * sd);
            }
        }
        let free: Vec<usize> =
            (0..size).filter(|k| known.iter().all(|(place, sd, _)| place != k || *sd > 0.0)).collect();
        let own = information::covariance(&equations.select_rows(&free).select_columns(&free))?;
        let mut covariance = DMatrix::zeros(size, size);
        for (i, &row) in free.iter().enumerate() {
            for (j, &column) in free.iter().enumerate() {
                covariance[(row, column)] = own[(i, j)];
            }
        }
        let step = &covariance * rhs;
        Some(ClockStep { delay_s: step[size - 2], rate: step[size - 1], covariance })
    }
}
