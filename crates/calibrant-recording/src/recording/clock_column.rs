//! Times in seconds of a column of times, whatever their unit and their epoch.

use super::line_map::LineMap;
use super::time_unit::TimeUnit;
use crate::text::decoding::Checked;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::reader::{ClockSource, ClockSourceKind, Ticks, TimesFromFirst};
use calibrant_core::error::{Answer, InputError, Refusal, TaskOption};
use calibrant_core::number_format::plain;

/// Times beyond this, s, count from another epoch than the recording's. They then count from the first.
pub(crate) const EPOCH_S: f64 = 1e8;
/// Largest plausible time, s.
const LARGEST_S: f64 = 1e12;

/// A column of times.
pub(crate) struct ClockColumn<'n> {
    pub(crate) name: &'n str,
    /// `None` where the user has to say it.
    pub(crate) unit: Option<TimeUnit>,
    /// The clock restarts at this number of ticks.
    pub(crate) wraps_at: Option<f64>,
    /// The number that was subtracted from each time, in its ticks.
    pub(crate) origin: i64,
    /// The section of an experiment file that may say its unit.
    pub(crate) section: &'static str,
}

/// Times of rows.
pub(crate) struct Seconds {
    /// Times, s; NaN where a row has none.
    pub(crate) times_s: Vec<f64>,
    /// The time from which they count, ns, where they count from their first.
    pub(crate) counted_from_ns: Option<i128>,
}

impl ClockColumn<'_> {
    /// The times in seconds; a question where their unit is unknown.
    pub(crate) fn seconds(
        &self,
        ticks: Vec<f64>,
        lines: &LineMap,
        findings: &mut Vec<Diagnostic>,
    ) -> Checked<Seconds> {
        let name = self.name;
        let Some(unit) = self.unit.or_else(|| since_1970(&ticks, self.origin)) else {
            return Err(which_unit(name, self.section, &ticks).into());
        };
        let per_second = unit.per_second().unwrap_or(1.0);
        let wraps_at = self.wraps_at.or_else(|| wraps_in_32_bits(&ticks, per_second));
        let (mut ticks, wraps) = unwrap(ticks, wraps_at);
        if wraps > 0 {
            findings.push(ClockSource { clock: ClockSourceKind::Wrapped(name.to_owned(), wraps) }.into());
        }
        let first = ticks.iter().copied().find(|t| t.is_finite()).unwrap_or(0.0);
        let whole = first.fract() == 0.0 && unit != TimeUnit::Second;
        let epoch = self.origin as f64 + first;
        let mut counted_from_ns = None;
        if self.wraps_at.is_some() {
            ticks.iter_mut().for_each(|t| *t -= first);
        } else if whole && (epoch / per_second).abs() > EPOCH_S {
            ticks.iter_mut().for_each(|t| *t -= first);
            let first = (first as i128).saturating_add(self.origin.into());
            counted_from_ns = first.checked_mul((1e9 / per_second) as i128);
            let (column, first) = (name.to_owned(), Ticks(first));
            findings.push(TimesFromFirst { column, first, unit: unit.symbol() }.into());
        } else if self.origin != 0 {
            ticks.iter_mut().for_each(|t| *t += self.origin as f64);
        }
        ticks.iter_mut().for_each(|t| *t /= per_second);
        if let Some(row) = ticks.iter().position(|t| t.abs() > LARGEST_S) {
            let input_error = InputError::new(
                Refusal::ValueOutOfRange,
                format!("the time {} s in `{name}` is out of range", plain(ticks[row], 6)),
                "is the unit of the time right?",
            );
            return Err(lines.at(input_error, row).into());
        }
        Ok(Seconds { times_s: ticks, counted_from_ns })
    }
}

/// Width of a counter of 32 bits, if the ticks begin anew as such a counter does: with the step back, the next time is at most a second later.
fn wraps_in_32_bits(ticks: &[f64], per_second: f64) -> Option<f64> {
    const WIDTH: f64 = (1_u64 << 32) as f64;
    let mut back = ticks.array_windows().filter(|[one, next]| next < one).peekable();
    back.peek()?;
    back.all(|[one, next]| (0.0..=per_second).contains(&(next + WIDTH - one))).then_some(WIDTH)
}

/// The error for times that go backwards, with the first that does, s.
pub(crate) fn backwards((before, t): (f64, f64), times: impl Iterator<Item = f64> + Clone) -> InputError {
    /// Clocks begin anew, or are set, this often at most.
    const FEW: usize = 3;
    let times_back = times.clone().zip(times.skip(1)).filter(|(one, next)| next < one).count();
    let often = if times_back > 1 { format!(" {times_back} times, first") } else { ",".to_owned() };
    let help = match times_back > FEW {
        true => {
            "write the rows in the order in which the samples were taken: they cannot be sorted by these times"
        }
        false => "are these files put together, or did a counter wrap? split the file here",
    };
    let message = format!("time goes backwards{often} from {before:?} s to {t:?} s");
    InputError::new(Refusal::TimesNotIncreasing, message, help)
}

/// Ticks that continue where the clock restarts, and the number of restarts. A step back of more than half
/// its width is a restart.
pub(crate) fn unwrap(mut ticks: Vec<f64>, wraps_at: Option<f64>) -> (Vec<f64>, usize) {
    let Some(width) = wraps_at else { return (ticks, 0) };
    let (mut before, mut wraps) = (f64::NAN, 0);
    for tick in &mut ticks {
        if before - *tick > width / 2.0 {
            wraps += 1;
        }
        before = if tick.is_nan() { before } else { *tick };
        *tick += wraps as f64 * width;
    }
    (ticks, wraps)
}

/// The units of clocks.
const UNITS: [TimeUnit; 4] =
    [TimeUnit::Second, TimeUnit::Millisecond, TimeUnit::Microsecond, TimeUnit::Nanosecond];

/// The step between most samples, in ticks.
pub(crate) fn median_step(ticks: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> =
        ticks.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).collect();
    let middle = steps.len() / 2;
    (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Is this the step of a sensor, with this unit?
fn is_plausible(step: f64, unit: TimeUnit) -> bool {
    unit.per_second().is_some_and(|per_second| (5.0..=5000.0).contains(&(per_second / step)))
}

/// The unit of a clock that counts from 1970: one in which its times are of 2001 to 2039, and its steps those of a sensor.
fn since_1970(ticks: &[f64], origin: i64) -> Option<TimeUnit> {
    let first = origin as f64 + ticks.iter().copied().find(|t| t.is_finite())?;
    let step = median_step(ticks)?;
    let is_date = |unit: &TimeUnit| {
        unit.per_second().is_some_and(|per_second| (1e9..2.2e9).contains(&(first / per_second)))
    };
    UNITS.into_iter().find(|unit| is_date(unit) && is_plausible(step, *unit))
}

/// The question about the unit of the time.
fn which_unit(name: &str, section: &str, ticks: &[f64]) -> InputError {
    let hint = match median_step(ticks) {
        None => String::new(),
        Some(step) => {
            match UNITS.iter().filter(|unit| is_plausible(step, **unit)).collect::<Vec<_>>().as_slice() {
                [one] => format!(": steps of {} suggest {}", plain(step, 6), one.symbol()),
                _ => format!(": steps of {} may be anything", plain(step, 6)),
            }
        }
    };
    let is_number = name.parse::<usize>().is_ok();
    let or = if is_number { "" } else { ", or end its name in _s, _ms, _us or _ns" };
    InputError::question(
        Refusal::UnitUnknown,
        format!("the time column `{name}` has no unit{hint}"),
        vec![
            Answer::new(TaskOption::TimeUnit, ["s", "ms", "us", "ns"])
                .and(format!(" (time_unit in [{section}]){or}")),
        ],
    )
}
