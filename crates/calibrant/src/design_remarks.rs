//! What a person should know of a design: what its limits suppose, why its search ended, and what its motion leaves undetermined.

use crate::design_plan::DesignPlan;
use calibrant_core::diagnostic::design::{
    MotionUndetermined, RestAssumed, SearchInterrupted, SearchNotConverged, SearchOutOfTime,
    SweepValueFailed, SweepValueRounded,
};
use calibrant_core::diagnostic::{Check, Diagnostic, Phrase};
use calibrant_core::error::UndeterminedGroup;
use calibrant_core::motion::{Limits, Rest};
use calibrant_core::number_format::short;
use calibrant_design::{Design, DesignStatus, Sweep};

impl DesignPlan {
    /// Was the time over before the search of a design converged?
    #[must_use]
    pub fn is_out_of_time(&self, design: &Design) -> bool {
        design.status == DesignStatus::Interrupted && !self.settings.interruption.is_asked()
    }

    /// Why the search of a design ended before it converged, and what its motion leaves undetermined.
    #[must_use]
    pub fn remarks(&self, design: &Design) -> Vec<Diagnostic> {
        let ended = search_ended(design.status, self.is_out_of_time(design))
            .filter(|found| found.code() != SearchNotConverged::CODE || design.optimal.covariance.is_some());
        ended.into_iter().chain(undetermined_by("the motion", &design.optimal.undetermined)).collect()
    }
}

/// Why a search ended before it converged.
pub(crate) fn search_ended(status: DesignStatus, is_out_of_time: bool) -> Option<Diagnostic> {
    match status {
        DesignStatus::Converged => None,
        DesignStatus::Interrupted if is_out_of_time => Some(SearchOutOfTime {}.into()),
        DesignStatus::Interrupted => Some(SearchInterrupted { are_poses: false }.into()),
        _ => Some(SearchNotConverged { at: None, status: status.name() }.into()),
    }
}

/// What a motion leaves undetermined.
pub fn undetermined_by(motion: &str, groups: &[UndeterminedGroup]) -> impl Iterator<Item = Diagnostic> {
    groups.iter().map(|group| {
        let UndeterminedGroup { parameters, reason, remedy, .. } = group.clone();
        let (motion, reason, remedy) = (Phrase(motion.to_owned()), Phrase(reason), Phrase(remedy));
        MotionUndetermined { motion, parameters, reason, remedy }.into()
    })
}

/// What should be known of single values of a sweep: which were rounded, and which failed or did not converge.
#[must_use]
pub fn sweep_remarks(sweep: &Sweep) -> Vec<Diagnostic> {
    let (name, unit) = (sweep.variable.name(), sweep.variable.unit());
    let mut remarks = Vec::new();
    for point in &sweep.points {
        if (point.value - point.asked).abs() > 1e-9 * point.asked {
            let rounded = SweepValueRounded {
                asked: Phrase(format!("{name} {} {unit}", short(point.asked))),
                taken: Phrase(format!("{} {unit}", short(point.value))),
                intervals: point.intervals,
            };
            remarks.push(rounded.into());
        }
        let at = || Phrase(format!("{name} {} {unit}", short(point.value)));
        match &point.outcome {
            Err(why) => remarks.push(SweepValueFailed { at: at(), why: Phrase(why.clone()) }.into()),
            Ok(design) if design.status != DesignStatus::Converged => {
                let status = design.status.name();
                remarks.push(SearchNotConverged { at: Some(at()), status }.into());
            }
            Ok(_) => (),
        }
    }
    remarks
}

/// Says that the motion starts at rest, where limits imply it and `rest` is not set.
#[must_use]
pub fn rest_remark(limits: &Limits) -> Option<Diagnostic> {
    counts_from_rest(limits).map(|limit| RestAssumed { limit }.into())
}

/// The first limit that counts from rest, where `rest` is not set.
fn counts_from_rest(limits: &Limits) -> Option<&'static str> {
    if limits.rest != Rest::None {
        return None;
    }
    let velocity = limits.velocity_mps.map(|_| "velocity");
    velocity.or_else(|| limits.displacement_m.map(|_| "displacement"))
}
