//! Reads a recording whose sensors have a file each, and joins them.

use super::column::{ColumnMeaning, ImuColumn};
use super::file_layout::Draft;
use super::read::{beginning, rows, with_checksum};
use super::{ColumnMapping, FileFormat, ImuFile, ImuReadOptions, SecondFile, csv, imu_tk};
use crate::recording::text_header::Head;
use crate::recording::text_source::{self, Source};
use crate::text::decoding::Checked;
use calibrant_core::diagnostic::reader::{
    ColumnsIgnored, FileShorter, FileTimes, FilesApart, Span, TimesFromFirst,
};
use calibrant_core::diagnostic::{Check, Diagnostic};
use calibrant_core::error::{Error, InputError, Result};
use calibrant_core::sensor::{ImuRecording, Recording, SensorKind};
use std::path::Path;

/// Share of the longer file's time that both must cover. Below it there is a finding.
const COVERED: f64 = 0.9;

/// Reads a recording whose accelerometer and gyroscope are in a file each, as imu_tk's are: `t x y z`.
///
/// A file with a header serves as well: `t_s,x,y,z`, or any that names the sensor's columns. The sensors
/// share a clock; their sample times may differ.
///
/// # Errors
/// As [`read_imu_recording`](crate::read_imu_recording), for each file.
pub fn read_imu_pair(accelerometer: &Path, gyroscope: &Path, options: &ImuReadOptions) -> Result<ImuFile> {
    let one = |path: &Path, sensor_kind: SensorKind| {
        let in_file = |input_error: Box<InputError>| Error::recording(input_error.in_file(path));
        let beginning = beginning(path).map_err(in_file)?;
        text_source::of_file(beginning, |source| parse_one(source, options, sensor_kind))
            .map(with_checksum)
            .map_err(in_file)
    };
    // in parallel: a calibration waits for this
    let (accelerometer, gyroscope) = rayon::join(
        || one(accelerometer, SensorKind::Accelerometer),
        || one(gyroscope, SensorKind::Gyroscope),
    );
    both(accelerometer, gyroscope)
}

/// Reads the bytes of a pair of files, accelerometer and gyroscope.
///
/// # Errors
/// As [`read_imu_pair`], without the names of the files.
///
/// # Examples
/// ```
/// use calibrant_core::sensor::SensorKind;
/// use calibrant_recording::{ImuReadOptions, ImuUnit, parse_imu_pair};
/// let options = ImuReadOptions {
///     accelerometer_unit: Some(ImuUnit::Counts),
///     gyroscope_unit: Some(ImuUnit::Counts),
///     ..ImuReadOptions::default()
/// };
/// let file = parse_imu_pair(b"0.00 33108 33329 36429\n0.01 33096 33336 36437\n", b"0.00 32786 32429 32499\n0.01 32797 32410 32531\n", &options)?;
/// assert_eq!(file.recording.sensor(SensorKind::Gyroscope).expect("there").readings()[1].y, 32410.0);
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn parse_imu_pair(accelerometer: &[u8], gyroscope: &[u8], options: &ImuReadOptions) -> Result<ImuFile> {
    let one = |bytes: &[u8], sensor_kind: SensorKind| {
        text_source::of_bytes(bytes, |source| parse_one(source, options, sensor_kind))
            .map(with_checksum)
            .map_err(|input_error| {
                let message = format!("{sensor_kind}: {}", input_error.message);
                Error::recording(InputError { message, ..*input_error })
            })
    };
    both(one(accelerometer, SensorKind::Accelerometer), one(gyroscope, SensorKind::Gyroscope))
}

/// The pair. Where both files leave a question open, the error has both questions.
fn both(accelerometer: Result<ImuFile>, gyroscope: Result<ImuFile>) -> Result<ImuFile> {
    match (accelerometer, gyroscope) {
        (Err(Error::Recording(one)), Err(Error::Recording(other)))
            if !one.answers.is_empty() && !other.answers.is_empty() =>
        {
            let mut answers = one.answers.clone();
            answers.extend(other.answers.iter().filter(|answer| !one.answers.contains(answer)).cloned());
            let second = InputError { help: String::new(), ..*other };
            let message = format!("{}; {second}", one.message);
            let both = InputError::question(one.code, message, answers);
            Err(Error::recording(InputError { file: one.file, line: one.line, ..both }))
        }
        (accelerometer, gyroscope) => Ok(joined(accelerometer?, gyroscope?)),
    }
}

/// One file of a pair.
fn parse_one(source: Source<'_>, options: &ImuReadOptions, sensor_kind: SensorKind) -> Checked<ImuFile> {
    let head = Head::find(source.text)?;
    // of [columns], what this file has
    let own = {
        let has = |name: &String| match head.names.is_empty() {
            true => name.parse().is_ok_and(|number: usize| (1..=head.fields()).contains(&number)),
            false => head.names.contains(&name.as_str()),
        };
        let sensor = |kind: SensorKind| {
            let names =
                options.columns.sensor(kind).filter(|names| kind == sensor_kind && names.iter().all(has));
            names.cloned()
        };
        let column = |name: &Option<String>| name.clone().filter(has);
        ColumnMapping {
            time: column(&options.columns.time),
            rest_of_second: column(&options.columns.rest_of_second),
            accelerometer: sensor(SensorKind::Accelerometer),
            gyroscope: sensor(SensorKind::Gyroscope),
            temperature: column(&options.columns.temperature),
        }
    };
    let mut draft = match head.names.is_empty() {
        true if own.sensor(sensor_kind).is_some() => csv::draft(&head, Some(sensor_kind)),
        true => imu_tk::draft(&head, Some(sensor_kind), options)?,
        false => Draft::new(FileFormat::Csv, imu_tk::named(&head, sensor_kind)),
    };
    draft.keep_only(sensor_kind);
    let options = ImuReadOptions { columns: own, ..options.clone() };
    rows(draft, head, source, &options)
}

/// The other sensor's columns of a file that was given for one sensor.
fn left_aside(file: &ImuFile, sensor_kind: SensorKind) -> Option<Diagnostic> {
    let of_other = |column: &ImuColumn| match column.meaning {
        ColumnMeaning::Reading(of, _) if of != sensor_kind => Some((of, column.name.clone())),
        _ => None,
    };
    let (others, columns): (Vec<SensorKind>, _) = file.columns.iter().filter_map(of_other).unzip();
    let other = others.first().copied();
    other.map(|_| ColumnsIgnored { columns, other }.into())
}

/// The finding where one of a pair of files covers much less of the time than the other, or nothing of it; and the sensor of that file.
fn shorter_than_other(first: &ImuRecording, second: &ImuRecording) -> Option<(SensorKind, Diagnostic)> {
    let span = |recording: &Recording| {
        Some(Span { start_s: *recording.times_s().first()?, end_s: *recording.times_s().last()? })
    };
    let (accelerometer, gyroscope) =
        (span(first[SensorKind::Accelerometer].as_ref()?)?, span(second[SensorKind::Gyroscope].as_ref()?)?);
    let common_s = accelerometer.end_s.min(gyroscope.end_s) - accelerometer.start_s.max(gyroscope.start_s);
    let lengths = [accelerometer, gyroscope].map(|span| span.end_s - span.start_s);
    let both = [(SensorKind::Accelerometer, accelerometer), (SensorKind::Gyroscope, gyroscope)];
    let [(shorter, shorter_s), (longer, longer_s)] = match lengths[1] < lengths[0] {
        true => [both[1], both[0]],
        false => both,
    };
    if common_s >= COVERED * lengths[0].max(lengths[1]) {
        return None;
    }
    let files = FileTimes { shorter, shorter_s, longer, longer_s, common_s };
    let found: Diagnostic = match common_s > 0.0 {
        true => FileShorter { files }.into(),
        false => FilesApart { files }.into(),
    };
    Some((shorter, found.about(Some(shorter))))
}

/// Two files as one recording.
pub(super) fn joined(first: ImuFile, mut second: ImuFile) -> ImuFile {
    on_one_clock(&first, &mut second);
    let shorter = shorter_than_other(&first.recording, &second.recording);
    let named = |sensor_kind: SensorKind, file: &ImuFile| -> Vec<Diagnostic> {
        let found = file.findings.iter().cloned().chain(left_aside(file, sensor_kind));
        let shorter = shorter.iter().filter(|(of, _)| *of == sensor_kind).map(|(_, found)| found.clone());
        found.map(|finding| finding.about(Some(sensor_kind))).chain(shorter).collect()
    };
    let findings = named(SensorKind::Accelerometer, &first);
    let of_gyroscope = SecondFile {
        format: second.format,
        rows: second.rows,
        columns: second.columns.len(),
        findings: named(SensorKind::Gyroscope, &second),
    };
    ImuFile {
        recording: first
            .recording
            .with(SensorKind::Gyroscope, second.recording[SensorKind::Gyroscope].take()),
        columns: first.columns.into_iter().chain(second.columns).collect(),
        findings,
        sha256: [first.sha256, second.sha256].concat(),
        second: Some(of_gyroscope),
        rate_sd_ppm: first.rate_sd_ppm.into_iter().chain(second.rate_sd_ppm).reduce(f64::max),
        ..first
    }
}

/// Times that count from the first of each file count from that of the accelerometer's.
fn on_one_clock(first: &ImuFile, second: &mut ImuFile) {
    let (Some(of_first), Some(of_second)) = (first.counted_from_ns, second.counted_from_ns) else { return };
    let later_s = of_second.saturating_sub(of_first) as f64 / 1e9;
    let gyroscope = second.recording[SensorKind::Gyroscope].take();
    second.recording[SensorKind::Gyroscope] = gyroscope.map(|gyroscope| gyroscope.later_by(later_s));
    second.findings.retain(|finding| finding.code() != TimesFromFirst::CODE);
}
