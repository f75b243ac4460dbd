//! Sample times in seconds: from a column of times, or from a counter and the sample rate.

use super::column::ColumnMeaning;
use super::column_values::Samples;
use super::even_times::{EvenTimes, SampleTimes};
use super::file_layout::Draft;
use super::options::ImuReadOptions;
use super::unit::TimeUnit;
use crate::recording::finding_words::short;
use crate::recording::reader_finding::{Finding, Noticed};
use crate::text_decoding::Checked;
use calibrant_core::error::{InputError, Refusal};

/// Times beyond this, s, count from another epoch than the recording's. They then count from the first.
const EPOCH_S: f64 = 1e8;
/// Largest plausible time, s.
const LARGEST_S: f64 = 1e12;
/// A stated rate and a given one may differ by this share.
const SAME_RATE: f64 = 1e-3;

/// Are there sample times? A clock that most rows lack does not count, where there is a counter.
pub(super) fn are_recorded(samples: &Samples) -> bool {
    let present = samples.times.iter().filter(|t| t.is_finite()).count();
    present > 0 && (2 * present > samples.rows || samples.counts.is_empty())
}

/// Sample times of the rows, s; NaN where a row has none.
pub(super) fn times(
    draft: &mut Draft,
    samples: &mut Samples,
    options: &ImuReadOptions,
    findings: &mut Vec<Finding>,
) -> Checked<Vec<f64>> {
    let rate = rate(draft, options)?;
    let times = &samples.times;
    let has_counter = !samples.counts.is_empty();
    if are_recorded(samples) {
        draft.leave_aside(ColumnMeaning::Counter, "there are sample times");
        return of_times(draft, samples, findings);
    }
    let is_empty = !times.is_empty();
    draft.leave_aside(ColumnMeaning::Time, "most of its values are missing");
    let Some((rate_hz, stated_by)) = rate else {
        let empty = if is_empty { "its sample times are missing" } else { "the file has no sample times" };
        let answer = "--rate-hz, or rate_hz in [columns]: the sample rate in Hz, as it was set when the recording was made";
        let message = format!("{empty}, and nothing in it says the sample rate");
        return Err(InputError::question(Refusal::RateUnknown, message, vec![answer.into()]).into());
    };
    let counter = has_counter
        .then(|| draft.column(ColumnMeaning::Counter).map_or_else(String::new, |column| column.name.clone()));
    findings.push(Finding::new(Noticed::TimesDerived { is_empty, counter, rate_hz, stated_by }));
    match has_counter {
        true => of_counter(draft, samples, rate_hz),
        false => Ok((0..samples.rows).map(|row| row as f64 / rate_hz).collect()),
    }
}

/// Times of the rows from the given rate. They replace those in the file, which are not times of samples.
pub(super) fn of_rows(rows: usize, rate_hz: f64, findings: &mut Vec<Finding>) -> Vec<f64> {
    findings.push(Finding::new(Noticed::PacketTimesReplaced(rate_hz)));
    (0..rows).map(|row| row as f64 / rate_hz).collect()
}

/// Puts samples at even times, where these are asked for, or where the logged times are steps of a coarse clock.
pub(super) fn make_even(
    times: &mut [f64],
    samples: &Samples,
    options: &ImuReadOptions,
    findings: &mut Vec<Finding>,
) -> Checked<()> {
    let is_twice = |row: usize| times[row] == times[row - 1] && samples.repeats(row, row - 1);
    let even = match options.times {
        Some(SampleTimes::AsLogged) => None,
        Some(SampleTimes::Even) => Some(EvenTimes::asked(times)?),
        None => EvenTimes::found(times).filter(|_| !(1..times.len()).any(is_twice)),
    };
    if let Some(even) = even {
        times.iter_mut().enumerate().for_each(|(row, time_s)| *time_s = even.at(row));
        findings.push(Finding::new(Noticed::TimesEven { rate_hz: 1.0 / even.step_s, tick_s: even.tick_s }));
    }
    Ok(())
}

/// The stated or given sample rate, and the key that states it.
fn rate(draft: &Draft, options: &ImuReadOptions) -> Checked<Option<(f64, Option<&'static str>)>> {
    if let Some(rate) = options.rate_hz
        && !(rate.is_finite() && (1e-6..=1e9).contains(&rate))
    {
        return Err(InputError::new(
            Refusal::ValueInvalid,
            format!("a sample rate of {rate:?} Hz makes no sense"),
            "give it in Hz",
        )
        .into());
    }
    match (options.rate_hz, draft.rate_hz) {
        (Some(given), Some((stated, key))) if (given / stated - 1.0).abs() > SAME_RATE => {
            let message = format!(
                "the file says `{key}` {} Hz, but the rate was given as {} Hz",
                short(stated),
                short(given)
            );
            Err(InputError::new(Refusal::RateContradicted, message, "leave --rate-hz away").into())
        }
        (Some(given), None) => Ok(Some((given, None))),
        (_, stated) => Ok(stated.map(|(rate, key)| (rate, Some(key)))),
    }
}

fn of_times(draft: &Draft, samples: &mut Samples, findings: &mut Vec<Finding>) -> Checked<Vec<f64>> {
    let ticks = std::mem::take(&mut samples.times);
    let name = draft.column(ColumnMeaning::Time).map_or_else(String::new, |column| column.name.clone());
    let Some(unit) = draft.time_unit() else { return Err(which_unit(&name, &ticks).into()) };
    let per_second = unit.per_second().unwrap_or(1.0);
    let (mut ticks, wraps) = unwrap(ticks, draft.time_wraps_at);
    if wraps > 0 {
        findings.push(Finding::new(Noticed::ClockWrapped(name.clone(), wraps)));
    }
    let first = ticks.iter().copied().find(|t| t.is_finite()).unwrap_or(0.0);
    let whole = first.fract() == 0.0 && unit != TimeUnit::Second;
    let epoch = samples.origin as f64 + first;
    if draft.time_wraps_at.is_some() {
        ticks.iter_mut().for_each(|t| *t -= first);
    } else if whole && (epoch / per_second).abs() > EPOCH_S {
        ticks.iter_mut().for_each(|t| *t -= first);
        let first = (first as i128).saturating_add(samples.origin.into());
        samples.counted_from_ns = first.checked_mul((1e9 / per_second) as i128);
        let noticed = Noticed::TimesFromFirst { column: name.clone(), first, unit: unit.symbol() };
        findings.push(Finding::new(noticed));
    } else if samples.origin != 0 {
        ticks.iter_mut().for_each(|t| *t += samples.origin as f64);
    }
    ticks.iter_mut().for_each(|t| *t /= per_second);
    if let Some(row) = ticks.iter().position(|t| t.abs() > LARGEST_S) {
        let input_error = InputError::new(
            Refusal::ValueOutOfRange,
            format!("the time {} s in `{name}` is out of range", short(ticks[row])),
            "is the unit of the time right?",
        );
        return Err(at(input_error, samples, row).into());
    }
    Ok(ticks)
}

fn of_counter(draft: &Draft, samples: &mut Samples, rate: f64) -> Checked<Vec<f64>> {
    let counts = std::mem::take(&mut samples.counts);
    // a counter that exceeds its width once is wider
    let wraps_at =
        draft.counter_wraps_at.map(|at| if counts.iter().any(|n| *n >= at) { 2.0_f64.powi(32) } else { at });
    let (mut counts, _) = unwrap(counts, wraps_at);
    let first = counts.iter().copied().find(|n| n.is_finite()).unwrap_or(0.0);
    counts.iter_mut().for_each(|n| *n = (*n - first) / rate);
    Ok(counts)
}

/// Ticks that continue where the clock restarts, and the number of restarts. A step back of more than half
/// its width is a restart.
fn unwrap(mut ticks: Vec<f64>, wraps_at: Option<f64>) -> (Vec<f64>, usize) {
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

/// The question about the unit of the time.
fn which_unit(name: &str, ticks: &[f64]) -> InputError {
    let mut steps: Vec<f64> =
        ticks.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).collect();
    let middle = steps.len() / 2;
    let hint = if steps.is_empty() {
        String::new()
    } else {
        let (_, step, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
        let plausible = |unit: &TimeUnit| {
            unit.per_second().is_some_and(|per_second| (5.0..=5000.0).contains(&(per_second / *step)))
        };
        let units = [TimeUnit::Second, TimeUnit::Millisecond, TimeUnit::Microsecond, TimeUnit::Nanosecond];
        match units.iter().filter(|unit| plausible(unit)).collect::<Vec<_>>().as_slice() {
            [one] => format!(": steps of {} suggest {}", short(*step), one.symbol()),
            _ => format!(": steps of {} may be anything", short(*step)),
        }
    };
    let is_number = name.parse::<usize>().is_ok();
    let or = if is_number { "" } else { ", or end its name in _s, _ms, _us or _ns" };
    InputError::question(
        Refusal::UnitUnknown,
        format!("the time column `{name}` has no unit{hint}"),
        vec![format!("--time-unit s, ms, us or ns (time_unit in [columns]){or}")],
    )
}

/// The error, at the line of a row where rows have lines.
pub(super) fn at(input_error: InputError, samples: &Samples, row: usize) -> InputError {
    match samples.lines.line(row) {
        Some(line) => input_error.at_line(line),
        None => input_error,
    }
}
