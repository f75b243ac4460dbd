//! The assessment of a user's own motion beside the best one, the bound and the limits.

use crate::{Design, DesignProblem, Evaluation, LimitUse, limit_use};
use calibrant_core::error::{Result, UndeterminedGroup};
use calibrant_core::information::{
    Criterion, MotionFacts, MotionInformation, Undetermined, View, covariance, explain, undetermined,
    with_biases,
};
use calibrant_core::json::if_some;
use calibrant_core::json_object;
use calibrant_core::motion::{JerkControlledMotion, Limits, MotionClock, Trust, sample_count};
use calibrant_core::sensor::Parameter;
use schemars::JsonSchema;
use serde::Serialize;

/// A motion, the information that it gives, and how that compares.
#[derive(Debug, Clone)]
pub struct Assessment {
    /// The criterion that is minimised.
    pub criterion: Criterion,
    /// Name, unit, nominal value and spread of each parameter.
    pub parameters: Vec<Parameter>,
    /// The information that a recording of the motion will give.
    pub evaluation: Evaluation,
    /// How far the motion goes towards each limit, and beyond, at all times.
    pub limits: Vec<LimitUse>,
    /// The best motion found for the experiment, or the reason in words why there is none.
    pub optimum: std::result::Result<Design, String>,
    /// Duration and number of intervals of the motion where they differ from those of the experiment. The
    /// optimum is for those of the experiment.
    pub other_setting: Option<OtherSetting>,
}

json_object! {
    /// A motion, the information that it gives, and how that compares.
    Assessment as of {
        /// Does it keep all limits?
        admissible: of.violations().is_empty(),
        /// Does it determine the parameters?
        determined: of.evaluation.covariance.is_some(),
        /// Share of the recordings that the best motion found would need, from 0 to 1.
        efficiency: of.efficiency(),
        /// The same against the lower bound.
        efficiency_against_bound: of.certain_efficiency(),
        criterion: &of.criterion,
        /// What the motion determines: the order of all lists of parameters.
        parameters: &of.parameters,
        evaluation: &of.evaluation,
        /// How far the motion goes towards each limit.
        limit_use: &of.limits,
        /// Where the motion's duration or intervals are not those of the experiment.
        other_setting: if_some(of.other_setting),
        /// The best motion for the experiment.
        design: of.optimum.as_ref().ok(),
        /// Why there is none.
        no_design_because: of.optimum.as_ref().err(),
    }
}

/// A motion whose duration or intervals are not those of the experiment.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct OtherSetting {
    /// Number of intervals of the motion.
    pub intervals: usize,
    /// Its duration, s.
    pub duration_s: f64,
    /// Number of intervals of the experiment.
    pub experiment_intervals: usize,
    /// Duration of the experiment, s.
    pub experiment_duration_s: f64,
}

impl Assessment {
    /// Efficiency against the best motion found: the share of the recordings that the best motion would need
    /// for the same value of the criterion. 1 is as good, ½ needs twice as many. For D per parameter,
    /// `exp((Φ_best − Φ)/p)`. `None` where either does not determine the parameters.
    #[must_use]
    pub fn efficiency(&self) -> Option<f64> {
        let design = self.optimum.as_ref().ok()?;
        self.against(design.optimal.value)
    }

    /// Efficiency against the lower bound. No admissible motion with the experiment's duration and intervals
    /// makes it less than this.
    #[must_use]
    pub fn certain_efficiency(&self) -> Option<f64> {
        let certificate = self.optimum.as_ref().ok()?.certificate.as_ref()?;
        self.against(certificate.lower_bound)
    }

    fn against(&self, best: f64) -> Option<f64> {
        let floor = self.optimum.as_ref().map_or(0.0, |design| design.floor);
        let value = self.evaluation.value;
        let efficiency = match self.criterion {
            Criterion::D(_) => ((best - value) / self.parameters.len() as f64).exp(),
            _ => (best - floor) / (value - floor),
        };
        (efficiency.is_finite() && value.is_finite() && best.is_finite()).then_some(efficiency)
    }

    /// The limits that the motion breaks, the worst first.
    #[must_use]
    pub fn violations(&self) -> Vec<LimitUse> {
        let mut broken: Vec<_> = self.limits.iter().filter(|found| found.is_violated()).copied().collect();
        broken.sort_by(|one, other| other.violation.total_cmp(&one.violation));
        broken
    }
}

/// Assesses a motion beside the optimum of the experiment.
///
/// # Errors
/// As [`evaluate`].
pub fn assess(
    problem: &DesignProblem<'_>,
    motion: &JerkControlledMotion,
    optimum: std::result::Result<Design, String>,
) -> Result<Assessment> {
    let times = motion.times_s();
    let duration_s = times[motion.intervals()] - times[0];
    let experiment_duration_s = problem.intervals as f64 * problem.interval_s;
    let close = |one: f64, other: f64| (one - other).abs() <= 1e-6 * experiment_duration_s;
    let same = motion.intervals() == problem.intervals
        && (0..=motion.intervals()).all(|i| close(times[i] - times[0], i as f64 * problem.interval_s));
    Ok(Assessment {
        criterion: problem.criterion.clone(),
        parameters: problem.sensor.parameter_list().describe(problem.sensor, &problem.at),
        evaluation: evaluate(problem, motion)?,
        limits: limits_of(problem, motion)?,
        optimum,
        other_setting: (!same).then_some(OtherSetting {
            intervals: motion.intervals(),
            duration_s,
            experiment_intervals: problem.intervals,
            experiment_duration_s,
        }),
    })
}

/// Use of the limits. A sensor's range holds for what it senses, gravity among it, which a design keeps by symmetric limits.
fn limits_of(problem: &DesignProblem<'_>, motion: &JerkControlledMotion) -> Result<Vec<LimitUse>> {
    let axes = problem.sensor.axes;
    let (Some(gravity), Some(range)) = (problem.gravity, problem.sensor.range_mps2) else {
        return Ok(limit_use(&problem.effective_limits(), axes, motion));
    };
    let range = Limits::default().within_range(Some(range));
    let sensed = limit_use(&range, axes, &motion.plus(&gravity.force_mps2)?);
    Ok(limit_use(problem.limits, axes, motion).into_iter().chain(sensed).collect())
}

/// Predicts the covariance of a calibration from a recording of `motion`. Intervals and limits of the problem are not used.
///
/// # Errors
/// As [`MotionInformation::information`](calibrant_core::information::MotionInformation::information). A motion that leaves
/// parameters undetermined is not an error: the result names them.
pub fn evaluate(problem: &DesignProblem<'_>, motion: &JerkControlledMotion) -> Result<Evaluation> {
    let setting = problem.setting()?;
    let mut information = setting.information(motion)?;
    // what is left of a doubtful motion is a difference: its rounding errors are of the size of what a known motion gives
    let known = MotionInformation { trust: Trust::Known, clock: MotionClock::default(), ..setting.clone() };
    let mut reference = known.information(motion)?.diagonal();
    let gravity = problem.gravity_marginal();
    if let Some(prior) = gravity.as_ref().map(|gravity| &gravity.prior).or(problem.prior.as_ref()) {
        information += prior;
        reference += prior.diagonal();
    }
    let groups = undetermined(&information, &reference, motion.intervals());
    let mut c = if groups.is_empty() { covariance(&information) } else { None };
    if let Some(gravity) = &gravity {
        c = c.map(|c| gravity.covariance(&c));
        if let Some(of_parameters) = gravity.information(&information) {
            information = of_parameters;
        }
    }
    Ok(Evaluation {
        motion: motion.clone().on_axes(problem.sensor.axes),
        value: c.as_ref().map_or(f64::INFINITY, |c| problem.criterion.value(c)),
        information,
        covariance: c,
        undetermined: reasons(problem, &setting, motion, groups)?,
    })
}

/// Why the motion leaves these parameters undetermined.
fn reasons(
    problem: &DesignProblem<'_>,
    setting: &MotionInformation,
    motion: &JerkControlledMotion,
    mut groups: Vec<Undetermined>,
) -> Result<Vec<UndeterminedGroup>> {
    if groups.is_empty() {
        return Ok(Vec::new());
    }
    let mut view = if problem.trust == Trust::Unknown { View::Ends } else { View::Command };
    if let Trust::Noisy(_) = problem.trust {
        // is the motion itself at fault, or its noise?
        let mut exact = MotionInformation { trust: Trust::Known, ..setting.clone() }.information(motion)?;
        let gravity = problem.gravity_marginal();
        if let Some(prior) = gravity.as_ref().map(|gravity| &gravity.prior).or(problem.prior.as_ref()) {
            exact += prior;
        }
        let without_noise = undetermined(&exact, &exact.diagonal(), 0);
        if without_noise.is_empty() {
            view = View::Noise;
        } else {
            groups = without_noise;
        }
    }
    let list = problem.sensor.parameter_list();
    let slots: Vec<usize> = (0..list.len()).collect();
    let facts = MotionFacts {
        model: problem.sensor.model,
        nodes: motion.acceleration_mps2(),
        samples: sample_count(motion, problem.rate_hz) as usize,
        view,
    };
    let groups = with_biases(&groups, &list, &slots, problem.gravity.as_ref());
    Ok(explain(&list, &groups, &slots, facts))
}
