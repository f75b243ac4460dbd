//! Sample times in seconds: from a column of times, or from a counter and the sample rate.

use super::column::ColumnMeaning;
use super::column_names;
use super::column_values::Samples;
use super::even_times::{EvenTimes, SampleTimes};
use super::file_layout::Draft;
use super::format::FileFormat;
use super::options::{ImuReadOptions, TYPED_RATE_SD_PPM, USUAL_RATE_SD_PPM};
use crate::recording::clock_column::{ClockColumn, unwrap};
use crate::recording::time_order::{is_clock_out_of_order, late, sorted_rows};
use crate::text::decoding::{Checked, refuse};
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::reader::{ClockSource, ClockSourceKind, RateUnlikeTimes, RowsSorted, quoted};
use calibrant_core::error::{Answer, InputError, Refusal, TaskOption};
use calibrant_core::number_format::plain;
use calibrant_core::sensor::{Axis, SensorKind};

/// Key of a rate that a comment states.
pub(super) const COMMENT: &str = "rate in a comment";
/// A given rate is another one than that of the times if it differs by this share.
const UNLIKE: f64 = 0.01;
/// A stated rate and a given one may differ by this share.
const SAME_RATE: f64 = 1e-3;

/// Fewer times are not judged.
const FEWEST: usize = 20;

/// Takes out a column that its name alone makes a time: `T` may be a temperature. A clock goes forward: hardly a step in three goes back,
/// and not all times are the same; or it does so once its rows are in order.
pub(super) fn leave_no_clock(draft: &mut Draft, samples: &mut Samples, options: &ImuReadOptions) {
    let Some(column) = draft.column(ColumnMeaning::Time) else { return };
    let known: Vec<f64> = samples.times.iter().copied().filter(|t| t.is_finite()).collect();
    let count = |is: fn(f64) -> bool| known.array_windows().filter(|[one, next]| is(next - one)).count();
    let (forward, back) = (count(|step| step > 0.0), count(|step| step < 0.0));
    // the type of a message or a column states it, but a driver may leave its stamps empty
    let by_type = back > 0
        && match draft.format {
            FileFormat::Mcap | FileFormat::Db3 | FileFormat::Rosbag => true,
            FileFormat::Ulog | FileFormat::DataFlash => true,
            FileFormat::Parquet => column.unit.is_some() && options.time_unit.is_none(),
            _ => false,
        };
    let is_stated =
        by_type || column_names::column(&column.name).unit.is_some() || options.columns.time.is_some();
    let is_none = known.len() >= FEWEST && (forward == 0 || 3 * back > forward);
    if !is_stated && is_none && !is_clock_out_of_order(&known) {
        draft.leave_aside(ColumnMeaning::Time, "its values go back and forth, or stay: it is no clock");
        samples.times.clear();
    }
}

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
    findings: &mut Vec<Diagnostic>,
) -> Checked<Vec<f64>> {
    if options.rows_are_holds {
        for meaning in [ColumnMeaning::Time, ColumnMeaning::RestOfSecond, ColumnMeaning::Counter] {
            draft.leave_aside(meaning, "each row is a hold");
        }
        return Ok((0..samples.rows).map(|row| row as f64).collect());
    }
    let rate = rate(draft, options)?;
    let times = &samples.times;
    let has_counter = !samples.counts.is_empty();
    if are_recorded(samples) {
        draft.leave_aside(ColumnMeaning::Counter, "there are sample times");
        // of the clock that gave them; beside a rate, which is not used, it is of that
        samples.rate_sd_ppm = options.rate_sd_ppm.filter(|_| options.rate_hz.is_none());
        return of_times(draft, samples, findings);
    }
    let is_empty = !times.is_empty();
    draft.leave_aside(ColumnMeaning::Time, "most of its values are missing");
    let Some((rate_hz, stated_by)) = rate else {
        return Err(question(draft, is_empty).into());
    };
    let counter = has_counter
        .then(|| draft.column(ColumnMeaning::Counter).map_or_else(String::new, |column| column.name.clone()));
    let is_logged = stated_by.is_some_and(|key| key != COMMENT);
    let sd_ppm = options.rate_sd_ppm.unwrap_or(if is_logged { USUAL_RATE_SD_PPM } else { TYPED_RATE_SD_PPM });
    samples.rate_sd_ppm = Some(sd_ppm);
    let clock = ClockSourceKind::Derived { is_empty, counter, rate_hz, stated_by, sd_ppm };
    findings.push(ClockSource { clock }.into());
    match has_counter {
        true => of_counter(draft, samples, rate_hz),
        false => Ok((0..samples.rows).map(|row| row as f64 / rate_hz).collect()),
    }
}

/// The question about the clock: which column it is, or else the rate.
fn question(draft: &Draft, is_empty: bool) -> InputError {
    if let Some(name) = draft.may_be_clocks.first() {
        let message = format!(
            "no column is known to be the sample times, but {} may be: its values only go up",
            quoted(&draft.may_be_clocks, 3)
        );
        let answer = Answer::new(TaskOption::Columns, []).and(format!(
            " FILE with time = \"{name}\" and time_unit (s, ms, us, ns; samples of a counter, with rate_hz), or these in [columns] of the experiment file"
        ));
        return InputError::question(Refusal::RateUnknown, message, vec![answer]);
    }
    let none = draft.columns.iter().find(|column| {
        let by_name = column_names::column(&column.name).meaning;
        by_name == ColumnMeaning::Time && !column.is_used()
    });
    let empty = match none {
        Some(column) if !is_empty => {
            format!("`{}` is no clock, and the file has no other sample times", column.name)
        }
        _ if is_empty => "its sample times are missing".to_owned(),
        _ => "the file has no sample times".to_owned(),
    };
    let rate = ", or rate_hz in [columns]: the sample rate in Hz, as it was measured, or as it was set; then how well it is known, option `rate_sd_ppm`";
    let has = |sensor_kind| draft.column(ColumnMeaning::Reading(sensor_kind, Axis::X)).is_some();
    let means = match has(SensorKind::Accelerometer) && !has(SensorKind::Gyroscope) {
        true => "; where each row is the mean of a hold, option `rows_are_holds`",
        false => "",
    };
    let answer = Answer::new(TaskOption::RateHz, []).and(format!("{rate}{means}"));
    let message = format!("{empty}, and nothing in it says the sample rate");
    InputError::question(Refusal::RateUnknown, message, vec![answer])
}

/// Times of the rows from the given rate. They replace those in the file, which are not times of samples.
pub(super) fn of_rows(
    samples: &mut Samples,
    (rate_hz, sd_ppm): (f64, f64),
    findings: &mut Vec<Diagnostic>,
) -> Vec<f64> {
    samples.rate_sd_ppm = Some(sd_ppm);
    findings.push(ClockSource { clock: ClockSourceKind::Packets { rate_hz, sd_ppm } }.into());
    (0..samples.rows).map(|row| row as f64 / rate_hz).collect()
}

/// What there is to say of a given rate where the samples have times: it is not used.
pub(super) fn not_used(given_hz: f64, found_hz: f64) -> Diagnostic {
    match (given_hz / found_hz - 1.0).abs() > UNLIKE {
        true => RateUnlikeTimes { given_hz, found_hz }.into(),
        false => ClockSource { clock: ClockSourceKind::RateUnused }.into(),
    }
}

/// Puts rows in the order of their times, where these are those of one clock, but not in order. A sensor may have rows of its own, so each counts alone.
pub(super) fn put_in_order(draft: &Draft, samples: &mut Samples) -> Option<Diagnostic> {
    let times = &samples.times;
    let of_sensor = |sensor_kind: SensorKind| -> Vec<f64> {
        let holds = |row: &usize| !times[*row].is_nan() && samples.holds(sensor_kind, *row);
        (0..times.len()).filter(holds).map(|row| times[row]).collect()
    };
    let out_of_order: Vec<Vec<f64>> =
        SensorKind::ALL.map(of_sensor).into_iter().filter(|times| !times.is_sorted()).collect();
    let first = out_of_order.first()?;
    if !out_of_order.iter().all(|times| is_clock_out_of_order(times)) {
        return None;
    }
    let rows = sorted_rows(times);
    samples.reorder(&rows);
    let clock = draft.column(ColumnMeaning::Time).map_or("", |column| column.name.as_str());
    Some(RowsSorted { rows: late(first.iter().copied()), of: first.len(), by: format!("`{clock}`") }.into())
}

/// Puts samples at even times, where these are asked for, or where the logged times are steps of a coarse clock.
pub(super) fn make_even(
    times: &mut [f64],
    samples: &Samples,
    options: &ImuReadOptions,
    findings: &mut Vec<Diagnostic>,
) -> Checked<()> {
    let is_twice = |row: usize| times[row] == times[row - 1] && samples.repeats(row, row - 1);
    let even = match options.times {
        Some(SampleTimes::AsLogged) => None,
        Some(SampleTimes::Even) => Some(EvenTimes::asked(times)?),
        None => EvenTimes::found(times).filter(|_| !(1..times.len()).any(is_twice)),
    };
    if let Some(even) = even {
        times.iter_mut().enumerate().for_each(|(row, time_s)| *time_s = even.at(row));
        let clock = ClockSourceKind::Even { rate_hz: 1.0 / even.step_s, tick_s: even.tick_s };
        findings.push(ClockSource { clock }.into());
    }
    Ok(())
}

/// The stated or given sample rate, and the key that states it.
fn rate(draft: &Draft, options: &ImuReadOptions) -> Checked<Option<(f64, Option<&'static str>)>> {
    if let Some(rate) = options.rate_hz
        && !(rate.is_finite() && (1e-6..=1e9).contains(&rate))
    {
        return refuse(
            Refusal::ValueInvalid,
            format!("a sample rate of {rate:?} Hz makes no sense"),
            "give it in Hz",
        );
    }
    match (options.rate_hz, draft.rate_hz) {
        (Some(given), Some((stated, key))) if (given / stated - 1.0).abs() > SAME_RATE => {
            let message = format!(
                "the file says `{key}` {} Hz, but the rate was given as {} Hz",
                plain(stated, 6),
                plain(given, 6)
            );
            refuse(Refusal::RateContradicted, message, "leave option `rate_hz` away")
        }
        (Some(given), None) => Ok(Some((given, None))),
        (_, stated) => Ok(stated.map(|(rate, key)| (rate, Some(key)))),
    }
}

fn of_times(draft: &Draft, samples: &mut Samples, findings: &mut Vec<Diagnostic>) -> Checked<Vec<f64>> {
    let column = draft.column(ColumnMeaning::Time);
    let clock = ClockColumn {
        name: column.map_or("", |column| column.name.as_str()),
        unit: draft.time_unit(),
        wraps_at: draft.time_wraps_at,
        origin: samples.origin,
        section: "columns",
    };
    let seconds = clock.seconds(std::mem::take(&mut samples.times), &samples.lines, findings)?;
    samples.counted_from_ns = seconds.counted_from_ns;
    Ok(seconds.times_s)
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
