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
        let mut rhs = DVector::zeros(size + 2);
        let mut blocks = Vec::new();
        for (slots, part) in parts {
            for (place, value) in slots.iter().chain(&[size, size + 1]).zip(part.rhs.iter()) {
                rhs[*place] += value;
            }
            blocks.push((part.information, slots));
        }
        Self { information: information::spread(&blocks, size), rhs }
    }

    /// The step from this clock, with what is known of it. What is known exactly makes none. `None` where something is not determined.
    pub(super) fn step(&self, now: &RecoveredClock, given: &MotionClock) -> Option<ClockStep> {
        let size = self.rhs.len();
        let mut rhs = self.rhs.clone();
        let mut covariance =
            information::covariance(&information::with_known_clock(self.information.clone(), given))?;
        let known =
            [(size - 2, given.delay_sd_s, given.delay_s - now.delay_s), (size - 1, given.rate_sd, -now.rate)];
        for (place, sd, less) in known {
            if sd > 0.0 {
                rhs[place] += less / (sd * sd);
            } else {
                covariance[(place, place)] = 0.0;
            }
        }
        let step = &covariance * rhs;
        Some(ClockStep { delay_s: step[size - 2], rate: step[size - 1], covariance })
    }
}
