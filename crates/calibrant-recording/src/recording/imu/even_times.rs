//! Even times in place of those that a host's clock made.
//!
//! A sensor often samples evenly, and a host logs its samples with the steps of a coarse clock: 5, 10 and 15 ms in turn. A rate that is
//! integrated over such steps turns too far, then too little. Even times are those of the line through all logged ones.

use calibrant_core::error::{InputError, Refusal};
use calibrant_core::number_format::plain;
use serde::{Deserialize, Serialize};

/// Which times the samples have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SampleTimes {
    /// Even ones: the line through the logged times.
    Even,
    /// The logged ones.
    AsLogged,
}

impl SampleTimes {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Even, Self::AsLogged];

    /// As a user writes it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Even => "even",
            Self::AsLogged => "as-logged",
        }
    }
}

/// Fewer samples are not judged.
const FEWEST: usize = 100;
/// A clock with more different steps has no coarse tick.
const MOST_STEPS: usize = 12;
/// Steps are multiples of the tick to this share of it.
const MULTIPLE: f64 = 1e-3;
/// Largest distance between the line and logged times before and after it, in ticks. A lost sample moves all times after it.
const MOST_TICKS: f64 = 3.0;
/// A host is late by more, but then the medians of each such number of samples are on the line, to half a sample: a lost sample would move all that follow
/// by a whole one.
const BLOCK: usize = 50;
const MEDIAN_STEPS: f64 = 0.5;
/// The share of a step that such a tick is. Where it is less, the samples come in packets; where it is more, it is the step itself, and samples are lost.
const TICK: std::ops::RangeInclusive<f64> = 0.25..=0.7;
/// A coarser tick, in even steps, may be that of packets, and a lost packet would not show.
const COARSEST: f64 = 2.0;
/// The two samples of a pair are logged within this share of a step.
const SHORT: f64 = 1.0 / 3.0;
/// A logged step longer than this number of even steps is a gap.
const GAP: f64 = 5.0;

/// The line through logged times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct EvenTimes {
    first_s: f64,
    pub(super) step_s: f64,
    /// The tick of the clock, s, where it has one.
    pub(super) tick_s: Option<f64>,
}

impl EvenTimes {
    /// Even times, where the logged ones are steps of a coarse clock about them, or the host read two samples at a time. `None` where they are even as
    /// logged, or uneven by more.
    pub(super) fn found(times: &[f64]) -> Option<Self> {
        Self::of_ticks(times).or_else(|| Self::of_pairs(times))
    }

    /// Even times about samples that a host read in pairs: each is logged within half a step of its even time, and a lost sample would move all that
    /// follow by a whole one.
    fn of_pairs(times: &[f64]) -> Option<Self> {
        let line = Self::line(times)?;
        let (least, most) = line.off(times);
        let long = steps(times).filter(|step| *step > line.step_s).count() as f64;
        let short = steps(times).filter(|step| *step < SHORT * line.step_s).count() as f64;
        let is_half = |count: f64| (count / (times.len() - 1) as f64 - 0.5).abs() < 0.02;
        (is_half(long) && is_half(short) && most - least <= line.step_s).then_some(line)
    }

    fn of_ticks(times: &[f64]) -> Option<Self> {
        let tick_s = tick(times)?;
        let line = Self { tick_s: Some(tick_s), ..Self::line(times)? };
        let (least, most) = line.off(times);
        let longest_s = steps(times).fold(0.0, f64::max);
        let is_even = tick_s <= COARSEST * line.step_s
            && (most - least <= (MOST_TICKS * tick_s).min(2.0 * line.step_s.max(tick_s))
                || line.median_range_s(times) <= MEDIAN_STEPS * line.step_s
                    && (TICK.start() * line.step_s..=TICK.end() * line.step_s).contains(&tick_s))
            && longest_s <= GAP * line.step_s.max(tick_s);
        is_even.then_some(line)
    }

    /// Even times, because the user says so.
    pub(super) fn asked(times: &[f64]) -> Result<Self, Box<InputError>> {
        let refused = |message: String| {
            let help = "use times = \"as-logged\", or cut the recording there";
            Box::new(InputError::new(Refusal::RateContradicted, message, help))
        };
        let line =
            Self::line(times).ok_or_else(|| refused("the times are not those of even samples".into()))?;
        let gap = times.array_windows().find(|[one, next]| next - one > GAP * line.step_s);
        match gap {
            Some([one, next]) => Err(refused(format!(
                "the samples are not even: there is none from {} to {} s",
                plain(*one, 6),
                plain(*next, 6)
            ))),
            None => Ok(Self { tick_s: tick(times), ..line }),
        }
    }

    /// Least squares; `None` where times are missing or go back.
    fn line(times: &[f64]) -> Option<Self> {
        let n = times.len() as f64;
        if times.len() < FEWEST || !steps(times).all(|step| step >= 0.0) {
            return None;
        }
        let middle = 0.5 * (n - 1.0);
        let mean = times[0] + times.iter().map(|t| t - times[0]).sum::<f64>() / n;
        let sum: f64 = times.iter().enumerate().map(|(k, t)| (k as f64 - middle) * (t - mean)).sum();
        let step_s = sum * 12.0 / (n * (n * n - 1.0));
        (step_s > 0.0).then_some(Self { first_s: mean - middle * step_s, step_s, tick_s: None })
    }

    /// How far logged times are before and after the line, s.
    fn off(&self, times: &[f64]) -> (f64, f64) {
        let off = times.iter().enumerate().map(|(k, t)| t - self.at(k));
        off.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), off| (least.min(off), most.max(off)))
    }

    /// The range of the medians of blocks beside the line, s.
    fn median_range_s(&self, times: &[f64]) -> f64 {
        let mut off: Vec<f64> = times.iter().enumerate().map(|(k, t)| t - self.at(k)).collect();
        let medians = off
            .chunks_exact_mut(BLOCK)
            .map(|block| *block.select_nth_unstable_by(BLOCK / 2, f64::total_cmp).1);
        let (least, most) = medians
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), off| (least.min(off), most.max(off)));
        most - least
    }

    /// The time of a sample, s.
    pub(super) fn at(&self, sample: usize) -> f64 {
        self.first_s + sample as f64 * self.step_s
    }
}

fn steps(times: &[f64]) -> impl Iterator<Item = f64> {
    times.array_windows().map(|[one, next]| next - one)
}

/// The tick of the clock that logged times are multiples of; `None` where their steps are all alike, or have no common tick.
fn tick(times: &[f64]) -> Option<f64> {
    let largest = times.iter().fold(0.0_f64, |most, t| most.max(t.abs()));
    let resolution = 4.0 * f64::EPSILON * largest;
    let mut different: Vec<f64> = Vec::new();
    for step in steps(times).filter(|step| *step > resolution) {
        if !different.iter().any(|other| (other - step).abs() <= MULTIPLE * step + resolution) {
            different.push(step);
        }
        if different.len() > MOST_STEPS {
            return None;
        }
    }
    different.sort_by(f64::total_cmp);
    let (least, longest) = (*different.first()?, *different.last()?);
    let has_equal_times = steps(times).any(|step| step <= resolution);
    if different.len() < 2 && !has_equal_times {
        return None;
    }
    let apart = different.array_windows().map(|[one, next]| next - one);
    let tick = apart.fold(least, f64::min);
    let is_multiple = |step: &f64| {
        (step / tick - (step / tick).round()).abs() <= MULTIPLE * longest / tick + resolution / tick
    };
    different.iter().all(is_multiple).then_some(tick)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Even samples of 100.2 Hz in steps of a clock, each logged up to `late_s` later.
    fn logged(tick_s: f64, late_s: f64) -> Vec<f64> {
        let late = |k: usize| late_s * ((k * 7919 % 101) as f64 / 101.0);
        (0..5000).map(|k| ((k as f64 / 100.2 + late(k)) / tick_s).floor() * tick_s).collect()
    }

    #[test]
    fn even_samples_in_steps_of_a_coarse_clock_are_found() {
        for (tick_s, late_s) in [(0.005, 0.0), (0.005, 0.004), (0.001, 0.0), (0.0156, 0.0), (0.01, 0.0)] {
            let times = logged(tick_s, late_s);
            let even = EvenTimes::found(&times).unwrap_or_else(|| panic!("{tick_s} {late_s}"));
            assert!((even.tick_s.expect("found") / tick_s - 1.0).abs() < 1e-6, "{even:?}");
            assert!((even.step_s * 100.2 - 1.0).abs() < 2e-5, "{even:?}");
            assert!(
                (even.at(2500) - (2500.0 / 100.2 + 0.5 * late_s - 0.5 * tick_s)).abs() < 5e-4,
                "{even:?}"
            );
        }
    }

    #[test]
    fn a_host_that_is_late_now_and_then_is_seen_by_its_median_times() {
        // steps of 1, 2 or 3 ticks of 5.12 ms, and seldom of more
        let late = |k: usize| 0.001 * (k * 7919 % 11) as f64 / 11.0 + if k % 487 == 3 { 0.021 } else { 0.0 };
        let logged = |k: usize| ((k as f64 / 104.0 + late(k)) / 0.00512).ceil() * 0.00512;
        // a sample that is late keeps those behind it waiting
        let wait = |last: &mut f64, k: usize| {
            *last = last.max(logged(k));
            Some(*last)
        };
        let times: Vec<f64> = (0..5000).scan(0.0, wait).collect();
        let even = EvenTimes::found(&times).expect("even");
        assert!(
            (even.step_s * 104.0 - 1.0).abs() < 2e-5 && (even.tick_s.expect("found") - 0.00512).abs() < 1e-9
        );
        let mut lost = times;
        lost.drain(2000..2001);
        assert_eq!(EvenTimes::found(&lost), None, "one lost sample moves all times after it");
    }

    /// Steps of 1 to 5 ticks: each sample is late by up to 15 ms of its own.
    #[test]
    fn a_host_that_is_always_late_by_chance_has_even_samples() {
        let late = |k: usize| 0.015 * ((k * 7919) % 10_007) as f64 / 10_007.0;
        let next = |last: &mut f64, k: usize| {
            *last = (*last + 1.0).max(((k as f64 * 0.01 + late(k)) / 0.00512).floor());
            Some(*last * 0.00512)
        };
        let times: Vec<f64> = (0..6000).scan(-1.0, next).collect();
        let even = EvenTimes::found(&times).expect("even");
        assert!((even.step_s * 100.0 - 1.0).abs() < 2e-5, "{even:?}");
        let mut lost = times;
        lost.drain(3000..3001);
        assert_eq!(EvenTimes::found(&lost), None);
    }

    #[test]
    fn samples_that_a_host_reads_in_pairs_are_even() {
        let jitter = |k: usize| 3e-4 * (k * 7919 % 101) as f64 / 101.0;
        let pairs: Vec<f64> =
            (0..5000).map(|k| (k / 2) as f64 * 0.02 + (k % 2) as f64 * 0.002 + jitter(k)).collect();
        let even = EvenTimes::found(&pairs).expect("even");
        assert!((even.step_s * 100.0 - 1.0).abs() < 1e-5, "{even:?}");
        let mut lost = pairs;
        lost.drain(2000..2002);
        assert_eq!(EvenTimes::found(&lost), None, "a lost pair");
    }

    #[test]
    fn other_times_stay_as_they_were_logged() {
        let even: Vec<f64> = (0..5000).map(|k| 1.7e9 + k as f64 * 0.01).collect();
        assert_eq!(EvenTimes::found(&even), None, "even already");
        let uneven: Vec<f64> = (0..5000).map(|k| k as f64 * 0.01 + 0.004 * (k as f64 * 0.7).sin()).collect();
        assert_eq!(EvenTimes::found(&uneven), None, "no tick");
        let mut lost = logged(0.005, 0.0);
        lost.drain(2000..2003);
        assert_eq!(EvenTimes::found(&lost), None, "lost samples");
        let pauses: Vec<f64> = (0..5000).map(|k| (k + 500 * (k / 1000)) as f64 * 0.01).collect();
        assert_eq!(EvenTimes::found(&pauses), None, "pauses");
        assert!(
            EvenTimes::asked(&pauses).expect_err("a gap").message.contains("none from 9.99 to 15"),
            "named"
        );
        assert!(EvenTimes::asked(&uneven).is_ok());
    }
}
