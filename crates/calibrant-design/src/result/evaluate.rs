//! The evaluation of a given motion: the covariance that a recording of it will give.

use crate::{DesignProblem, Evaluation};
use calibrant_core::error::{Result, UndeterminedGroup};
use calibrant_core::information::{MotionFacts, MotionInformation, Undetermined, View};
use calibrant_core::information::{covariance, explain, undetermined, with_biases};
use calibrant_core::motion::{JerkControlledMotion, Trust, sample_times};

/// Predicts the covariance of a calibration from a recording of `motion`. Intervals and limits of the problem are not used.
///
/// # Errors
/// As [`MotionInformation::information`](calibrant_core::information::MotionInformation::information). A motion that leaves
/// parameters undetermined is not an error: the result names them.
pub fn evaluate(problem: &DesignProblem<'_>, motion: &JerkControlledMotion) -> Result<Evaluation> {
    let setting = problem.setting()?;
    let mut information = setting.information(motion)?;
    let gravity = problem.gravity_marginal();
    if let Some(prior) = gravity.as_ref().map(|gravity| &gravity.prior).or(problem.prior.as_ref()) {
        information += prior;
    }
    let groups = undetermined(&information, &information.diagonal());
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
        let without_noise = undetermined(&exact, &exact.diagonal());
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
        samples: sample_times(motion, problem.rate_hz).len(),
        view,
    };
    let groups = with_biases(&groups, &list, &slots, problem.gravity.as_ref());
    Ok(explain(&list, &groups, &slots, facts))
}
