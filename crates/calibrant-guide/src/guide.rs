//! The guide: lines come in, holds are recognised, each is followed by a calibration of all that was held, and by what to do next.

use crate::advice::faces;
use crate::demo::Advice;
use crate::estimate::{Answer, Estimator, Question};
use crate::goals::Goals;
use crate::options::GuideOptions;
use crate::run::Run;
use crate::server::{Board, serve};
use crate::session_log::SessionLog;
use crate::shown::Kind;
use calibrant::io::Plan;
use calibrant::session::{Outcome, Session, SessionOptions, Source};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use std::sync::mpsc::{channel, sync_channel};
use std::thread;

/// Blocks of bytes that may wait.
const WAITING: usize = 1024;
/// Folds of the last question before "good enough".
const FOLDS: usize = 5;

/// Guides a session until it is finished, and gives the calibration of the whole recording, the same as `calibrate` gives. `said` is called with the address of the page.
///
/// # Errors
/// [`Error::Experiment`] where the experiment is not of a sensor that is held still, the input is not there, the address is taken, or the folder has a session already;
/// [`Error::Output`] where the recording cannot be written. As [`Session::calibrate`] of the recording.
pub fn guide(options: GuideOptions, said: &dyn Fn(&str)) -> Result<Outcome> {
    let session_options =
        |report: bool, folds: Option<usize>| SessionOptions { report, folds, ..options.session.clone() };
    suits(&options)?;
    let new = |report, folds| Session::with(options.experiment.clone(), session_options(report, folds));
    let (session, with_folds, last) = (new(false, None)?, new(false, Some(FOLDS))?, new(true, None)?);
    let goals = Goals::of_limits(session.limits(), faces(session.experiment()).is_some());
    let advice = Advice::default();
    let (to, arrivals) = sync_channel(WAITING);
    let board = Board::default();
    let (actions, asked) = channel();
    let served = options.listen.as_ref().map(|address| serve(address, token(), board.clone(), actions));
    let url = served.transpose()?;
    options.input.open(&session, to, &advice)?;
    let (log, lines) = SessionLog::open(&options.directory, options.resume)?;
    if let Some(url) = url {
        said(&url);
    }
    let resumed = lines.len();
    let (ask, questions) = channel::<Question>();
    let (tell, answers) = channel::<Answer>();
    let estimator = Estimator { session: &session, with_folds: &with_folds, goals: &goals };
    thread::scope(|scope| {
        scope.spawn(move || {
            while let Ok(mut question) = questions.recv() {
                // the last one counts
                while let Ok(newer) = questions.try_recv() {
                    question = Question { of_new_hold: question.of_new_hold || newer.of_new_hold, ..newer };
                }
                let first = |first| {
                    let _ = tell.send(first);
                };
                let whole = estimator.answer(question, first);
                if tell.send(Answer::Whole(Box::new(whole))).is_err() {
                    return;
                }
            }
        });
        let mut run = Run::new(&options, &session, &goals, (log, board, advice), ask);
        run.replay(lines)?;
        if resumed > 0 {
            run.told.say(run.last_s, Kind::Info, format!("Goes on with {} rows.", resumed.saturating_sub(1)));
        }
        run.run(&arrivals, &answers, asked)?;
        let outcome = calibrated(&last, &options, run.not_understood());
        run.close(&outcome);
        outcome
    })
}

/// The calibration of the whole recording, written beside it. `not_understood`: why nothing was recorded, where nothing was.
fn calibrated(session: &Session, options: &GuideOptions, not_understood: Option<String>) -> Result<Outcome> {
    let recording = options.directory.join("recording.csv");
    if let Some(why) = not_understood.filter(|_| !recording.exists()) {
        let help = "let the board print a header such as t_ms,ax_g,ay_g,az_g,gx_dps,gy_dps,gz_dps once in a while, or name the columns by option `columns`";
        return Err(Error::recording(InputError::new(
            Refusal::RecordingShort,
            format!("nothing was recorded: {why}"),
            help,
        )));
    }
    let outcome =
        session.calibrate(&Source::from_file(&recording)).map_err(|error| error.in_recording(&recording))?;
    outcome.write(&options.directory)?;
    Ok(outcome)
}

/// Refuses an experiment that is not of holds, or that has the times of other ones.
fn suits(options: &GuideOptions) -> Result<()> {
    let experiment = &options.experiment;
    let refused =
        |message, help| Err(Error::experiment(InputError::new(Refusal::ExperimentUnsuited, message, help)));
    let Plan::Holds(holds) = &experiment.plan else {
        return refused(
            "the guide is for a sensor that is held still",
            "take an experiment with [holds]: see `calibrant init imu` and `calibrant init static-poses`",
        );
    };
    if options.session.reading.rows_are_holds {
        let help = "leave option `rows_are_holds` away; a table of means is for `calibrate`";
        return refused("a live session has samples, and finds its holds in them", help);
    }
    if holds.intervals_s.is_some() {
        let help = "remove holds.intervals_s: holds are found, and each is in the one of holds.directions that it shows";
        return refused(
            "holds.intervals_s has the times of holds, and nobody knows those of a live session",
            help,
        );
    }
    if experiment.imu.as_ref().is_some_and(|imu| !imu.turns.is_empty()) {
        let help = "remove gyroscope.turns: the rotations between the holds determine the gyroscope";
        return refused(
            "gyroscope.turns has the times of turns, and nobody knows those of a live session",
            help,
        );
    }
    Ok(())
}

/// A number that others do not know.
fn token() -> String {
    use std::hash::{BuildHasher, RandomState};
    format!("{:016x}{:016x}", RandomState::new().hash_one(1), RandomState::new().hash_one(2))
}
