//! The design problem: sensor, motion grid, limits and criterion.

use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::information::{Criterion, MotionInformation};
use calibrant_core::motion::{KnownEnds, Limits, Trust};
use calibrant_core::sensor::{Axis, Sensor, SensorModel, SensorParameters};
use nalgebra::DMatrix;

/// Find the motion whose recording determines the parameters best:
///
/// `minimise over a: Φ(Σ_p(a, p̄))` subject to the limits, the report's (4).
#[derive(Debug, Clone)]
pub struct DesignProblem<'a> {
    /// The datasheet.
    pub sensor: &'a Sensor,
    /// The guess `p̄` at which the information is taken: nominal, or the last calibration.
    pub at: SensorParameters,
    /// Number of intervals N.
    pub intervals: usize,
    /// Their duration Δτ, s.
    pub interval_s: f64,
    /// Sample rate, Hz.
    pub rate_hz: f64,
    /// How far the motion will be trusted.
    pub trust: Trust,
    /// Which ends of the motion will be known.
    pub known_ends: KnownEnds,
    /// The limits of the arm.
    pub limits: &'a Limits,
    /// The criterion that is minimised.
    pub criterion: Criterion,
    /// Information that is there already: a prior, or earlier recordings (p × p, in the order of the parameter list).
    pub prior: Option<DMatrix<f64>>,
}

impl DesignProblem<'_> {
    /// The limits with the sensor's range among them.
    #[must_use]
    pub fn effective_limits(&self) -> Limits {
        self.limits.within_range(self.sensor.range_mps2)
    }

    /// The conditions of the experiment.
    ///
    /// # Errors
    /// As [`MotionInformation::new`].
    pub fn setting(&self) -> Result<MotionInformation> {
        MotionInformation::new(self.sensor, self.at, self.trust, self.known_ends, self.rate_hz)
    }

    /// Groups of axes that share nothing, and so can be designed one after the other. They are every axis of
    /// a scale-bias sensor, and all axes of a full one.
    #[must_use]
    pub fn parts(&self) -> Vec<Vec<Axis>> {
        let axes = self.sensor.active_axes();
        if self.sensor.model == SensorModel::Full {
            vec![axes.to_vec()]
        } else {
            axes.iter().map(|&axis| vec![axis]).collect()
        }
    }

    pub(crate) fn check(&self) -> Result<()> {
        let limits = self.effective_limits();
        for &axis in self.sensor.active_axes() {
            let l = limits.axis(axis.index());
            let bounded = l.acceleration.is_some()
                || l.velocity.is_some()
                || l.displacement.is_some()
                || (l.jerk.is_some() && (l.intercept.is_some() || l.start.is_some() || l.end.is_some()));
            if !bounded {
                return Err(Error::experiment(
                    InputError::new(Refusal::MotionInfeasible,
                        format!("nothing bounds the acceleration of axis {axis}: the best motion would be infinitely fast"),
                        "set `limits.acceleration_mps2`, or `intercept_mps2` with `jerk_mps3`, or `sensor.range_mps2`",
                    )
                    .about_key("limits"),
                ));
            }
        }
        Ok(())
    }
}
