//! Recordings of a whole IMU, in the formats of many programs.
//!
//! | format | recognised by | times | units |
//! |---|---|---|---|
//! | MT Manager | comments `// Update Rate`, `// DeviceId`, … above `PacketCounter…` | `SampleTimeFine` 0.1 ms, or `PacketCounter` and the rate | m/s², rad/s |
//! | Movella DOT | `sep=`, `DeviceTag:`, … above `PacketCounter…` | `SampleTimeFine` µs | m/s², deg/s |
//! | EuRoC | `#timestamp [ns],…` | ns | m/s², rad/s |
//! | imu_tk | four columns of numbers, `t x y z`; two files | s | asked for |
//! | imucal | `n_samples,gyr_x,…` | counter; the rate is asked for | asked for |
//! | MCAP, Parquet | their first bytes | `header.stamp`; by name or type | m/s², rad/s; by name, or asked for |
//! | CSV | none of these | by name, or `[columns]` | by name, or asked for |
//!
//! All of them go the same way: [`head`] finds the header, a format's own file says what its columns mean ([`draft`]), [`samples`] reads the rows,
//! [`clock`] makes times and [`readings`] units of them, [`assemble`] puts the recording together. A unit that the file does not state is
//! asked for, with what its values suggest; it is never guessed.

mod accelerometer;
mod assemble;
#[cfg(feature = "mcap")]
mod cdr;
mod clock;
mod column;
mod csv;
mod draft;
mod euroc;
mod format;
mod head;
mod imu_tk;
mod imucal;
#[cfg(feature = "mcap")]
mod mcap;
#[cfg(feature = "mcap")]
mod mcap_end;
mod mcap_records;
mod movella_dot;
mod mt_manager;
mod naming;
mod options;
#[cfg(feature = "parquet")]
mod parquet;
mod parquet_pages;
mod readings;
mod samples;
mod source;
mod unit;
mod xsens;
#[cfg(feature = "mcap")]
mod zstd;

pub use accelerometer::read_accelerometer;
pub use column::{ColumnMeaning, ImuColumn};
pub use format::FileFormat;
pub use options::{ColumnMapping, ImuReadOptions};
pub use unit::{ColumnUnit, ImuUnit, TimeUnit};

use super::finding::{Finding, FindingKind, moment, short};
use super::hex_sha256;
use super::row::Layout;
use crate::error::{Complaint, Error, Result};
use crate::io::text::Checked;
use crate::sensor::{ImuRecording, Recording, Triad};
use assemble::assemble;
use draft::Draft;
use head::Head;
use samples::Samples;
use source::Source;
use std::path::Path;

/// A recording of an IMU as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct ImuFile {
    /// The samples: times in s, strictly increasing, everything finite; SI or counts.
    pub recording: ImuRecording,
    /// The format, as recognised or given.
    pub format: FileFormat,
    /// The columns in their order, used or not; of both files for a pair.
    pub columns: Vec<ImuColumn>,
    /// What was noticed and repaired.
    pub findings: Vec<Finding>,
    /// Number of rows, dropped ones included; of the longer file for a pair.
    pub rows: usize,
    /// SHA-256 of the bytes of each file, hexadecimal.
    pub sha256: Vec<String>,
}

/// Reads a recording of an IMU in any known format.
///
/// # Errors
/// [`Error::Recording`] with file, line and column: a file that cannot be read; no column of a sensor, or one from which gravity was removed, or
/// only orientation; an axis that is missing or there twice; a unit or the sample rate that the file does not state (the message asks for it and says
/// what the values suggest) or that contradicts the options; a row with the wrong number of columns, or something that is not a number; a time
/// that goes backwards; fewer than two samples.
pub fn read_imu_recording(path: &Path, options: &ImuReadOptions) -> Result<ImuFile> {
    read(path, options, None)
}

/// Reads a recording that holds this sensor: as [`read_imu_recording`] does, with the other sensor where the file has it, or a text of this sensor alone whose columns do
/// not say which it is: `t x y z` of imu_tk, `t_s,x,y,z`, or `t_s,ax,ay,az` of a gyroscope.
///
/// # Errors
/// As [`read_imu_recording`]. That the file has the other sensor only is none.
pub fn read_imu_sensor(path: &Path, triad: Triad, options: &ImuReadOptions) -> Result<ImuFile> {
    read(path, options, Some(triad))
}

fn read(path: &Path, options: &ImuReadOptions, asked: Option<Triad>) -> Result<ImuFile> {
    let in_file = |complaint: Box<Complaint>| Error::recording(complaint.in_file(path));
    let beginning = source::beginning(path).map_err(in_file)?;
    if FileFormat::of_magic(&beginning.bytes).is_some() {
        return parse(&beginning.bytes, options).map_err(in_file);
    }
    source::of_file(beginning, |source| parse_text(source, options, asked)).map_err(in_file)
}

/// Reads the bytes of a recording of an IMU.
///
/// # Errors
/// As [`read_imu_recording`], without the name of the file.
///
/// # Examples
/// ```
/// use calibrant::io::{FileFormat, ImuReadOptions, parse_imu_recording};
///
/// let text = "// Update Rate: 100.0Hz\nPacketCounter\tAcc_X\tAcc_Y\tAcc_Z\tGyr_X\tGyr_Y\tGyr_Z\n\
///             65534\t0.1\t0.2\t9.81\t0.0\t0.1\t0.0\n65535\t0.2\t0.1\t9.80\t0.1\t0.0\t0.1\n00001\t0.1\t0.1\t9.82\t0.0\t0.0\t0.0\n";
/// let file = parse_imu_recording(text.as_bytes(), &ImuReadOptions::default())?;
/// assert_eq!(file.format, FileFormat::MtManager);
/// let gyroscope = file.recording.gyroscope.expect("there");
/// assert_eq!(gyroscope.times_s, [0.0, 0.01, 0.03], "the counter began anew, and one sample was lost");
/// # Ok::<(), calibrant::Error>(())
/// ```
pub fn parse_imu_recording(bytes: &[u8], options: &ImuReadOptions) -> Result<ImuFile> {
    parse(bytes, options).map_err(|complaint| Error::recording(*complaint))
}

/// Reads a recording whose accelerometer and gyroscope are in a file each, as imu_tk's are: `t x y z`.
///
/// A file with a header serves as well: `t_s,x,y,z`, or any that has the sensor's columns by name. The sensors share a clock; their sample times may differ.
///
/// # Errors
/// As [`read_imu_recording`], for each file.
pub fn read_imu_pair(accelerometer: &Path, gyroscope: &Path, options: &ImuReadOptions) -> Result<ImuFile> {
    let one = |path: &Path, triad: Triad| {
        let in_file = |complaint: Box<Complaint>| Error::recording(complaint.in_file(path));
        let beginning = source::beginning(path).map_err(in_file)?;
        source::of_file(beginning, |source| parse_one(source, options, triad)).map_err(in_file)
    };
    // one beside the other: this is what a calibration waits for
    let (accelerometer, gyroscope) =
        rayon::join(|| one(accelerometer, Triad::Accelerometer), || one(gyroscope, Triad::Gyroscope));
    Ok(joined(accelerometer?, gyroscope?))
}

/// Reads the bytes of a pair of files, accelerometer and gyroscope.
///
/// # Errors
/// As [`read_imu_pair`], without the names of the files.
///
/// # Examples
/// ```
/// use calibrant::io::{ImuReadOptions, ImuUnit, parse_imu_pair};
/// let options = ImuReadOptions {
///     accelerometer_unit: Some(ImuUnit::Counts),
///     gyroscope_unit: Some(ImuUnit::Counts),
///     ..ImuReadOptions::default()
/// };
/// let file = parse_imu_pair(b"0.00 33108 33329 36429\n0.01 33096 33336 36437\n", b"0.00 32786 32429 32499\n0.01 32797 32410 32531\n", &options)?;
/// assert_eq!(file.recording.gyroscope.expect("there").readings[1].y, 32410.0);
/// # Ok::<(), calibrant::Error>(())
/// ```
pub fn parse_imu_pair(accelerometer: &[u8], gyroscope: &[u8], options: &ImuReadOptions) -> Result<ImuFile> {
    let one = |bytes: &[u8], triad: Triad| {
        source::of_bytes(bytes, |source| parse_one(source, options, triad)).map_err(|complaint| {
            let message = format!("{triad}: {}", complaint.message);
            Error::recording(Complaint { message, ..*complaint })
        })
    };
    Ok(joined(one(accelerometer, Triad::Accelerometer)?, one(gyroscope, Triad::Gyroscope)?))
}

fn parse(bytes: &[u8], options: &ImuReadOptions) -> Checked<ImuFile> {
    if let Some(format) = FileFormat::of_magic(bytes) {
        if let Some(given) = options.format.filter(|given| *given != format) {
            let message =
                format!("the format was given as {}, but this is {}", given.name(), format.description());
            return Err(Complaint::new(message, LEAVE_AWAY).into());
        }
        let (file, sha256) = rayon::join(|| binary(format, bytes, options), || hex_sha256(bytes));
        return Ok(ImuFile { sha256: vec![sha256], ..file? });
    }
    source::of_bytes(bytes, |source| parse_text(source, options, None))
}

/// Reads a text; `asked` is the sensor that the user says is in it.
fn parse_text(source: Source<'_>, options: &ImuReadOptions, asked: Option<Triad>) -> Checked<ImuFile> {
    let head = Head::find(source.text)?;
    let format = match options.format {
        Some(format) => format,
        None => sniffed(&head, options)?,
    };
    let draft = match format {
        FileFormat::MtManager => mt_manager::draft(&head),
        FileFormat::MovellaDot => movella_dot::draft(&head),
        FileFormat::Euroc => euroc::draft(&head),
        FileFormat::Imucal => imucal::draft(&head)?,
        FileFormat::ImuTk => imu_tk::draft(&head, asked)?,
        FileFormat::Csv => csv::draft(&head, asked),
        FileFormat::Mcap | FileFormat::Parquet => return Err(not_binary(format).into()),
    };
    rows(draft, head, source, options)
}

#[cfg(feature = "mcap")]
fn read_mcap(bytes: &[u8], options: &ImuReadOptions) -> Checked<ImuFile> {
    if !options.columns.is_empty() {
        return Err(Complaint::new(
            "[columns] names columns, but the messages of a bag say what they hold",
            "take time, accelerometer, gyroscope and temperature out of [columns]; topic may stay",
        )
        .into());
    }
    let (mut draft, samples, cut) = mcap::read(bytes, options)?;
    draft.slots()?;
    let mut file = finish(draft, samples, options).map_err(|mut complaint| {
        if let Some(cut) = &cut {
            complaint.help = format!("{}; {cut}", complaint.help);
        }
        complaint
    })?;
    file.findings.extend(cut);
    Ok(file)
}

#[cfg(feature = "parquet")]
fn read_parquet(bytes: &[u8], options: &ImuReadOptions) -> Checked<ImuFile> {
    let mut file = parquet::open(bytes)?;
    file.draft.map(options)?;
    file.draft.set_time_unit(options)?;
    let slots = file.draft.slots()?;
    let samples = parquet::samples(&file, &slots)?;
    finish(file.draft, samples, options)
}

#[cfg(not(feature = "mcap"))]
fn read_mcap(_: &[u8], _: &ImuReadOptions) -> Checked<ImuFile> {
    Err(without("mcap"))
}

#[cfg(not(feature = "parquet"))]
fn read_parquet(_: &[u8], _: &ImuReadOptions) -> Checked<ImuFile> {
    Err(without("parquet"))
}

#[cfg(not(all(feature = "mcap", feature = "parquet")))]
fn without(feature: &str) -> Box<Complaint> {
    let message = format!("this build of calibrant does not read {feature} files");
    Complaint::new(message, format!("build it with the feature `{feature}`")).into()
}

fn binary(format: FileFormat, bytes: &[u8], options: &ImuReadOptions) -> Checked<ImuFile> {
    if format == FileFormat::Mcap { read_mcap(bytes, options) } else { read_parquet(bytes, options) }
}

/// The format of a text. With the columns named, four of them need not be imu_tk's.
fn sniffed(head: &Head<'_>, options: &ImuReadOptions) -> Checked<FileFormat> {
    match FileFormat::of_text(head) {
        Ok(FileFormat::ImuTk) | Err(_) if !options.columns.is_empty() => Ok(FileFormat::Csv),
        format => format,
    }
}

/// One file of a pair.
fn parse_one(source: Source<'_>, options: &ImuReadOptions, triad: Triad) -> Checked<ImuFile> {
    let head = Head::find(source.text)?;
    let mut draft = if head.names.is_empty() {
        imu_tk::draft(&head, Some(triad))?
    } else {
        Draft::new(FileFormat::Csv, imu_tk::named(&head, triad))
    };
    draft.keep_only(triad);
    // the other sensor's unit, or the columns of one file that holds both, are not meant
    let options = ImuReadOptions { columns: ColumnMapping::default(), ..options.clone() };
    rows(draft, head, source, &options)
}

/// Reads the rows of a text whose columns are known.
fn rows(mut draft: Draft, head: Head<'_>, source: Source<'_>, options: &ImuReadOptions) -> Checked<ImuFile> {
    let line = head.line();
    let at_header = |complaint: Box<Complaint>| Box::new(complaint.at_line(line));
    draft.map(options).map_err(at_header)?;
    draft.set_time_unit(options).map_err(at_header)?;
    let slots = draft.slots().map_err(at_header)?;
    let layout = Layout {
        delimiter: head.delimiter,
        slots,
        names: head.names.iter().map(|name| (*name).to_owned()).collect(),
        has_header: !head.names.is_empty(),
        ticks: draft.time_unit() != Some(TimeUnit::Second),
    };
    let mut samples = source.samples(&layout, head)?;
    samples.last_line = samples.last_line.or(Some(line));
    finish(draft, samples, options)
}

/// From the values of a file to its recording.
fn finish(mut draft: Draft, mut samples: Samples, options: &ImuReadOptions) -> Checked<ImuFile> {
    let assembled = assemble(&mut draft, &mut samples, options)?;
    Ok(ImuFile {
        recording: assembled.recording,
        format: draft.format,
        columns: draft.columns,
        findings: assembled.findings,
        rows: samples.rows,
        sha256: Vec::new(),
    })
}

/// The other sensor's columns of a file that was given for one sensor.
fn left_aside(file: &ImuFile, triad: Triad) -> Option<Finding> {
    let is_other =
        |column: &&ImuColumn| matches!(column.meaning, ColumnMeaning::Reading(of, _) if of != triad);
    let names: Vec<&str> = file.columns.iter().filter(is_other).map(|column| column.name.as_str()).collect();
    let other = match triad {
        Triad::Accelerometer => Triad::Gyroscope,
        Triad::Gyroscope => Triad::Accelerometer,
    };
    (!names.is_empty()).then(|| {
        let message = format!(
            "its own columns of the {other}, {}, are left aside: the {other} is that of the other file",
            names.join(", ")
        );
        Finding::new(FindingKind::IgnoredColumns, None, message)
    })
}

/// Says where one of a pair of files covers much less of the time than the other.
fn shorter_than_other(first: &ImuRecording, second: &ImuRecording) -> Option<Finding> {
    let span = |recording: &Recording| Some((*recording.times_s.first()?, *recording.times_s.last()?));
    let (accelerometer, gyroscope) =
        (span(first.accelerometer.as_ref()?)?, span(second.gyroscope.as_ref()?)?);
    let common = accelerometer.1.min(gyroscope.1) - accelerometer.0.max(gyroscope.0);
    let lengths = [accelerometer, gyroscope].map(|(start, end)| end - start);
    let is_gyroscope = lengths[1] < lengths[0];
    let (shorter, longer) = if is_gyroscope {
        (Triad::Gyroscope, Triad::Accelerometer)
    } else {
        (Triad::Accelerometer, Triad::Gyroscope)
    };
    let of = |triad: Triad| if triad == Triad::Gyroscope { gyroscope } else { accelerometer };
    if common >= COVERED * lengths[0].max(lengths[1]) {
        return None;
    }
    let words = |(start, end): (f64, f64)| format!("from {} to {} s", moment(start), moment(end));
    let message = format!(
        "{shorter}: it was recorded {}, the {longer} {}: {} s of both",
        words(of(shorter)),
        words(of(longer)),
        short(common.max(0.0))
    );
    Some(Finding {
        in_second_file: is_gyroscope,
        ..Finding::new(FindingKind::ShorterThanOther, None, message)
    })
}

/// Two files as one recording.
fn joined(first: ImuFile, second: ImuFile) -> ImuFile {
    let named = |triad: Triad, file: &ImuFile| -> Vec<Finding> {
        let named = |mut finding: Finding| {
            if !finding.message.starts_with(triad.name()) {
                finding.message = format!("{triad}: {}", finding.message);
            }
            finding
        };
        file.findings.iter().cloned().chain(left_aside(file, triad)).map(named).collect()
    };
    let of_second = named(Triad::Gyroscope, &second).into_iter();
    let mut findings = named(Triad::Accelerometer, &first);
    findings.extend(of_second.map(|finding| Finding { in_second_file: true, ..finding }));
    findings.extend(shorter_than_other(&first.recording, &second.recording));
    ImuFile {
        recording: ImuRecording {
            accelerometer: first.recording.accelerometer,
            gyroscope: second.recording.gyroscope,
            temperature_c: first.recording.temperature_c,
        },
        format: first.format,
        columns: first.columns.into_iter().chain(second.columns).collect(),
        findings,
        rows: first.rows.max(second.rows),
        sha256: [first.sha256, second.sha256].concat(),
    }
}

/// What both files of a pair have in common of the longer one's time, where nothing is to be said of it.
const COVERED: f64 = 0.9;

const LEAVE_AWAY: &str = "leave --format away: the format is recognised by the content";

fn not_binary(format: FileFormat) -> Complaint {
    Complaint::new(format!("the format was given as {}, but this is text", format.name()), LEAVE_AWAY)
}
