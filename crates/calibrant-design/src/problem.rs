//! The design problem: sensor, motion grid, limits and criterion; the goal, and how long it is searched.

use crate::{Interruption, SoFar};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::information::criterion::AOptimality;
use calibrant_core::information::{Criterion, GravityMarginal, MotionInformation};
use calibrant_core::motion::{KnownEnds, Limits, MotionClock, MotionGravity, Trust};
use calibrant_core::sensor::{Axis, Sensor, SensorModel, SensorParameters};
use nalgebra::{DMatrix, DVector, Vector3};

/// Intervals of the usual motion.
const INTERVALS: usize = 20;

/// Find the motion whose recording determines the parameters best:
///
/// `minimise over a: Φ(Σ_p(a, p̄))` subject to the limits, the thesis's (4).
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
    /// Gravity, where the sensor will sense it beside the motion.
    pub gravity: Option<MotionGravity>,
    /// What will be known of the recording's clock beside the motion's: its delay and rate are marginalised.
    pub clock: MotionClock,
    /// The limits of the arm.
    pub limits: &'a Limits,
    /// The criterion that is minimised.
    pub criterion: Criterion,
    /// Information that is there already: a prior, or earlier recordings (p × p, in the order of the parameter list).
    pub prior: Option<DMatrix<f64>>,
}

impl<'a> DesignProblem<'a> {
    /// The usual problem: a motion of 20 intervals that lasts this long (s), known from rest on, recorded at 100 Hz, which minimises the sum of the
    /// variances (criterion A, in SI units) about the sensor's nominal parameters. Change a field for anything else.
    ///
    /// # Errors
    /// [`Error::Experiment`] where the nominal gain or offset of a sensor in counts is not known.
    ///
    /// # Examples
    /// ```
    /// use calibrant_core::motion::{InputNoise, Limits, Rest, Trust};
    /// use calibrant_core::sensor::Sensor;
    /// use calibrant_design::{DesignProblem, DesignSettings, design};
    /// use nalgebra::Vector3;
    ///
    /// let sensor = Sensor::memsic_mxd2020u();
    /// let limits = Limits {
    ///     acceleration_mps2: Some(Vector3::repeat(2.0)),
    ///     velocity_mps: Some(Vector3::repeat(0.5)),
    ///     rest: Rest::Both,
    ///     ..Limits::default()
    /// };
    /// let problem = DesignProblem::new(&sensor, &limits, 10.0)?;
    /// let known = design(&problem, &DesignSettings::default(), &|_| {})?;
    ///
    /// // a robot whose jerk differs from the commanded one by 1 %
    /// let noisy = Trust::Noisy(InputNoise { floor_mps3: 0.01, ratio: 0.01 });
    /// let noisy = design(&DesignProblem { trust: noisy, ..problem }, &DesignSettings::default(), &|_| {})?;
    /// assert!(noisy.optimal.value > known.optimal.value);
    /// # Ok::<(), calibrant_core::Error>(())
    /// ```
    pub fn new(sensor: &'a Sensor, limits: &'a Limits, duration_s: f64) -> Result<Self> {
        let at = sensor.nominal().ok_or_else(|| {
            Error::experiment(InputError::new(
                Refusal::KeyMissing,
                "the sensor's nominal gain and offset are not known, so a design has nothing to begin with",
                "give Sensor::gain and Sensor::offset, or the parameters of an earlier calibration (DesignProblem::at)",
            ))
        })?;
        let scale = DVector::repeat(sensor.parameter_list().len(), 1.0);
        Ok(Self {
            sensor,
            at,
            intervals: INTERVALS,
            interval_s: duration_s / INTERVALS as f64,
            rate_hz: 100.0,
            trust: Trust::Known,
            known_ends: KnownEnds::Start,
            gravity: None,
            clock: MotionClock::default(),
            limits,
            criterion: Criterion::A(AOptimality { scale }),
            prior: None,
        })
    }

    /// The limits with the sensor's range among them, less what gravity takes of it.
    #[must_use]
    pub fn effective_limits(&self) -> Limits {
        self.limits.within_range(self.range_left())
    }

    /// The range of the sensor that is left for the motion.
    fn range_left(&self) -> Option<Vector3<f64>> {
        let range = self.sensor.range_mps2?;
        Some(self.gravity.map_or(range, |gravity| gravity.range_left(&range)))
    }

    /// The way from the readings at rest, of which a recording informs, to the biases. `None` without gravity.
    #[must_use]
    pub fn gravity_marginal(&self) -> Option<GravityMarginal> {
        let list = self.sensor.parameter_list();
        self.gravity.map(|gravity| GravityMarginal::new(&list, &self.at, &gravity, self.prior.as_ref()))
    }

    /// The part of the criterion that no motion changes: that of the tilt, for A, c and I. It is 0 without gravity, and for
    /// criteria that are no sum.
    #[must_use]
    pub fn floor(&self) -> f64 {
        match self.criterion {
            Criterion::A(_) | Criterion::C(_) | Criterion::I(_) => {
                self.gravity_marginal().map_or(0.0, |gravity| self.criterion.value(&gravity.floor))
            }
            Criterion::D(_) | Criterion::E(_) | Criterion::M(_) => 0.0,
        }
    }

    /// The conditions of the experiment.
    ///
    /// # Errors
    /// As [`MotionInformation::new`].
    pub fn setting(&self) -> Result<MotionInformation> {
        let exact = MotionInformation::new(self.sensor, self.at, self.trust, self.known_ends, self.rate_hz)?;
        Ok(MotionInformation { clock: self.clock, ..exact })
    }

    /// Standard deviation that gravity's tilt alone gives each parameter. Empty without gravity.
    pub(crate) fn floor_sd(&self) -> Vec<f64> {
        let floor = self.gravity_marginal().map(|gravity| gravity.floor);
        floor.map_or_else(Vec::new, |floor| floor.diagonal().iter().map(|v| v.max(0.0).sqrt()).collect())
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

    /// Can a motion be designed for this problem at all?
    ///
    /// # Errors
    /// [`Error::Experiment`] says what is missing or contradicts itself.
    pub fn check(&self) -> Result<()> {
        if let Some(left) = self.range_left() {
            let active = self.sensor.active_axes().iter();
            if let Some(axis) = active.copied().find(|axis| left[axis.index()] <= 0.0) {
                return Err(Error::infeasible(
                    InputError::new(
                        Refusal::MotionInfeasible,
                        format!("gravity alone exceeds the range of the sensor on axis {axis}"),
                        "raise sensor.range_mps2, or mount the sensor otherwise",
                    )
                    .about_key("sensor.range_mps2"),
                ));
            }
        }
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

/// The settings of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignSettings {
    /// Largest number of starts for each axis. The search ends earlier once ten end at the same best value.
    pub starts: usize,
    /// Time for the search, s, in place of a number of starts. The result then depends on the machine. A start that is
    /// under way ends with it; the certificate does not.
    pub seconds: Option<f64>,
    /// Seed of the random starts and of the initial motion.
    pub seed: u64,
    /// Is a lower bound wanted that no admissible motion can beat?
    pub certificate: bool,
    /// Gap to the lower bound at which the search ends: relative, for criterion D in nats. The bound is then
    /// found first. Without a certificate it has no effect.
    pub gap: Option<f64>,
    /// Largest number of iterations of one start.
    pub max_iterations: usize,
    /// Ends the search early where it is asked: the design is then the best so far.
    pub interruption: Interruption,
    /// What the search knows so far, for whoever waits.
    pub so_far: SoFar,
}

impl Default for DesignSettings {
    fn default() -> Self {
        Self {
            starts: 30,
            seconds: None,
            seed: 1,
            certificate: true,
            gap: None,
            max_iterations: 300,
            interruption: Interruption::default(),
            so_far: SoFar::default(),
        }
    }
}

impl DesignSettings {
    pub(crate) fn check(&self) -> Result<()> {
        match self.gap {
            Some(gap) if !(gap.is_finite() && gap > 0.0) => Err(Error::experiment(InputError::new(
                Refusal::ValueInvalid,
                format!("a search cannot end at a gap of {gap}"),
                "ask for a gap above 0, such as 0.01",
            ))),
            _ => Ok(()),
        }
    }
}

/// A parameter, and the largest standard deviation that is good enough.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// Place of the parameter in the list.
    pub parameter: usize,
    /// Largest standard deviation, in the parameter's unit.
    pub sd: f64,
}

impl Goal {
    /// Largest of `sd / goal` over all goals: the goals are reached where it is at most 1.
    pub(crate) fn worst(goals: &[Self], sd: impl Fn(usize) -> f64) -> f64 {
        goals.iter().map(|goal| sd(goal.parameter) / goal.sd).fold(0.0, f64::max)
    }
}

/// The first of the numbers `low + 1 ..= high` that passes, where all after it do. `high` is known to pass,
/// `low` is known not to.
pub(crate) fn first_that_passes(
    mut low: usize,
    mut high: usize,
    mut passes: impl FnMut(usize) -> Result<bool>,
) -> Result<usize> {
    while high - low > 1 {
        let middle = low + (high - low) / 2;
        if passes(middle)? { high = middle } else { low = middle }
    }
    Ok(high)
}
