//! What is refused before the work begins: options that are for a single recording, and recordings that are none.

use super::names::{check_for_records, check_several, check_together, refuse};
use crate::session::{MotionSource, Session, Source};
use calibrant_core::error::{Result, TaskOption};
use calibrant_io::{Experiment, Plan};
use std::path::Path;

/// Checks the recordings of a session. `recorded`: are the results added to records?
pub(super) fn check(session: &Session, sources: &[Source], recorded: bool) -> Result<()> {
    let (experiment, naming) = (session.experiment(), &session.options().naming);
    not_the_motion(session, sources)?;
    for source in sources.iter().filter(|source| !source.further.is_empty()) {
        together(experiment, source)?;
        check_together(naming, source.each().map(Source::path))?;
    }
    if sources.len() > 1 {
        several(session, sources)?;
    }
    if recorded {
        check_for_records(naming, sources.iter().map(Source::path))?;
    }
    Ok(())
}

/// Refuses a recording that is also the commanded motion.
fn not_the_motion(session: &Session, sources: &[Source]) -> Result<()> {
    let is_motion = matches!(session.experiment().plan, Plan::Motion(_));
    let Some(MotionSource::File(motion)) = session.options().motion.as_ref().filter(|_| is_motion) else {
        return Ok(());
    };
    match sources.iter().map(Source::path).find(|recording| is_same(recording, motion)) {
        Some(recording) => refuse(
            format!("{} is both the motion and a recording", recording.display()),
            "leave it out of the recordings, or keep them in a folder of their own".to_owned(),
        ),
        None => Ok(()),
    }
}

/// Do both paths name the same file?
fn is_same(one: &Path, other: &Path) -> bool {
    matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other)
}

/// Refuses recordings that are calibrated together where this makes no sense.
fn together(experiment: &Experiment, source: &Source) -> Result<()> {
    let has_turns = experiment.imu.as_ref().is_some_and(|imu| !imu.turns.is_empty());
    let what = match &experiment.plan {
        // a recording for each direction
        Plan::Holds(holds) if holds.directions.is_some() && experiment.imu.is_none() => return Ok(()),
        Plan::Holds(holds) if holds.intervals_s.is_some() => {
            "needs holds that are found, and holds.intervals_s gives them"
        }
        Plan::Holds(_) if has_turns => "needs movements that are found, and gyroscope.turns gives some",
        Plan::Holds(_) if source.each().any(|each| each.sections.is_some()) => {
            "needs holds that are found, and a list of sections gives them"
        }
        Plan::Holds(_) => return Ok(()),
        _ => "is for [holds]",
    };
    let option = TaskOption::Together;
    refuse(format!("{option} {what}"), format!("calibrate the recordings one by one, or leave out {option}"))
}

/// Refuses options for one recording where there are several.
fn several(session: &Session, sources: &[Source]) -> Result<()> {
    let options = session.options();
    if options.validate.is_some() || options.folds.is_some() {
        return refuse(
            "one calibration is validated at a time, and several recordings are given".to_owned(),
            format!("give one recording with {} or {}", TaskOption::Validate, TaskOption::Folds),
        );
    }
    check_several(&options.naming)?;
    if sources.iter().filter(|source| source.path().as_os_str() == "-").count() > 1 {
        return refuse("standard input (-) is given twice".to_owned(), "give it once".to_owned());
    }
    if sources.iter().any(|source| source.sections.is_some()) {
        return refuse(
            format!("{} is the list of one recording, and several are given", TaskOption::Sections),
            "calibrate one recording at a time with its list".to_owned(),
        );
    }
    Ok(())
}
