//! Lines become rows of a recording, and samples.
//!
//! What the columns are, and their units, is what the reader of recordings says of the first rows. Rows are written as they came, so that the recording is read as any
//! other. Only times are others where the sender has no clock, or where its clock begins anew.

use crate::arrival_clock::Arrivals;
use crate::fields::Fields;
use crate::layout::{Layout, Sample};
use calibrant::io::ImuFile;
use calibrant::session::{Readings, Session, Source};
use calibrant_core::error::{Error, Refusal, Result, with_options_worded};
use calibrant_core::sensor::ReadingUnit;

/// What comes of a line.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Taken {
    /// The header of the recording.
    Header(String),
    /// A row of it, and its sample.
    Row(String, Sample),
    /// A line that is none, and why.
    Dropped(&'static str),
    /// The sender began anew.
    Restarted,
    /// Why the stream is not understood.
    Problem(String),
}

/// Why a line is no row.
const OTHER: &str = "it is no row of numbers";
const NO_HEADER: &str = "no line named the columns before it";
const WIDTH: &str = "it has another number of fields than the columns have names";
const NUMBER: &str = "a field is no number";
const STANDS: &str = "its time is not after that of the row before";
const JUMPS: &str = "its time jumps";
const FOREIGN: &str = "the columns have other names now";
/// Headers, or words of a board, that are kept until the columns are known, and damaged rows that are left out of the first.
const MOST_HEADERS: usize = 8;
const MOST_BAD: usize = 10;
/// Rows from which the columns are recognised, at least and at most.
const FIRST_ROWS: usize = 20;
const MOST_ROWS: usize = 20_000;
/// A clock that goes back, or on by more than this while nobody waited, jumps, s. One that goes on by more than the second began anew.
const JUMP_S: f64 = 10.0;
const LONGEST_PAUSE_S: f64 = 3600.0;
/// Between the last sample before and the first after it, s.
const PAUSE_S: f64 = 1.0;

/// A stream of lines.
pub(crate) struct Stream<'s> {
    session: &'s Session,
    /// What may be a header, before the columns are known.
    headers: Vec<Vec<String>>,
    names: Vec<String>,
    /// Are rows of a recording taken again?
    pub(crate) is_replay: bool,
    /// Are the names now others?
    is_foreign: bool,
    layout: Option<Layout>,
    /// Rows before the columns are known, with their time of arrival.
    first: Vec<(Vec<String>, f64)>,
    next_try: usize,
    arrivals: Option<Arrivals>,
    /// What is added to the sender's clock, ticks.
    offset: f64,
    last_ticks: Option<(f64, f64)>,
    /// The sender's clock in the last row, where that was far from the one before.
    odd: Option<f64>,
    /// Which sensors have a reading of that time.
    has: [bool; 2],
    noted_s: Option<f64>,
    /// Were the names given?
    are_given: bool,
    /// A header came that is no other than the first.
    restarted: bool,
}

impl<'s> Stream<'s> {
    pub(crate) fn new(session: &'s Session) -> Self {
        Self {
            session,
            are_given: false,
            headers: Vec::new(),
            names: Vec::new(),
            is_replay: false,
            is_foreign: false,
            layout: None,
            first: Vec::new(),
            next_try: FIRST_ROWS,
            arrivals: None,
            offset: 0.0,
            last_ticks: None,
            odd: None,
            has: [false; 2],
            noted_s: None,
            restarted: false,
        }
    }

    /// Are the columns known?
    pub(crate) fn is_known(&self) -> bool {
        self.layout.is_some()
    }

    /// Units of the samples of each sensor that the stream has.
    pub(crate) fn units(&self) -> [Option<ReadingUnit>; 2] {
        self.layout.as_ref().map_or([None; 2], |layout| layout.units)
    }

    /// Largest readings of each sensor, where the stream says.
    pub(crate) fn largest(&self) -> [Option<f64>; 2] {
        self.layout.as_ref().map_or([None; 2], |layout| layout.largest)
    }

    /// What a line gives; `at_s`: when it arrived.
    pub(crate) fn take(&mut self, line: &str, at_s: f64) -> Vec<Taken> {
        let mut row = match Fields::of(line) {
            Fields::Names(names) => {
                self.restarted |= self.names == names;
                return self.header(names);
            }
            Fields::Row(row) => row,
            Fields::Named(named) => {
                let (names, row): (Vec<String>, Vec<String>) = named.into_iter().unzip();
                let taken = self.header(names);
                if !taken.is_empty() {
                    return taken;
                }
                row
            }
            Fields::Other => return vec![Taken::Dropped(OTHER)],
        };
        if self.is_foreign {
            return vec![Taken::Dropped(FOREIGN)];
        }
        if row.last().is_some_and(String::is_empty) && self.has_width(row.len() - 1) {
            // behind the last separator there is nothing
            row.pop();
        }
        if self.layout.is_some() {
            if row.len() != self.names.len() {
                return vec![Taken::Dropped(WIDTH)];
            }
            return self.row(row, at_s);
        }
        if !self.has_width(row.len()) {
            return vec![Taken::Dropped(if self.headers.is_empty() { NO_HEADER } else { WIDTH })];
        }
        self.first.push((row, at_s));
        if self.first.len() < self.next_try {
            return Vec::new();
        }
        self.next_try *= 2;
        let taken = self.recognise();
        if self.layout.is_none() && self.first.len() >= MOST_ROWS {
            // what was not understood so far is not kept for ever
            self.first.clear();
            self.next_try = FIRST_ROWS;
        }
        taken
    }

    /// What comes of the rows that wait, where no more follow.
    pub(crate) fn end(&mut self) -> Vec<Taken> {
        if self.layout.is_some() || self.first.is_empty() { Vec::new() } else { self.recognise() }
    }

    /// Has the header, or before it is known a line that may be one, so many fields?
    fn has_width(&self, width: usize) -> bool {
        match self.layout {
            Some(_) => self.names.len() == width,
            None => self.headers.iter().any(|names| names.len() == width),
        }
    }

    /// Names of columns, or words that a board says.
    fn header(&mut self, names: Vec<String>) -> Vec<Taken> {
        self.without_clock(&names);
        if self.layout.is_some() {
            // as many words as columns, some of them its names, are another board's
            let is_like = names.iter().any(|name| self.names.contains(name));
            let is_foreign = self.names != names && names.len() == self.names.len() && is_like;
            if is_foreign && !self.is_foreign {
                self.is_foreign = true;
                let message =
                    "the columns have other names now than in the recording: begin another session for them";
                return vec![Taken::Problem(message.to_owned())];
            }
            self.is_foreign = is_foreign || (self.is_foreign && self.names != names);
        } else if !self.are_given && !self.headers.contains(&names) {
            if self.headers.len() == MOST_HEADERS {
                self.headers.remove(0);
            }
            self.headers.push(names);
        }
        Vec::new()
    }

    /// Recognises the columns by the first rows: by the last header that the reader knows.
    fn recognise(&mut self) -> Vec<Taken> {
        let mut problem = None;
        for names in self.headers.clone().into_iter().rev() {
            match self.recognised(&names) {
                Ok((layout, by_arrival)) => {
                    self.names = names;
                    self.layout = Some(layout);
                    self.arrivals = by_arrival.then(Arrivals::default);
                    let clock = if by_arrival { "t_s," } else { "" };
                    let mut taken = vec![Taken::Header(format!("{clock}{}", self.names.join(",")))];
                    for (row, at_s) in std::mem::take(&mut self.first) {
                        if row.len() == self.names.len() {
                            taken.extend(self.row(row, at_s));
                        }
                    }
                    return taken;
                }
                // the first header is more likely than what a board says later
                Err(why) => problem = Some(why),
            }
        }
        problem.map(Taken::Problem).into_iter().collect()
    }

    fn recognised(&self, names: &[String]) -> std::result::Result<(Layout, bool), String> {
        let mut rows: Vec<&(Vec<String>, f64)> =
            self.first.iter().filter(|(row, _)| row.len() == names.len()).collect();
        let mut bad = 0;
        loop {
            let read = self.read(names, &rows, false);
            let has_no_clock = read.as_ref().is_err_and(|error| error.code() == Refusal::RateUnknown);
            let read = match has_no_clock {
                true => self.read(names, &rows, true).map(|file| (file, true)),
                false => read.map(|file| (file, false)),
            };
            match read {
                Ok((file, by_arrival)) => {
                    let layout = Layout::of(&file);
                    if !layout.has_clock() {
                        let message = "the rows have no time, and a rate is stated: leave it away (option `rate_hz`, rate_hz in [columns]), and each row gets the time at which it came";
                        return Err(with_options_worded(message.to_owned()));
                    }
                    if layout.axes[0].is_some() {
                        return Ok((layout, by_arrival));
                    }
                    let message =
                        "no column is known to be an accelerometer's: name them by option `columns`";
                    return Err(with_options_worded(message.to_owned()));
                }
                Err(Error::Recording(error)) => {
                    // a damaged row is none, as later in the stream
                    let line =
                        error.line.and_then(|line| line.checked_sub(2)).filter(|line| *line < rows.len());
                    match line {
                        Some(line) if bad < MOST_BAD => {
                            rows.remove(line);
                            bad += 1;
                        }
                        _ => return Err(format!("{} ({})", error.message, error.help)),
                    }
                }
                Err(error) => return Err(error.to_string()),
            }
        }
    }

    fn read(&self, names: &[String], rows: &[&(Vec<String>, f64)], by_arrival: bool) -> Result<ImuFile> {
        let mut text = if by_arrival { "t_s,".to_owned() } else { String::new() };
        text.push_str(&names.join(","));
        let mut arrivals = Arrivals::default();
        for (row, at_s) in rows {
            text.push('\n');
            if by_arrival {
                text.push_str(&format!("{},", arrivals.next(*at_s)));
            }
            text.push_str(&row.join(","));
        }
        text.push('\n');
        self.session.read(&Source::new(Readings::bytes("recording.csv", text.into_bytes())))
    }

    fn row(&mut self, mut row: Vec<String>, at_s: f64) -> Vec<Taken> {
        let Some(layout) = self.layout.clone() else { return Vec::new() };
        let mut taken = Vec::new();
        if let Some(arrivals) = &mut self.arrivals {
            let t_s = arrivals.next(at_s);
            row.insert(0, t_s.to_string());
        } else if let Some((column, per_second)) = layout.time {
            let Some(ticks) = row[column].parse::<f64>().ok().filter(|ticks| ticks.is_finite()) else {
                return vec![Taken::Dropped(NUMBER)];
            };
            let mut clock = ticks + self.offset;
            if self.is_replay {
                // the times of the recording are in order
                self.last_ticks = Some((clock, at_s));
                return layout
                    .sample(&row)
                    .map(|sample| Taken::Row(row.join(","), sample))
                    .into_iter()
                    .collect();
            }
            let of_counter = |(last, _): (f64, f64)| wrapped(clock, last, last - self.offset, per_second);
            if let Some(wrapped) = self.last_ticks.and_then(of_counter) {
                self.offset += wrapped - clock;
                clock = wrapped;
            }
            if let Some((last, last_at_s)) = self.last_ticks {
                let step_s = (clock - last) / per_second;
                let began_anew =
                    step_s < 0.0 || (step_s > JUMP_S && step_s > 2.0 * (at_s - last_at_s) + JUMP_S);
                // the sensors may have rows of their own for one time
                let of_other = || layout.sample(&row).is_some_and(|sample| self.is_of_other(&sample));
                if step_s == 0.0 && !of_other() {
                    return vec![Taken::Dropped(STANDS)];
                }
                if began_anew && !self.restarted {
                    // one row out of order, or damaged, is none of a new clock; a second one that goes on from it is
                    let goes_on = |odd: f64| (0.0..=PAUSE_S * per_second).contains(&(ticks - odd));
                    let is_second = self.odd.replace(ticks).is_some_and(goes_on);
                    if !is_second || (-PAUSE_S..0.0).contains(&step_s) {
                        return vec![Taken::Dropped(JUMPS)];
                    }
                }
                self.odd = None;
                // a clock that was set to a later time stays
                if step_s < 0.0 || (began_anew && step_s > LONGEST_PAUSE_S) {
                    let waited = if last_at_s.is_finite() { at_s - last_at_s } else { 0.0 };
                    let pause = PAUSE_S.max(waited) * per_second;
                    let offset = last + pause - clock;
                    self.offset += if ticks.fract() == 0.0 { offset.round() } else { offset };
                    clock = ticks + self.offset;
                    taken.push(Taken::Restarted);
                }
            }
            self.restarted = false;
            self.last_ticks = Some((clock, at_s));
            if self.offset != 0.0 {
                row[column] = clock.to_string();
            }
        }
        match layout.sample(&row) {
            Some(sample) => {
                self.note(&sample);
                taken.push(Taken::Row(row.join(","), sample));
            }
            None => taken.push(Taken::Dropped(NUMBER)),
        }
        taken
    }

    /// Has a sample what those of its time had not?
    fn is_of_other(&self, sample: &Sample) -> bool {
        let mut both = sample.readings.iter().zip(self.has);
        sample.readings.iter().any(Option::is_some) && both.all(|(reading, has)| reading.is_none() || !has)
    }

    /// Notes which sensors have a reading of this time.
    fn note(&mut self, sample: &Sample) {
        let is_same_time = self.noted_s == Some(sample.t_s);
        for (has, reading) in self.has.iter_mut().zip(&sample.readings) {
            *has = reading.is_some() || (*has && is_same_time);
        }
        self.noted_s = Some(sample.t_s);
    }

    /// A row without the accelerometer's readings, where its time is between these.
    pub(crate) fn blanked(&self, row: &str, (start_s, end_s): (f64, f64)) -> String {
        let Some(layout) = &self.layout else { return row.to_owned() };
        let mut fields: Vec<String> = row.split(',').map(str::to_owned).collect();
        let is_there = layout.sample(&fields).is_some_and(|sample| (start_s..=end_s).contains(&sample.t_s));
        if is_there && let Some(axes) = layout.axes[0] {
            axes.iter().for_each(|(column, _)| fields[*column].clear());
        }
        fields.join(",")
    }

    /// Rows that come now lack the time which the recording has: it is that of arrival.
    fn without_clock(&mut self, names: &[String]) {
        let is_shorter = self.names.first().is_some_and(|first| first == "t_s") && self.names[1..] == *names;
        if self.layout.is_some() && self.arrivals.is_none() && is_shorter {
            self.names.remove(0);
            self.arrivals = Some(Arrivals::after(self.last_ticks.map(|(last_s, _)| last_s)));
        }
    }

    /// Goes on after the rows of a session that is continued; `names`: of the columns, where they are given.
    pub(crate) fn resumed(&mut self, names: Vec<String>) {
        self.is_replay = false;
        // what the clock does meanwhile is not known
        if let Some(last) = &mut self.last_ticks {
            last.1 = f64::NEG_INFINITY;
        }
        self.without_clock(&names);
        if self.layout.is_none() && !names.is_empty() {
            (self.are_given, self.headers) = (true, vec![names]);
        }
        self.restarted = true;
    }
}

/// The time of a counter that went over its end since the last.
fn wrapped(clock: f64, last: f64, last_shown: f64, per_second: f64) -> Option<f64> {
    if clock >= last {
        return None;
    }
    let goes_on = |next: &f64| (0.0..PAUSE_S * per_second).contains(&(next - last));
    // of 16 bits, MicroPython's ticks of 30, of 32; a counter never showed more than it has
    let sizes = [16, 30, 32].into_iter().map(|bits| f64::from(2.0_f32.powi(bits)));
    sizes.filter(|size| last_shown < *size).map(|size| clock + size).find(goes_on)
}

#[cfg(test)]
mod tests;
