//! Runs the work of a call: without the interpreter's lock, on threads of its own, with signals seen and panics caught.
//!
//! Each call has a pool of its own. The global pool would hang a process after `fork`.

use crate::failure::{internal, raised};
use crate::wording;
use calibrant::error::Refusal;
use calibrant::interruption::Interruption;
use calibrant::progress::{Progress, Step};
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::{Duration, Instant};

/// How long the interpreter sleeps between two looks at signals.
const PERIOD: Duration = Duration::from_millis(20);
/// How long work that keeps nothing has to end after an interruption. Afterwards it ends by itself, and nobody hears of it.
const GRACE: Duration = Duration::from_millis(300);
/// The stack of a thread, bytes: as much as a main thread has.
const STACK: usize = 8 << 20;

/// What work looks at while it runs.
pub(crate) struct Run {
    /// Is asked when a signal arrives.
    pub(crate) interruption: Interruption,
    /// Tells the caller of each step.
    pub(crate) progress: Progress,
}

/// How work runs.
#[derive(Default)]
pub(crate) struct How {
    /// Number of threads; `None`: all cores.
    pub(crate) threads: Option<usize>,
    /// Is called with steps done, steps in all, and what is done.
    pub(crate) progress: Option<Py<PyAny>>,
    /// Has the work a result, though it was interrupted?
    pub(crate) keeps_the_best: bool,
}

enum Told<T> {
    Step(Step),
    Done(Result<calibrant::Result<T>, String>),
}

/// Runs work that takes no time worth an interruption.
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> calibrant::Result<T> + Send + 'static,
) -> PyResult<T> {
    run_as(py, How::default(), |_| work())
}

/// Runs work on this thread, for what takes almost no time: only panics are caught.
pub(crate) fn at_once<T: Send>(
    py: Python<'_>,
    work: impl FnOnce() -> calibrant::Result<T> + Send,
) -> PyResult<T> {
    wording::set();
    match py.detach(|| catch_unwind(AssertUnwindSafe(work))) {
        Ok(outcome) => outcome.map_err(|error| raised(py, &error)),
        Err(panic) => Err(internal(py, &words_of(panic.as_ref()))),
    }
}

/// Runs work.
pub(crate) fn run_as<T: Send + 'static>(
    py: Python<'_>,
    how: How,
    work: impl FnOnce(Run) -> calibrant::Result<T> + Send + 'static,
) -> PyResult<T> {
    wording::set();
    let (sender, mut receiver) = channel();
    let interruption = Interruption::default();
    let progress = match how.progress {
        Some(_) => {
            let told = sender.clone();
            // nobody listens after an exception of the listener
            Progress::to(move |step| drop(told.send(Told::Step(step))))
        }
        None => Progress::default(),
    };
    let given = Run { interruption: interruption.clone(), progress };
    let threads = how.threads.unwrap_or(0);
    let begun = std::thread::Builder::new().spawn(move || in_pool(threads, &sender, || work(given)));
    begun.map_err(|error| internal(py, &format!("no thread can be started: {error}")))?;
    let mut ended: Option<(PyErr, Instant)> = None;
    let mut looked = Instant::now();
    loop {
        let (told, again) = py.detach(move || {
            let told = receiver.recv_timeout(PERIOD);
            (told, receiver)
        });
        receiver = again;
        let mut why = None;
        match told {
            Ok(Told::Done(outcome)) => {
                let ended = ended.map(|(why, _)| why);
                return finished(py, outcome, ended, how.keeps_the_best);
            }
            Ok(Told::Step(step)) => {
                why = how
                    .progress
                    .as_ref()
                    .and_then(|listener| listener.call1(py, (step.done, step.of, step.what)).err());
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Err(internal(py, "its thread ended")),
        }
        if looked.elapsed() >= PERIOD {
            looked = Instant::now();
            why = why.or_else(|| py.check_signals().err());
        }
        match (why, &ended) {
            (Some(why), None) => {
                interruption.ask();
                ended = Some((why, Instant::now()));
            }
            // a second signal does not wait
            (Some(why), Some(_)) => return Err(why),
            (None, _) => {}
        }
        let is_over = |(_, since): &(PyErr, Instant)| !how.keeps_the_best && since.elapsed() > GRACE;
        if let Some((why, _)) = ended.take_if(|ended| is_over(ended)) {
            return Err(why);
        }
    }
}

fn in_pool<T: Send>(
    threads: usize,
    sender: &Sender<Told<T>>,
    work: impl FnOnce() -> calibrant::Result<T> + Send,
) {
    let outcome = catch_unwind(AssertUnwindSafe(|| {
        pool(threads).map(|pool| pool.install(work)).map_err(|error| error.to_string())
    }));
    let outcome = outcome.unwrap_or_else(|panic| Err(words_of(panic.as_ref())));
    // nobody listens any more after an interruption
    drop(sender.send(Told::Done(outcome)));
}

/// A pool of this number of threads. 0 stands for the number of cores.
pub(crate) fn pool(threads: usize) -> Result<ThreadPool, ThreadPoolBuildError> {
    ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build()
}

/// What a panic says.
pub(crate) fn words_of(panic: &(dyn std::any::Any + Send)) -> String {
    let words = panic.downcast_ref::<String>().map(String::as_str);
    words.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a panic").to_owned()
}

fn finished<T>(
    py: Python<'_>,
    outcome: Result<calibrant::Result<T>, String>,
    ended: Option<PyErr>,
    keeps_the_best: bool,
) -> PyResult<T> {
    use pyo3::exceptions::PyKeyboardInterrupt;
    match (outcome, ended) {
        (Ok(Ok(result)), None) => Ok(result),
        (Ok(Ok(result)), Some(why)) if keeps_the_best && why.is_instance_of::<PyKeyboardInterrupt>(py) => {
            Ok(result)
        }
        (Ok(Err(error)), Some(why)) if error.code() == Refusal::Interrupted => Err(why),
        (Ok(Err(error)), _) => Err(raised(py, &error)),
        (Ok(Ok(_)), Some(why)) => Err(why),
        (Err(message), _) => Err(internal(py, &message)),
    }
}
