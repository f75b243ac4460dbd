//! A sweep: the best design as one quantity of the experiment changes.

use crate::{Design, DesignProblem, DesignSettings, design};
use calibrant_core::budget::Budget;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::information::Criterion;
use calibrant_core::json_object;
use calibrant_core::motion::Limits;
use calibrant_core::sensor::{Parameter, Sensor};
use nalgebra::Vector3;

/// The quantity that a sweep changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SweepVariable {
    /// Duration of the motion, s. The intervals keep their duration, their number changes.
    Duration,
    /// Largest acceleration, m/s², of all axes.
    Acceleration,
    /// Largest jerk, m/s³, of all axes.
    Jerk,
    /// Largest intercept, m/s², of all axes.
    Intercept,
    /// Largest velocity, m/s, of all axes.
    Velocity,
    /// Largest displacement, m, of all axes.
    Displacement,
    /// Sample rate, Hz.
    Rate,
    /// Noise of a sample, m/s², of all axes.
    Noise,
}

impl SweepVariable {
    /// All quantities.
    pub const ALL: [Self; 8] = [
        Self::Duration,
        Self::Acceleration,
        Self::Jerk,
        Self::Intercept,
        Self::Velocity,
        Self::Displacement,
        Self::Rate,
        Self::Noise,
    ];

    /// In words: `duration`.
    #[must_use]
    pub fn name(self) -> &'static str {
        let [_, name, _] = self.words();
        name
    }

    /// As in files, with its unit: `duration_s`, `limits.velocity_mps`.
    #[must_use]
    pub fn key(self) -> &'static str {
        let [key, _, _] = self.words();
        key
    }

    /// Its unit, for people: `s`, `m/s`.
    #[must_use]
    pub fn unit(self) -> &'static str {
        let [_, _, unit] = self.words();
        unit
    }

    /// Key, name and unit.
    fn words(self) -> [&'static str; 3] {
        match self {
            Self::Duration => ["duration_s", "duration", "s"],
            Self::Acceleration => ["limits.acceleration_mps2", "acceleration", "m/s²"],
            Self::Jerk => ["limits.jerk_mps3", "jerk", "m/s³"],
            Self::Intercept => ["limits.intercept_mps2", "intercept", "m/s²"],
            Self::Velocity => ["limits.velocity_mps", "velocity", "m/s"],
            Self::Displacement => ["limits.displacement_m", "displacement", "m"],
            Self::Rate => ["rate_hz", "rate", "Hz"],
            Self::Noise => ["noise_mps2", "noise", "m/s²"],
        }
    }

    /// The variable of this name: `duration`, `velocity`, `velocity_mps`, `limits.velocity_mps`, `motion.rate_hz`, `sensor.noise_mps2`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let sections = ["limits.", "motion.", "sensor."];
        let name = sections.iter().find_map(|section| name.strip_prefix(section)).unwrap_or(name);
        let plain = |found: Self| found.key().trim_start_matches("limits.");
        Self::ALL.into_iter().find(|&found| name == found.name() || name == plain(found))
    }
}

/// The best designs over the values of one variable.
#[derive(Debug, Clone)]
pub struct Sweep {
    /// The quantity that changes.
    pub variable: SweepVariable,
    /// The criterion that every design minimises.
    pub criterion: Criterion,
    /// Name, unit, nominal value and spread of each parameter.
    pub parameters: Vec<Parameter>,
    /// The values, in the requested order.
    pub points: Vec<SweepPoint>,
}

json_object! {
    /// One value of a sweep.
    SweepPoint as of {
        /// The value that was used: a duration is a whole number of intervals.
        value: of.value,
        /// The value that was asked for.
        asked: of.asked,
        /// Number of intervals of the motion.
        intervals: of.intervals,
        /// The best design there.
        design: of.outcome.as_ref().ok(),
        /// Why there is none.
        error: of.outcome.as_ref().err(),
    }
}

json_object! {
    /// The best designs over the values of one variable.
    Sweep as of {
        /// What is varied.
        variable: of.variable.key(),
        /// Unit of its values.
        unit: of.variable.unit(),
        points: &of.points,
    }
}

/// One value of a sweep.
#[derive(Debug, Clone)]
pub struct SweepPoint {
    /// The requested value, in the variable's unit.
    pub asked: f64,
    /// The value that was used: a duration is a whole number of intervals.
    pub value: f64,
    /// Number of intervals.
    pub intervals: usize,
    /// The best design there, or the reason in words why there is none (the limits clash, for example).
    pub outcome: std::result::Result<Design, String>,
}

impl SweepPoint {
    /// Standard deviation of each parameter with the best motion; infinite where there is none.
    #[must_use]
    pub fn sd(&self, parameters: usize) -> Vec<f64> {
        self.outcome.as_ref().map_or_else(|_| vec![f64::INFINITY; parameters], |design| design.optimal.sd())
    }
}

/// Designs the motion for each of these values. `progress` is called with the number of the value, from 0,
/// and the progress of [`design`].
///
/// A value whose limits admit no motion, or that determines nothing, does not stop the others: its point says
/// why. Where it is interrupted, it has the values whose designs are finished.
///
/// # Errors
/// As [`design`], where it is for another reason; [`Error::Experiment`] for a value that makes no sense.
pub fn sweep(
    problem: &DesignProblem<'_>,
    settings: &DesignSettings,
    variable: SweepVariable,
    values: &[f64],
    progress: &(dyn Fn(usize, u64) + Sync),
) -> Result<Sweep> {
    let mut points = Vec::with_capacity(values.len());
    for (number, &asked) in values.iter().enumerate() {
        let changed = Changed::of(problem, variable, asked)?;
        let outcome = match design(&changed.problem(problem), settings, &|done| progress(number, done)) {
            Ok(design) => Ok(design),
            Err(error) if error.is_not_identifiable() || error.is_infeasible() => Err(error.to_string()),
            Err(error) => return Err(error),
        };
        if settings.interruption.is_asked() {
            break;
        }
        let intervals = changed.intervals;
        points.push(SweepPoint { asked, value: changed.value, intervals, outcome });
    }
    Ok(Sweep {
        variable,
        criterion: problem.criterion.clone(),
        parameters: problem.sensor.parameter_list().describe(problem.sensor, &problem.at),
        points,
    })
}

/// What a sweep over these values takes.
///
/// # Errors
/// [`Error::Experiment`] for a value that makes no sense.
pub fn sweep_work(
    problem: &DesignProblem<'_>,
    settings: &DesignSettings,
    variable: SweepVariable,
    values: &[f64],
) -> Result<Budget> {
    let mut work = Budget::NONE;
    for &asked in values {
        let changed = Changed::of(problem, variable, asked)?;
        work = work + settings.work(&changed.problem(problem));
    }
    Ok(work)
}

/// A problem with one quantity changed.
struct Changed {
    sensor: Sensor,
    limits: Limits,
    intervals: usize,
    rate_hz: f64,
    value: f64,
}

impl Changed {
    /// The changed problem.
    fn problem<'a>(&'a self, problem: &DesignProblem<'a>) -> DesignProblem<'a> {
        DesignProblem {
            sensor: &self.sensor,
            limits: &self.limits,
            intervals: self.intervals,
            rate_hz: self.rate_hz,
            ..problem.clone()
        }
    }

    fn of(problem: &DesignProblem<'_>, variable: SweepVariable, asked: f64) -> Result<Self> {
        let reject = |message: String, help: &str| {
            Err(Error::experiment(InputError::new(Refusal::ValueInvalid, message, help)))
        };
        if !(asked.is_finite() && asked > 0.0) {
            return reject(
                format!("cannot sweep {} to {asked}", variable.name()),
                "values are numbers above 0",
            );
        }
        let mut changed = Self {
            sensor: problem.sensor.clone(),
            limits: problem.limits.clone(),
            intervals: problem.intervals,
            rate_hz: problem.rate_hz,
            value: asked,
        };
        let all = Some(Vector3::repeat(asked));
        match variable {
            SweepVariable::Duration => {
                changed.intervals = (asked / problem.interval_s).round().max(1.0) as usize;
                changed.value = changed.intervals as f64 * problem.interval_s;
            }
            SweepVariable::Acceleration => changed.limits.acceleration_mps2 = all,
            SweepVariable::Jerk => changed.limits.jerk_mps3 = all,
            SweepVariable::Intercept => changed.limits.intercept_mps2 = all,
            SweepVariable::Velocity => changed.limits.velocity_mps = all,
            SweepVariable::Displacement => changed.limits.displacement_m = all,
            SweepVariable::Rate => changed.rate_hz = asked,
            SweepVariable::Noise => {
                changed.sensor.noise_mps2 = all;
                changed.sensor.noise_counts = None;
            }
        }
        let samples = changed.intervals as f64 * problem.interval_s * changed.rate_hz;
        if !(1.0 - 1e-9..=1e9).contains(&samples) {
            return reject(
                format!(
                    "{} {asked:?} {} makes a recording of {samples:.1e} sample steps",
                    variable.name(),
                    variable.unit()
                ),
                "from 1 to 1e9 make sense",
            );
        }
        Ok(changed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn variables_go_by_short_and_long_names() {
        for variable in SweepVariable::ALL {
            assert_eq!(SweepVariable::named(variable.name()), Some(variable));
            assert_eq!(SweepVariable::named(variable.key()), Some(variable));
        }
        assert_eq!(SweepVariable::named("velocity_mps"), Some(SweepVariable::Velocity));
        assert_eq!(SweepVariable::named("motion.rate_hz"), Some(SweepVariable::Rate));
        assert_eq!(SweepVariable::named("speed"), None);
    }
}
