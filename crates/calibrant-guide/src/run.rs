//! A session while it runs: what arrives, what a person asks for, and what is shown.

use crate::arrival::Arrival;
use crate::demo::Advice;
use crate::estimate::{Answer, Estimate, Question};
use crate::force::KnownForce;
use crate::gate::{Gate, Limits};
use crate::goals::Goals;
use crate::input::Input;
use crate::kept::KeptSamples;
use crate::lines::Lines;
use crate::options::GuideOptions;
use crate::server::{Action, Board};
use crate::session_log::SessionLog;
use crate::shown::{Kind, Live, Told};
use crate::stream::{Stream, Taken};
use crate::terminal::Terminal;
use crate::unfit::Unfit;
use calibrant::io::{Plan, file_name};
use calibrant::session::{Outcome, Session};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::ReadingUnit;
use nalgebra::Vector3;
use serde_json::json;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender};
use std::thread;
use std::time::{Duration, Instant};

/// The loop looks around after so long; the page is told 20 times a second.
const ROUND: Duration = Duration::from_millis(20);
const PICTURE: Duration = Duration::from_millis(50);
/// A hold is wanted so long, s; one of `minimum_hold_s` counts.
const HOLD_S: f64 = 3.0;

const BEGIN: &str = "Hold the sensor still in any orientation.";

/// A session while it runs.
pub(crate) struct Run<'s> {
    pub(crate) options: &'s GuideOptions,
    pub(crate) log: SessionLog,
    pub(crate) board: Board,
    pub(crate) advice: Advice,
    pub(crate) ask: Sender<Question>,
    pub(crate) lines: Lines,
    /// May the next line be the rest of one, since a port was just opened?
    pub(crate) may_be_half: bool,
    pub(crate) stream: Stream<'s>,
    pub(crate) gate: Gate,
    pub(crate) kept: KeptSamples,
    pub(crate) units: [ReadingUnit; 2],
    pub(crate) terminal: Terminal,
    pub(crate) live: Live,
    pub(crate) told: Told,
    /// Holds of the gate: begin, end, mean reading.
    pub(crate) held: Vec<(f64, f64, Vector3<f64>)>,
    pub(crate) force: KnownForce,
    pub(crate) put_off: Vec<Vector3<f64>>,
    pub(crate) last_s: f64,
    pub(crate) first_s: Option<f64>,
    pub(crate) rate: Rate,
    pub(crate) came: Instant,
    pub(crate) lost: Option<String>,
    pub(crate) problem: Option<String>,
    pub(crate) reached: usize,
    /// Do parts of the recording agree, as far as it was asked?
    pub(crate) folds_agree: Option<bool>,
    pub(crate) ratio_before: Option<f64>,
    /// Number of questions, and is the last one open?
    pub(crate) asked: u64,
    pub(crate) waits_for_answer: bool,
    pub(crate) unfit: Unfit,
    /// Are rows of the recording read again, in a session that is continued? Their messages were given before.
    pub(crate) is_replay: bool,
    /// The phase that the page knows.
    pub(crate) shown_phase: &'static str,
    pub(crate) finish: bool,
    /// What a sentence says of the goals.
    pub(crate) said_of_goals: &'static str,
}

/// Samples in a second, over the last second.
#[derive(Default)]
pub(crate) struct Rate {
    begin_s: f64,
    count: f64,
    pub(crate) hz: f64,
}

impl Rate {
    pub(crate) fn count(&mut self, t_s: f64) {
        self.count += 1.0;
        let seconds = t_s - self.begin_s;
        if !(0.0..1.0).contains(&seconds) {
            self.hz = if seconds > 0.0 && seconds < 3.0 { self.count / seconds } else { 0.0 };
            (self.begin_s, self.count) = (t_s, 0.0);
        }
    }
}

impl<'s> Run<'s> {
    pub(crate) fn new(
        options: &'s GuideOptions,
        session: &'s Session,
        goals: &Goals,
        (log, board, advice): (SessionLog, Board, Advice),
        ask: Sender<Question>,
    ) -> Self {
        let experiment = &options.experiment;
        let least_s = match &experiment.plan {
            Plan::Holds(holds) => holds.minimum_hold_s,
            _ => HOLD_S,
        };
        let hold_s = least_s.max(HOLD_S);
        let units = [
            experiment.sensor.unit,
            experiment.imu.as_ref().map_or(ReadingUnit::RadianPerSecond, |imu| imu.gyroscope.unit),
        ];
        let mut range = [None; 6];
        if let Some(of) = experiment.sensor.range_mps2 {
            for axis in 0..3 {
                range[axis] = Some(of[axis]);
            }
        }
        let force = KnownForce::new(&experiment.sensor, units[0]);
        let told = Told {
            sensor: options.session.naming.sensor.clone().unwrap_or_else(|| file_name(&options.directory)),
            path: log.path().display().to_string(),
            sentence: BEGIN.to_owned(),
            ..Told::default()
        };
        Self {
            options,
            terminal: Terminal::new(options.terminal),
            log,
            board,
            advice,
            ask,
            lines: Lines::default(),
            may_be_half: matches!(options.input, Input::Serial { .. }),
            stream: Stream::new(session),
            // what follows from the units comes with the header
            gate: Gate::new(Limits { hold_s, least_s, range, ..Limits::default() }),
            kept: KeptSamples::default(),
            units,
            live: Live::default(),
            told,
            held: Vec::new(),
            force,
            put_off: Vec::new(),
            last_s: 0.0,
            first_s: None,
            rate: Rate::default(),
            came: Instant::now(),
            lost: None,
            problem: None,
            reached: 0,
            folds_agree: None,
            ratio_before: None,
            asked: 0,
            waits_for_answer: false,
            unfit: Unfit::default(),
            is_replay: false,
            shown_phase: "",
            finish: false,
            said_of_goals: goals.said(),
        }
    }

    /// Takes the rows of a session that is continued, as if they came now.
    pub(crate) fn replay(&mut self, lines: Vec<String>) -> Result<()> {
        let mut at_s = 0.0;
        (self.is_replay, self.stream.is_replay) = (true, true);
        for line in &lines {
            for taken in self.stream.take(line, at_s) {
                // they are in the recording already
                match taken {
                    Taken::Header(_) => self.known(),
                    Taken::Row(_, sample) => {
                        at_s = sample.t_s;
                        self.sample(&sample)?;
                    }
                    Taken::Problem(problem) => self.problem = Some(problem),
                    _ => {}
                }
            }
        }
        self.is_replay = false;
        match self.problem.take() {
            // too few rows to know their columns: they wait in memory for those that follow
            None if !self.stream.is_known() && !lines.is_empty() => self.log.begin_anew()?,
            None => {}
            Some(problem) => {
                let message = format!("the recording of this session is not understood: {problem}");
                let help = "go on with the experiment and the options that it was begun with";
                let error = InputError::new(Refusal::OptionsContradict, message, help);
                return Err(Error::recording(error.in_file(self.log.path())));
            }
        }
        self.question(true)?;
        self.stream.resumed(self.options.columns.clone());
        self.live.lines = lines.len().saturating_sub(1) as u64;
        Ok(())
    }

    /// Runs until the session is finished.
    pub(crate) fn run(
        &mut self,
        arrivals: &Receiver<Arrival>,
        answers: &Receiver<Answer>,
        asked: Receiver<Action>,
    ) -> Result<()> {
        let mut pictured = Instant::now();
        let mut ended = false;
        self.show_result();
        while !self.finish {
            match arrivals.recv_timeout(ROUND) {
                Ok(arrival) => ended |= self.arrival(arrival)?,
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => ended = true,
            }
            while let Ok(answer) = answers.try_recv() {
                self.answer(answer)?;
            }
            while let Ok(action) = asked.try_recv() {
                self.action(action)?;
            }
            self.log.keep(false)?;
            if pictured.elapsed() >= PICTURE {
                pictured = Instant::now();
                self.picture();
            }
            self.finish |= self.options.interruption.is_asked();
            if ended {
                self.end_of_input(answers)?;
                break;
            }
        }
        self.log.event(&json!({"at_s": self.last_s, "kind": "finish"}))?;
        self.log.keep(true)?;
        self.live.phase = "held";
        self.live.word = "Calibrating".to_owned();
        self.live.reason = "all samples of the recording, for the result".to_owned();
        self.live.progress = None;
        self.board.live(self.live.json());
        Ok(())
    }

    /// Shows the result of the whole recording, and leaves the pages.
    pub(crate) fn close(&mut self, outcome: &Result<Outcome>) {
        let told = &mut self.told;
        told.finished = true;
        self.live.phase = "finished";
        self.live.word = "Finished".to_owned();
        match outcome {
            Ok(outcome) => {
                told.estimate.usability = Some(outcome.verdict().usability);
                let goals =
                    if told.good_enough { "Good enough." } else { "Finished before all goals were reached." };
                told.sentence = goals.to_owned();
                self.live.reason = "The result of the whole recording is in the folder.".to_owned();
            }
            Err(error) => {
                told.estimate.usability = None;
                told.good_enough = false;
                told.sentence = error.to_string();
                self.live.reason = "There is no result.".to_owned();
            }
        }
        self.board.live(self.live.json());
        self.show_result();
        // pages take what they have not yet
        thread::sleep(Duration::from_millis(if self.options.listen.is_some() { 300 } else { 0 }));
        self.board.close();
    }

    /// The holds up to the end are asked for, and the answer waited for.
    fn end_of_input(&mut self, answers: &Receiver<Answer>) -> Result<()> {
        let taken = self.stream.end();
        self.taken(taken)?;
        self.question(false)?;
        while self.waits_for_answer {
            match answers.recv_timeout(Duration::from_secs(60)) {
                Ok(answer) => self.answer(answer)?,
                Err(_) => break,
            }
        }
        Ok(())
    }

    /// Why nothing was recorded, where nothing was.
    pub(crate) fn not_understood(&self) -> Option<String> {
        let why = self.unfit.why.map(|why| format!("of the last line, {why}"));
        let silent = || "nothing came".to_owned();
        (!self.stream.is_known()).then(|| self.problem.clone().or(why).unwrap_or_else(silent))
    }

    /// A pose that was refused is offered last.
    pub(crate) fn put_off(&mut self) {
        if let Some(up) = self.up() {
            self.put_off.push(up);
        }
    }

    pub(crate) fn up(&self) -> Option<Vector3<f64>> {
        self.force.up(&Vector3::from(self.gate.now(0)?))
    }

    pub(crate) fn question(&mut self, of_new_hold: bool) -> Result<()> {
        // the answer that is awaited will be an older one
        let of_new_hold = of_new_hold || self.waits_for_answer;
        if self.held.is_empty() || self.is_replay {
            return Ok(());
        }
        let recording = self.kept.recording(self.units)?;
        let held =
            self.held.iter().map(|(start_s, end_s, mean)| (*start_s, *end_s, self.force.up(mean))).collect();
        let asked = Instant::now();
        let units = self.units;
        let number = self.asked + 1;
        let question = Question {
            number,
            units,
            asked,
            of_new_hold,
            recording,
            held,
            now: self.up(),
            put_off: self.put_off.clone(),
        };
        if self.ask.send(question).is_ok() {
            self.asked += 1;
            self.waits_for_answer = true;
        }
        Ok(())
    }

    fn action(&mut self, action: Action) -> Result<()> {
        match action {
            Action::Finish => self.finish = true,
            Action::Note(text) => {
                self.log.event(&json!({"at_s": self.last_s, "kind": "note", "text": text}))?;
                self.say(Kind::Info, format!("Note: {text}"))?;
            }
            Action::Undo => {
                let Some((start_s, mut end_s, _)) = self.held.pop() else {
                    return self.say(Kind::Info, "There is no hold to undo.".to_owned());
                };
                if self.gate.leave(start_s) {
                    end_s = self.last_s;
                }
                self.erase(start_s, end_s)?;
                self.say(Kind::Info, "The last hold is taken back: its samples of the accelerometer are blank in the recording.".to_owned())?;
                (self.reached, self.told.good_enough) = (0, false);
                if self.held.is_empty() {
                    // no answer that is awaited counts
                    (self.asked, self.waits_for_answer) = (self.asked + 1, false);
                    self.told.estimate = Estimate::default();
                    self.told.sentence = BEGIN.to_owned();
                }
                self.question(true)?;
                self.show_result();
            }
        }
        Ok(())
    }

    /// Blanks the accelerometer's readings of a hold, in the file too, so that whoever reads it finds the same.
    fn erase(&mut self, start_s: f64, end_s: f64) -> Result<()> {
        self.log.event(&json!({"at_s": self.last_s, "kind": "undo", "start_s": start_s, "end_s": end_s}))?;
        self.kept.erase((start_s, end_s));
        let stream = &self.stream;
        self.log.rewrite(|row| stream.blanked(row, (start_s, end_s)))
    }

    pub(crate) fn say(&mut self, kind: Kind, text: String) -> Result<()> {
        if !self.is_replay {
            self.log.event(&json!({"at_s": self.last_s, "kind": "message", "text": text}))?;
            self.terminal.message(self.last_s - self.first_s.unwrap_or(self.last_s), kind, &text);
        }
        self.told.say(self.last_s, kind, text);
        self.show_result();
        Ok(())
    }

    pub(crate) fn show_result(&mut self) {
        self.told.held = self.held.len();
        if self.options.listen.is_some() {
            self.board.result(self.told.json());
        }
    }
}
