//! When is the sensor held still? By its own noise: no value that the calibration is to find decides.
//!
//! | state | until |
//! |---|---|
//! | moving | each axis scatters less than 2.5 times as in the quietest half second so far, or than 1 % of gravity and 0.03 rad/s |
//! | settling | the mean of the last half second stays: 3 standard deviations |
//! | holding | it lasted long enough |
//! | held | it moves |
//!
//! A knock that is over within 0.3 s is cut out. A hold that slides is shortened to its end, not begun anew.

use crate::decision::Decision;
use crate::layout::Sample;
use crate::window::{AXES, Step, Sums, Window};
use calibrant_core::sensor::Axis;

/// Times the quietest scatter.
const STILL: f64 = 2.5;
/// What is still in any case, and what is not: shares of gravity, and rad/s.
const LEAST_SHARE: f64 = 1e-2;
const LARGEST_SHARE: f64 = 0.04;
const LEAST_RADPS: f64 = 0.03;
const LARGEST_RADPS: f64 = 0.1;
/// The sensor is not settled while its mean moves by more than this many standard deviations, and by more than this share of gravity.
const DRIFT_SDS: f64 = 3.0;
const DRIFT_SHARE: f64 = 1.5e-3;
/// Longest knock, s, with the window that it is in.
const KNOCK_S: f64 = 0.3 + 0.5;
/// After a knock the mean is within this share of gravity where it was.
const SAME_SHARE: f64 = 0.01;
/// A hold slides where its thirds differ by this share of gravity, and by 3 standard deviations.
const SLIDE_SHARE: f64 = 4e-3;
/// Samples are missing where two are farther apart than this, s, and than this many periods. A hold goes on after a gap shorter than the last of these, s.
const GAP_S: f64 = 0.1;
const GAP_PERIODS: f64 = 5.0;
const BRIDGED_S: f64 = 1.0;
/// How fast the period of the samples is followed.
const PERIOD_FOLLOWS: f64 = 0.1;
/// Share of a range that is its end.
const CLIPS: f64 = 0.98;
/// Share of the gyroscope's range that a rotation may use.
const FAST: f64 = 0.9;

/// What the gate is in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Phase {
    Waiting,
    Moving,
    Settling,
    Holding,
    Held,
    /// It is held, and does not count.
    Refused,
}

/// What is known of the sensor.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Limits {
    /// A hold is wanted so long, s, and counts from this length on.
    pub(crate) hold_s: f64,
    pub(crate) least_s: f64,
    /// Gravity in the unit of the readings.
    pub(crate) gravity: Option<f64>,
    /// Largest readings of each axis, where they are known.
    pub(crate) range: [Option<f64>; AXES],
    /// Scatter that a gyroscope in counts may have.
    pub(crate) gyroscope_floor: f64,
    /// Are accelerometer and gyroscope in m/s² and rad/s?
    pub(crate) in_si: [bool; 2],
}

/// The gate.
#[derive(Debug)]
pub(crate) struct Gate {
    pub(crate) limits: Limits,
    window: Window,
    quietest: [f64; AXES],
    pub(crate) phase: Phase,
    last_t_s: Option<f64>,
    hold: Option<Hold>,
    /// Mean time from sample to sample, s.
    period_s: f64,
    /// What gaps add to the length of a knock, s.
    grace_s: f64,
    /// Since when it moves within a hold.
    moves_since: Option<f64>,
    fast: Option<usize>,
    /// An axis at the end of its range, since the last step.
    clips: Option<usize>,
    /// Why it is not still: axis, scatter, limit.
    pub(crate) shakes: Option<(usize, f64, f64)>,
}

#[derive(Debug, Clone)]
struct Hold {
    start_s: f64,
    end_s: f64,
    /// When each step begins, and its sums.
    steps: Vec<(f64, Sums)>,
    all: Sums,
    told: bool,
    slid: bool,
    clips: Option<usize>,
}

impl Gate {
    pub(crate) fn new(limits: Limits) -> Self {
        Self {
            limits,
            window: Window::default(),
            quietest: [f64::INFINITY; AXES],
            phase: Phase::Waiting,
            last_t_s: None,
            period_s: 0.0,
            grace_s: 0.0,
            hold: None,
            moves_since: None,
            fast: None,
            clips: None,
            shakes: None,
        }
    }

    /// Takes a sample.
    pub(crate) fn take(&mut self, sample: &Sample) -> Vec<Decision> {
        let mut found = Vec::new();
        if let Some(last) = self.last_t_s {
            let step_s = sample.t_s - last;
            if self.period_s == 0.0 {
                self.period_s = step_s;
            } else if step_s > GAP_S.max(GAP_PERIODS * self.period_s) {
                self.gap(last, step_s, &mut found);
            } else {
                self.period_s += PERIOD_FOLLOWS * (step_s - self.period_s);
            }
        }
        self.last_t_s = Some(sample.t_s);
        self.watch_ranges(sample);
        if let Some(step) = self.window.push(sample) {
            self.step(&step, &mut found);
        }
        found
    }

    /// Samples are missing. A hold goes on behind a short gap where its mean is the same.
    fn gap(&mut self, last: f64, seconds: f64, found: &mut Vec<Decision>) {
        self.window.clear();
        if self.hold.is_some() && seconds < BRIDGED_S {
            self.moves_since.get_or_insert(last);
            self.grace_s += seconds;
            return;
        }
        self.end(self.moves_since.unwrap_or(last), found);
        self.phase = Phase::Moving;
        found.push(Decision::Gap { seconds });
    }

    /// The clock begins anew: nothing is known of the time between.
    pub(crate) fn interrupt(&mut self) -> Vec<Decision> {
        let mut found = Vec::new();
        if let Some(last) = self.last_t_s.take() {
            self.end(self.moves_since.unwrap_or(last), &mut found);
        }
        found.retain(|decision| !matches!(decision, Decision::Short { .. }));
        self.window.clear();
        self.phase = Phase::Moving;
        found
    }

    /// Leaves the hold that began then; was it still held?
    pub(crate) fn leave(&mut self, start_s: f64) -> bool {
        let is_held = self.hold.as_ref().is_some_and(|hold| hold.start_s == start_s);
        if is_held {
            (self.hold, self.moves_since, self.grace_s) = (None, None, 0.0);
            self.window.clear();
            self.phase = Phase::Moving;
        }
        is_held
    }

    /// How far the hold is: seconds, and how many it needs.
    pub(crate) fn progress(&self) -> Option<(f64, f64)> {
        let hold = self.hold.as_ref()?;
        Some((hold.end_s - hold.start_s, self.limits.hold_s))
    }

    /// Mean reading of a sensor in the last half second.
    pub(crate) fn now(&self, sensor: usize) -> Option<[f64; 3]> {
        let (_, sums) = self.window.whole()?;
        self.window.reading(&sums, sensor)
    }

    fn watch_ranges(&mut self, sample: &Sample) {
        for (sensor, reading) in sample.readings.iter().enumerate() {
            let Some(reading) = reading else { continue };
            for (of, value) in reading.iter().enumerate() {
                let axis = 3 * sensor + of;
                let Some(range) = self.limits.range[axis] else { continue };
                if sensor == 0 && value.abs() >= CLIPS * range {
                    self.clips = Some(axis);
                } else if sensor == 1 && value.abs() >= FAST * range {
                    self.fast = Some(axis);
                }
            }
        }
    }

    /// Gravity in the unit of the readings, or what they show where no gain is known.
    fn magnitude(&self, sums: &Sums) -> f64 {
        if let Some(gravity) = self.limits.gravity {
            return gravity;
        }
        let of = self.window.reading(sums, 0).unwrap_or_default();
        of.iter().map(|value| value * value).sum::<f64>().sqrt()
    }

    /// The largest scatter of an axis that is still.
    fn limit(&self, axis: usize, magnitude: f64) -> f64 {
        let quietest = STILL * self.quietest[axis];
        if axis < 3 {
            quietest.clamp(LEAST_SHARE * magnitude, LARGEST_SHARE * magnitude)
        } else if self.limits.in_si[1] {
            quietest.clamp(LEAST_RADPS, LARGEST_RADPS)
        } else {
            // counts of a gyroscope that hardly flickers
            quietest.max(self.limits.gyroscope_floor)
        }
    }

    fn step(&mut self, step: &Step, found: &mut Vec<Decision>) {
        let (end_s, clips) = (step.end_s, self.clips.take());
        let whole = self.window.whole();
        if whole.as_ref().is_some_and(|(_, window)| window.count(0) < 3.0) {
            // of a hold that was taken back
            self.end(end_s, found);
            self.phase = Phase::Moving;
            return;
        }
        let Some((start_s, window)) = whole else {
            self.phase = if self.phase == Phase::Waiting { Phase::Waiting } else { Phase::Moving };
            return;
        };
        let magnitude = self.magnitude(&window);
        let axes = (0..AXES).filter(|axis| window.count(*axis) > 2.0);
        let over = axes.clone().map(|axis| (axis, window.sd(axis), self.limit(axis, magnitude)));
        let worst = over.max_by(|one, other| (one.1 / one.2).total_cmp(&(other.1 / other.2)));
        self.shakes = worst.filter(|(_, sd, limit)| sd > limit);
        for axis in axes.clone() {
            // readings that never change show no noise
            let sd = window.sd(axis);
            if sd > 0.0 {
                self.quietest[axis] = self.quietest[axis].min(sd);
            }
        }
        if self.shakes.is_some() {
            self.moves(end_s, found);
            return;
        }
        if let Some(since) = self.moves_since.take()
            && let Some(hold) = &self.hold
        {
            let same = self.distance(&window, &hold.all) < SAME_SHARE * magnitude;
            let longest = KNOCK_S + std::mem::take(&mut self.grace_s);
            if end_s - since > longest || !same {
                self.end(since, found);
            } else {
                found.push(Decision::Cut);
            }
        }
        if let Some(hold) = &mut self.hold {
            // what a knock reaches is not the hold
            hold.clips = hold.clips.or(clips);
            self.holds(step, magnitude, found);
            return;
        }
        let [before, after] = self.window.halves();
        let drift = self.distance(&before, &after);
        if drift > by_noise(&window, &before).max(DRIFT_SHARE * magnitude) {
            self.phase = Phase::Settling;
            return;
        }
        if let Some(axis) = self.fast.take() {
            found.push(Decision::Fast { axis });
        }
        self.phase = Phase::Holding;
        self.hold = Some(Hold {
            start_s,
            end_s,
            steps: vec![(start_s, window)],
            all: window,
            told: false,
            slid: false,
            clips,
        });
    }

    /// Between the accelerometer's means.
    fn distance(&self, one: &Sums, other: &Sums) -> f64 {
        (0..3).map(|axis| (one.mean(axis) - other.mean(axis)).powi(2)).sum::<f64>().sqrt()
    }

    fn moves(&mut self, end_s: f64, found: &mut Vec<Decision>) {
        let Some(hold) = &self.hold else {
            self.phase = Phase::Moving;
            return;
        };
        let since = *self.moves_since.get_or_insert(hold.end_s);
        if end_s - since > KNOCK_S + self.grace_s {
            self.moves_since = None;
            self.grace_s = 0.0;
            self.end(since, found);
            self.phase = Phase::Moving;
        }
    }

    fn holds(&mut self, step: &Step, magnitude: f64, found: &mut Vec<Decision>) {
        let Some(mut hold) = self.hold.take() else { return };
        hold.end_s = step.end_s;
        hold.all.join(&step.sums);
        hold.steps.push((step.start_s, step.sums));
        let count = hold.steps.len();
        if count >= 9 {
            let third = count / 3;
            let sums = |steps: &[(f64, Sums)]| Sums::joined(steps.iter().map(|(_, sums)| sums));
            let [first, last] = [&hold.steps[..third], &hold.steps[count - third..]].map(sums);
            let by = self.distance(&first, &last);
            if by > by_noise(&first, &first).max(SLIDE_SHARE * magnitude) {
                if !std::mem::replace(&mut hold.slid, true) {
                    found.push(Decision::Slides { by });
                }
                // what is at its end may be still; a hold that was counted stays one
                let start_s = if hold.told { hold.start_s } else { hold.steps[count - third].0 };
                let steps = hold.steps[count - third..].to_vec();
                hold = Hold { start_s, steps, all: last, ..hold };
            }
        }
        let seconds = hold.end_s - hold.start_s;
        if !hold.told && seconds >= self.limits.hold_s {
            hold.told = true;
            match hold.clips {
                Some(axis) => found.push(Decision::Clips { axis }),
                None => found.push(self.held(&hold, seconds)),
            }
        }
        self.phase = match (hold.told, hold.clips) {
            (false, _) => Phase::Holding,
            (true, None) => Phase::Held,
            (true, Some(_)) => Phase::Refused,
        };
        self.hold = Some(hold);
    }

    fn end(&mut self, end_s: f64, found: &mut Vec<Decision>) {
        let Some(hold) = self.hold.take() else { return };
        self.grace_s = 0.0;
        let (seconds, Limits { least_s, .. }) = (end_s - hold.start_s, self.limits);
        if hold.told || seconds >= least_s {
            match hold.clips {
                _ if hold.told => {}
                Some(axis) => found.push(Decision::Clips { axis }),
                None => found.push(self.held(&hold, seconds)),
            }
            found.push(Decision::Ended { start_s: hold.start_s, end_s });
        } else if seconds > 0.5 * least_s {
            found.push(Decision::Short { seconds, needed_s: least_s });
        }
        self.moves_since = None;
    }

    fn held(&self, hold: &Hold, seconds: f64) -> Decision {
        let mean = self.window.reading(&hold.all, 0).unwrap_or_default();
        Decision::Held { start_s: hold.start_s, seconds, mean }
    }

    /// The words for what shakes: `x shakes 0.08 m/s², 0.03 would do`.
    pub(crate) fn why(&self) -> String {
        // a turn needs no such words
        let Some((axis, sd, limit)) = self.shakes.filter(|(_, sd, limit)| *sd < 10.0 * limit) else {
            return String::new();
        };
        let name = Axis::ALL[axis % 3];
        let two = |value: f64| calibrant_core::number_format::significant(value, 2);
        if axis < 3 {
            let unit = if self.limits.in_si[0] { " m/s²" } else { "" };
            format!("{name} shakes by {}{unit}, {} would do", two(sd), two(limit))
        } else if self.limits.in_si[1] {
            format!(
                "it turns about {name} by {} °/s, {} would do",
                two(sd.to_degrees()),
                two(limit.to_degrees())
            )
        } else {
            format!("the gyroscope's {name} shakes by {}, {} would do", two(sd), two(limit))
        }
    }
}

/// How far noise takes two means of the accelerometer from each other: `scatter` tells the noise, `of_mean` how many samples a mean has.
fn by_noise(scatter: &Sums, of_mean: &Sums) -> f64 {
    let variance = |axis: usize| scatter.sd(axis).powi(2) / of_mean.count(axis).max(1.0);
    DRIFT_SDS * (2.0 * (0..3).map(variance).sum::<f64>()).sqrt()
}

#[cfg(test)]
mod tests;
