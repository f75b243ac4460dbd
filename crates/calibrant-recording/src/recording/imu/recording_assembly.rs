//! Assembles a recording from the values of a file: times, units, missing and duplicate rows, and findings.

use super::column::ColumnMeaning;
use super::column_values::Samples;
use super::even_times::SampleTimes;
use super::file_layout::Draft;
use super::options::ImuReadOptions;
use super::packet_times::Packets;
use super::reading_unit::{
    COUNTS_HINT, check_gravity, check_rates, check_size, question, stated_unit, unit_option,
};
use super::sample_clock;
use super::unit::{ColumnUnit, ImuUnit};
use crate::recording::clock_column::backwards;
use crate::recording::line_map::LineMap;
use crate::recording::lost_sign;
use crate::recording::recording_quality;
use crate::recording::tally::Tally;
use crate::text::decoding::{Checked, refuse};
use calibrant_core::diagnostic::Check;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::reader::{
    ClockSource, LineTruncated, MissingValue, RowsRepeated, TemperatureDoubt, TemperatureDoubtful,
    TemperatureGaps, TimesFromFirst, TimesRepeated, UnitOverruled, ValuesMissing,
};
use calibrant_core::error::{Answer, Error, InputError, Refusal};
use calibrant_core::number_format::counted;
use calibrant_core::sensor::{ImuRecording, Recording, SensorKind, WORKING_C, interpolated, rate_hz};
use nalgebra::Vector3;
use std::iter::once;

/// Longest time without a temperature that needs no warning, s: a sensor warms up within minutes.
const LONG_WITHOUT_TEMPERATURE_S: f64 = 30.0;

/// The assembled recording, and the findings.
pub(super) struct Assembled {
    pub(super) recording: ImuRecording,
    pub(super) findings: Vec<Diagnostic>,
}

/// Assembles the recording. The draft records which of its columns were of no use.
pub(super) fn assemble(
    draft: &mut Draft,
    samples: &mut Samples,
    options: &ImuReadOptions,
) -> Checked<Assembled> {
    let mut findings = Vec::new();
    if samples.rows == 0 {
        let input_error =
            InputError::new(Refusal::RecordingShort, "there is a header but no sample below it", TWO);
        return Err(samples.last_line.map_or(input_error.clone(), |line| input_error.at_line(line)).into());
    }
    let sensor_kinds = with_values(draft, samples)?;
    let units = sensor_kinds
        .iter()
        .map(|&sensor_kind| stated_unit(draft, options, sensor_kind))
        .collect::<Checked<Vec<_>>>()?;
    findings.extend(overruled(draft, &sensor_kinds, &units));
    sample_clock::leave_no_clock(draft, samples, options);
    let has_times = sample_clock::are_recorded(samples) && !options.rows_are_holds;
    if has_times {
        findings.extend(sample_clock::put_in_order(draft, samples));
    }
    let times = sample_clock::times(draft, samples, options, &mut findings);
    // all questions come at once
    let mut times = match times {
        Ok(times) => times,
        Err(input_error) if units.contains(&None) => {
            return Err(ask(Some(*input_error), samples, &sensor_kinds, &units).into());
        }
        Err(input_error) => return Err(input_error),
    };
    if units.contains(&None) {
        return Err(ask(None, samples, &sensor_kinds, &units).into());
    }
    let is_plain = draft.plain.is_some();
    let alike = |row: usize| sensor_kinds.iter().all(|&sensor_kind| samples.holds(sensor_kind, row));
    let may_be_even = !is_plain || options.times == Some(SampleTimes::Even);
    if has_times && may_be_even && (0..samples.rows).all(alike) {
        sample_clock::make_even(&mut times, samples, options, &mut findings)?;
    }
    let mut of_rows = Vec::new();
    let mut kept = increasing(&times, &sensor_kinds, samples, &mut of_rows)?;
    let packets = |&sensor_kind: &SensorKind| Some((sensor_kind, Packets::of(&times, samples, sensor_kind)?));
    if let Some((sensor_kind, packets)) = sensor_kinds.iter().filter(|_| !is_plain).find_map(packets) {
        let Some(rate) = options.rate_hz.filter(|_| (0..samples.rows).all(alike)) else {
            return Err(packets.question(sensor_kind).into());
        };
        let by_times_ppm = packets.rate_sd_ppm(rate)?;
        let sd_ppm = options.rate_sd_ppm.unwrap_or(by_times_ppm);
        times = sample_clock::of_rows(samples, (rate, sd_ppm), &mut findings);
        (kept, of_rows) = (Kept { rows: times.len(), dropped: Vec::new() }, Vec::new());
    } else if let Some(given_hz) = options.rate_hz.filter(|_| has_times) {
        let kept_s: Vec<f64> = kept.rows().map(|row| times[row]).collect();
        findings.push(sample_clock::not_used(given_hz, rate_hz(&kept_s)));
    }
    findings.append(&mut of_rows);
    let mut recording = ImuRecording::default();
    let mut maps: Vec<LineMap> = Vec::new();
    for (&sensor_kind, unit) in sensor_kinds.iter().zip(units.iter().flatten()) {
        let (readings, lines) = readings(sensor_kind, *unit, &times, &kept, samples, &mut findings)?;
        let readings = readings.with_axes(draft.plain.map_or(3, |only| only.axes));
        lost_sign::check(&readings, &format!("{sensor_kind} "))?;
        match sensor_kind {
            SensorKind::Accelerometer if is_plain => check_size(&readings, *unit)?,
            SensorKind::Accelerometer => check_gravity(&readings, *unit)?,
            SensorKind::Gyroscope => check_rates(&readings, *unit)?,
        }
        recording[sensor_kind] = Some(readings);
        for axis in calibrant_core::sensor::Axis::ALL {
            draft.set_unit(ColumnMeaning::Reading(sensor_kind, axis), ColumnUnit::Reading(*unit));
        }
        maps.push(lines);
    }
    if samples.truncated.is_some() {
        findings.push(Diagnostic::from(LineTruncated {}).at_line(samples.truncated));
    }
    recording.temperature_c = temperature(draft, &times, &kept, samples, &recording, &mut findings);
    examine(&recording, &sensor_kinds, &maps, is_plain || options.rows_are_holds, &mut findings);
    if is_plain {
        findings = findings.into_iter().map(|finding| finding.about(None)).collect();
    }
    Ok(Assembled { recording, findings })
}

/// The remedy for a recording that is too short.
const TWO: &str = "a recording needs two samples at least";

/// The sensors that have columns with values in them.
fn with_values(draft: &mut Draft, samples: &Samples) -> Checked<Vec<SensorKind>> {
    let mut sensor_kinds = Vec::new();
    let mut empty = Vec::new();
    for sensor_kind in SensorKind::ALL {
        let readings = samples.sensor(sensor_kind);
        if readings.is_empty() {
            continue;
        }
        if (0..3).any(|axis| readings.iter().all(|reading| reading[axis].is_nan())) {
            empty.push(sensor_kind.name());
            for axis in calibrant_core::sensor::Axis::ALL {
                draft.leave_aside(ColumnMeaning::Reading(sensor_kind, axis), "an axis has no values");
            }
        } else {
            sensor_kinds.push(sensor_kind);
        }
    }
    if sensor_kinds.is_empty() {
        let message = format!("the columns of the {} are empty", empty.join(" and the "));
        return refuse(Refusal::SensorMissing, message, "were they recorded, and exported?");
    }
    Ok(sensor_kinds)
}

/// What there is to say of units that are not those of the file.
fn overruled(draft: &Draft, sensor_kinds: &[SensorKind], units: &[Option<ImuUnit>]) -> Vec<Diagnostic> {
    let stated = |kind| draft.column(ColumnMeaning::Reading(kind, calibrant_core::sensor::Axis::X))?.unit;
    let of = |(&sensor_kind, unit): (&SensorKind, &Option<ImuUnit>)| match (stated(sensor_kind), unit) {
        (Some(ColumnUnit::Reading(ImuUnit::Counts)), Some(ImuUnit::CountsOf(_))) => None,
        (Some(ColumnUnit::Reading(stated)), Some(given)) if stated != *given => {
            let (stated, given) = (stated.symbol(), given.symbol());
            Some(UnitOverruled { sensor_kind, stated, given }.into())
        }
        _ => None,
    };
    sensor_kinds.iter().zip(units).filter_map(of).collect()
}

/// One error with all questions.
fn ask(
    clock: Option<InputError>,
    samples: &Samples,
    sensor_kinds: &[SensorKind],
    units: &[Option<ImuUnit>],
) -> InputError {
    let (mut questions, mut answers, mut more) = (Vec::new(), Vec::new(), String::new());
    for (&sensor_kind, _) in sensor_kinds.iter().zip(units).filter(|(_, unit)| unit.is_none()) {
        let raw = raw(sensor_kind, samples);
        let question = question(sensor_kind, &raw);
        let sensitivity = match (question.ends_with(COUNTS_HINT), sensor_kind) {
            (false, _) => "",
            (true, SensorKind::Accelerometer) => {
                "; counts of a sensitivity, as 16384 LSB/g, are read in m/s²"
            }
            (true, SensorKind::Gyroscope) => "; counts of a sensitivity, as 131 LSB/dps, are read in rad/s",
        };
        questions.push(question);
        let units = ImuUnit::ALL.into_iter().filter(|unit| unit.suits(sensor_kind)).map(ImuUnit::symbol);
        let answer = Answer::new(unit_option(sensor_kind), units);
        answers.push(answer.and(format!(" ({sensor_kind}_unit in [columns]{sensitivity})")));
    }
    if let Some(clock) = clock {
        questions.push(clock.message);
        if clock.answers.is_empty() {
            more = format!("; {}", clock.help);
        }
        answers.extend(clock.answers);
    }
    let question = InputError::question(Refusal::UnitUnknown, questions.join("; "), answers);
    InputError { help: question.help.clone() + &more, ..question }
}

/// The readings of a sensor in the unit of the file.
fn raw(sensor_kind: SensorKind, samples: &Samples) -> Vec<Vector3<f64>> {
    let is_whole = |reading: &&Vector3<f64>| reading.iter().all(|value| value.is_finite());
    samples.sensor(sensor_kind).iter().filter(is_whole).copied().collect()
}

/// The rows of a file that are kept.
struct Kept {
    rows: usize,
    /// The dropped rows, in order.
    dropped: Vec<usize>,
}

impl Kept {
    fn len(&self) -> usize {
        self.rows - self.dropped.len()
    }

    fn rows(&self) -> impl Iterator<Item = usize> + '_ {
        let mut dropped = self.dropped.iter().peekable();
        (0..self.rows).filter(move |row| dropped.next_if_eq(&row).is_none())
    }
}

/// The rows in which the times of a sensor increase. Where sensors have rows of their own, each has its
/// times. Rows that repeat the time before are dropped; a time that goes back is an error.
fn increasing(
    times: &[f64],
    sensor_kinds: &[SensorKind],
    samples: &Samples,
    findings: &mut Vec<Diagnostic>,
) -> Checked<Kept> {
    let mut kept = Kept { rows: times.len(), dropped: Vec::new() };
    let mut last: [Option<usize>; 2] = [None; 2];
    let (mut untimed, mut same_rows, mut same_times) = (Tally::default(), Tally::default(), Tally::default());
    for (row, &t) in times.iter().enumerate() {
        if t.is_nan() {
            untimed.add(samples.lines.line(row));
            kept.dropped.push(row);
            continue;
        }
        let (mut is_new, mut repeated) = (false, None);
        for (before, &sensor_kind) in last.iter_mut().zip(sensor_kinds) {
            match *before {
                _ if samples.sensor(sensor_kind)[row].iter().any(|value| value.is_nan()) => (),
                Some(other) if t < times[other] => {
                    let holds = |row: &usize| !times[*row].is_nan() && samples.holds(sensor_kind, *row);
                    let of_sensor = (0..times.len()).filter(holds).map(|row| times[row]);
                    return Err(samples.lines.at(backwards((times[other], t), of_sensor), row).into());
                }
                Some(other) if t == times[other] => repeated = Some(other),
                _ => (*before, is_new) = (Some(row), true),
            }
        }
        if let Some(other) = repeated.filter(|_| !is_new) {
            if samples.repeats(row, other) { &mut same_rows } else { &mut same_times }
                .add(samples.lines.line(row));
            kept.dropped.push(row);
        }
    }
    untimed.report(findings, None, |count| ValuesMissing { missing: MissingValue::Time, count });
    same_rows.report(findings, None, |rows| RowsRepeated { rows });
    same_times.report(findings, None, |count| TimesRepeated { count, is_of_one_sensor: false });
    Ok(kept)
}

/// The readings of a sensor, in its unit after the conversion; samples that lack a value are dropped.
fn readings(
    sensor_kind: SensorKind,
    unit: ImuUnit,
    times: &[f64],
    kept: &Kept,
    samples: &mut Samples,
    findings: &mut Vec<Diagnostic>,
) -> Checked<(Recording, LineMap)> {
    let (unit, factor) = unit.reading();
    let mut readings = samples.take_sensor(sensor_kind);
    let mut times_s = Vec::with_capacity(kept.len());
    let mut lines = LineMap::default();
    let (mut absent, mut missing, mut same_times) = (Tally::default(), Tally::default(), Tally::default());
    for row in kept.rows() {
        let reading = readings[row];
        if reading.x.is_nan() || reading.y.is_nan() || reading.z.is_nan() {
            let is_absent = reading.iter().all(|value| value.is_nan());
            if is_absent { &mut absent } else { &mut missing }.add(samples.lines.line(row));
            continue;
        }
        if times_s.last() == Some(&times[row]) {
            same_times.add(samples.lines.line(row)); // the row is kept for the other sensor
            continue;
        }
        if let Some(line) = samples.lines.line(row) {
            lines.push(times_s.len(), line);
        }
        readings[times_s.len()] = reading * factor;
        times_s.push(times[row]);
    }
    readings.truncate(times_s.len());
    let recording = Recording::new(times_s, readings, 3, unit).map_err(|error| match error {
        Error::Recording(input_error) => input_error,
        other => InputError::new(Refusal::FileDamaged, other.to_string(), "write the file again").into(),
    })?;
    let about = Some(sensor_kind);
    absent.report(findings, about, |count| ValuesMissing { missing: MissingValue::Reading, count });
    missing.report(findings, about, |count| ValuesMissing { missing: MissingValue::Part, count });
    same_times.report(findings, about, |count| TimesRepeated { count, is_of_one_sensor: true });
    if recording.len() < 2 {
        let message = format!(
            "only {} of the {sensor_kind} in {}",
            counted(recording.len(), "usable sample"),
            counted(samples.rows, "row")
        );
        let mut help = vec![TWO.to_owned()];
        let of_clock = [ClockSource::CODE, TimesFromFirst::CODE];
        let dropped = findings.iter().filter(|finding| !of_clock.contains(&finding.code()));
        help.extend(dropped.map(ToString::to_string));
        let input_error = InputError::new(Refusal::RecordingShort, message, help.join("; "));
        return Err(samples.last_line.map_or(input_error.clone(), |line| input_error.at_line(line)).into());
    }
    Ok((recording, lines))
}

/// Temperatures at the sample times of the first sensor: straight lines between the rows that have one.
fn temperature(
    draft: &mut Draft,
    times: &[f64],
    kept: &Kept,
    samples: &Samples,
    recording: &ImuRecording,
    findings: &mut Vec<Diagnostic>,
) -> Option<Vec<f64>> {
    let values = &samples.temperatures;
    if values.is_empty() {
        return None;
    }
    let mut known: Vec<(f64, f64)> =
        kept.rows().filter(|&row| values[row].is_finite()).map(|row| (times[row], values[row])).collect();
    // sensors with rows of their own have times of their own
    known.sort_by(|one, other| one.0.total_cmp(&other.0));
    if known.is_empty() {
        draft.leave_aside(ColumnMeaning::Temperature, "it has no values");
        return None;
    }
    let at = &recording[SensorKind::Accelerometer]
        .as_ref()
        .or(recording[SensorKind::Gyroscope].as_ref())?
        .times_s();
    let missing = kept.len() - known.len();
    if missing > 0 {
        let all = || kept.rows().map(|row| times[row]);
        let ends = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
        let known_at = known.iter().map(|(t, _)| *t);
        let with_ends: Vec<f64> = once(ends.0).chain(known_at).chain(once(ends.1)).collect();
        let longest_s = with_ends.windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max);
        let rows = kept.len();
        findings.push(match longest_s <= LONG_WITHOUT_TEMPERATURE_S {
            true => TemperatureGaps { missing, rows, longest_s }.into(),
            false => {
                TemperatureDoubtful { doubt: TemperatureDoubt::Missing { missing, rows, longest_s } }.into()
            }
        });
    }
    if let Some((_, value)) = known.iter().find(|(_, value)| !WORKING_C.contains(value)) {
        findings.push(TemperatureDoubtful { doubt: TemperatureDoubt::Implausible(*value) }.into());
    }
    let (times_s, values_c): (Vec<f64>, Vec<f64>) = known.into_iter().unzip();
    at.iter().enumerate().map(|(k, &t)| interpolated(&times_s, |known| values_c[known], t, k)).collect()
}

/// Looks for gaps, irregular sampling, axes that are not connected, clipped readings.
fn examine(
    recording: &ImuRecording,
    sensor_kinds: &[SensorKind],
    lines: &[LineMap],
    has_no_clock: bool,
    findings: &mut Vec<Diagnostic>,
) {
    let sensors: Vec<_> = sensor_kinds
        .iter()
        .filter_map(|&sensor_kind| Some((sensor_kind, recording.sensor(sensor_kind)?)))
        .zip(lines)
        .collect();
    let shared = sensors.windows(2).all(|pair| pair[0].0.1.times_s() == pair[1].0.1.times_s());
    for (k, ((sensor_kind, sensor), lines)) in sensors.iter().enumerate() {
        if k == 0 || !shared {
            let rate = sensor.rate_hz();
            if k == 0 && !has_no_clock {
                recording_quality::clock(rate, findings);
            }
            let from = findings.len();
            recording_quality::sampling(sensor.times_s(), rate, lines, findings);
            if !shared {
                let of_sensor = findings.split_off(from);
                findings.extend(of_sensor.into_iter().map(|finding| finding.about(Some(*sensor_kind))));
            }
        }
        recording_quality::readings(sensor, Some(*sensor_kind), lines, findings);
    }
}
