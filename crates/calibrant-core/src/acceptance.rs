//! Acceptance limits: may a sensor be shipped?
//!
//! # The rule
//! A value `x` with the standard deviation `σ` is decided with a guard band of `1.645 σ` on each side of a limit (`iso14253`, whose default is a
//! probability of 95 % on one side). It passes where it is inside the limits by the guard band, `[least + 1.645 σ, most − 1.645 σ]`. It fails where
//! it is outside of them by the guard band. Between the two, it is too close to say: neither conformity nor nonconformity is verified.
//! A standard deviation is decided without a guard band: it passes up to the largest that is accepted.

use crate::diagnostic::acceptance::{LimitBroken, LimitNotChecked, LimitTooClose};
use crate::diagnostic::{Diagnostic, LimitMiss};
use crate::form::finite;
use crate::json::if_some;

/// Standard deviations of the guard band: 95 % on one side.
pub const GUARD_BAND: f64 = 1.645;

/// What is accepted of one figure, or of a group of figures.
#[derive(Debug, Clone, PartialEq)]
pub struct AcceptanceLimit {
    /// Name of a figure, such as `accelerometer.bias.x`; or its beginning, such as `accelerometer.bias`, which stands for all that go on with a dot.
    pub name: String,
    /// The least and the largest accepted value, in the unit of the figure.
    pub range: Option<(f64, f64)>,
    /// The largest accepted standard deviation.
    pub sd: Option<f64>,
}

impl AcceptanceLimit {
    /// Does it limit the figure of this name?
    #[must_use]
    pub fn names(&self, figure: &str) -> bool {
        let rest = figure.strip_prefix(&self.name);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    }
}

/// A number of a result that may have a limit.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its standard deviation, where it has one.
    pub sd: Option<f64>,
}

/// What a limit says of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Decision {
    /// It keeps the limit.
    Pass,
    /// The result does not have the figure.
    NotChecked,
    /// The figure is within the guard band.
    TooClose,
    /// It breaks the limit.
    Fail,
}

impl Decision {
    /// As files state it: `pass`, `not_checked`, `too_close` or `fail`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::NotChecked => "not_checked",
            Self::TooClose => "too_close",
            Self::Fail => "fail",
        }
    }
}

crate::json_name!(Decision);

/// A figure beside its limit.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckedLimit {
    /// The figure. Where the result does not have it, its value is NaN.
    pub figure: Figure,
    /// The least and the largest accepted value.
    pub range: Option<(f64, f64)>,
    /// The largest accepted standard deviation.
    pub largest_sd: Option<f64>,
    /// What follows.
    pub decision: Decision,
}

/// Decides a range by the rule of this module.
///
/// # Examples
/// ```
/// use calibrant_core::acceptance::{Decision, decide};
/// assert_eq!(decide(0.03, 0.01, (-0.05, 0.05)), Decision::Pass);
/// assert_eq!(decide(0.04, 0.01, (-0.05, 0.05)), Decision::TooClose);
/// assert_eq!(decide(0.06, 0.01, (-0.05, 0.05)), Decision::TooClose);
/// assert_eq!(decide(-0.07, 0.01, (-0.05, 0.05)), Decision::Fail);
/// assert_eq!(decide(f64::NAN, 0.01, (-0.05, 0.05)), Decision::Fail);
/// ```
#[must_use]
pub fn decide(value: f64, sd: f64, (least, most): (f64, f64)) -> Decision {
    let guard = GUARD_BAND * sd;
    if value - guard >= least && value + guard <= most {
        Decision::Pass
    } else if value + guard >= least && value - guard <= most {
        Decision::TooClose
    } else {
        Decision::Fail
    }
}

/// Every limit on every figure that it names, in the order of the limits.
#[must_use]
pub fn checked(limits: &[AcceptanceLimit], figures: &[Figure]) -> Vec<CheckedLimit> {
    limits.iter().flat_map(|limit| of_limit(limit, figures)).collect()
}

fn of_limit(limit: &AcceptanceLimit, figures: &[Figure]) -> Vec<CheckedLimit> {
    let (range, largest_sd) = (limit.range, limit.sd);
    let of_figure = |figure: &Figure| {
        let sd = figure.sd.unwrap_or(0.0);
        let of_range = range.map(|range| decide(figure.value, sd, range));
        let of_sd = largest_sd.map(|largest| match figure.sd {
            Some(sd) if sd <= largest => Decision::Pass,
            Some(_) => Decision::Fail,
            None => Decision::NotChecked,
        });
        let decision = of_range.max(of_sd).unwrap_or(Decision::Pass);
        CheckedLimit { figure: figure.clone(), range, largest_sd, decision }
    };
    let checked: Vec<CheckedLimit> =
        figures.iter().filter(|figure| limit.names(&figure.name)).map(of_figure).collect();
    if checked.is_empty() {
        let figure = Figure { name: limit.name.clone(), value: f64::NAN, sd: None };
        return vec![CheckedLimit { figure, range, largest_sd, decision: Decision::NotChecked }];
    }
    checked
}

crate::json_object! {
    /// A figure beside its limit.
    CheckedLimit as limit {
        /// The figure, by its name.
        name: &limit.figure.name,
        /// None where the result does not have it.
        value: finite(limit.figure.value),
        /// Standard deviation of the figure.
        sd: limit.figure.sd.and_then(finite),
        /// The least and the largest accepted value.
        range: if_some(limit.range.map(|(least, most)| [least, most])),
        /// Limit of the standard deviation.
        largest_sd: if_some(limit.largest_sd),
        /// Is the limit kept, with the guard band?
        decision: limit.decision,
    }
}

impl CheckedLimit {
    /// What a user should know of it; nothing where it passes.
    #[must_use]
    pub fn diagnostic(&self) -> Option<Diagnostic> {
        match self.decision {
            Decision::Pass => None,
            Decision::NotChecked => {
                Some(Diagnostic::from(LimitNotChecked { name: self.figure.name.clone() }))
            }
            Decision::TooClose => Some(Diagnostic::from(LimitTooClose { limit: self.miss() })),
            Decision::Fail => Some(Diagnostic::from(LimitBroken { limit: self.miss() })),
        }
    }

    /// The limit that decided.
    fn miss(&self) -> LimitMiss {
        let Figure { name, value, sd } = &self.figure;
        let sd = sd.unwrap_or(0.0);
        let range = self.range.filter(|range| decide(*value, sd, *range) == self.decision);
        match (range, self.largest_sd) {
            (Some((least, most)), _) => {
                let limit = if (value - least).abs() < (value - most).abs() { least } else { most };
                LimitMiss { name: name.clone(), value: *value, sd, limit }
            }
            (None, largest) => {
                let limit = largest.unwrap_or(f64::NAN);
                LimitMiss { name: format!("the sd of {name}"), value: sd, sd: 0.0, limit }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(name: &str, value: f64, sd: Option<f64>) -> Figure {
        Figure { name: name.into(), value, sd }
    }

    fn limit(name: &str, range: Option<(f64, f64)>, sd: Option<f64>) -> AcceptanceLimit {
        AcceptanceLimit { name: name.into(), range, sd }
    }

    #[test]
    fn a_group_names_all_its_figures_and_no_others() {
        let figures = [
            figure("accelerometer.bias.x", 0.01, Some(1e-3)),
            figure("accelerometer.bias.y", 0.09, Some(1e-3)),
            figure("accelerometer.bias_per_k.x", 9.0, Some(1e-3)),
        ];
        let found = checked(&[limit("accelerometer.bias", Some((-0.05, 0.05)), None)], &figures);
        let decisions: Vec<_> = found.iter().map(|of| of.decision).collect();
        assert_eq!(decisions, [Decision::Pass, Decision::Fail]);
        let broken = found[1].diagnostic().expect("broken");
        assert_eq!(broken.code().name(), "limit-broken");
        assert_eq!(broken.numbers()[2], ("limit", 0.05));
    }

    #[test]
    fn a_standard_deviation_is_a_limit_of_its_own() {
        let figures = [figure("norm_rms_mps2", 1e-3, None), figure("gyroscope.scale.x", 1.0, Some(2e-4))];
        let one = |name: &str, sd| checked(&[limit(name, Some((0.0, 1.1)), Some(sd))], &figures)[0].clone();
        assert_eq!(one("gyroscope.scale.x", 2e-4).decision, Decision::Pass);
        let large = one("gyroscope.scale", 1e-4);
        assert_eq!(large.decision, Decision::Fail);
        let subject = large.diagnostic().and_then(|found| found.subject().map(str::to_owned));
        assert_eq!(subject.as_deref(), Some("the sd of gyroscope.scale.x"));
        assert_eq!(one("norm_rms_mps2", 1e-4).decision, Decision::NotChecked);
        assert_eq!(one("gyroscope.bias", 1e-4).decision, Decision::NotChecked);
    }
}
