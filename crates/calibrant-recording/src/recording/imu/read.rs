//! Reads a recording of an IMU in any format, in this order: the header, the meaning of the columns, the
//! rows, the recording.

use super::accelerometer_only::{only, plain};
#[cfg(feature = "mcap")]
use super::bag;
use super::column_values::{READINGS, SampleReader, Samples};
use super::file::ImuFile;
use super::file_layout::Draft;
use super::first_rows::FirstRows;
use super::format::{FileFormat, LEAVE_AWAY};
use super::options::{ColumnMapping, ImuReadOptions};
#[cfg(feature = "parquet")]
use super::parquet;
use super::recording_assembly::assemble;
use super::{
    autopilot, csv, euroc, headerless_text, imu_tk, imucal, instances, movella_dot, mt_manager, sensor_rows,
};
use crate::files::checksum::hex_sha256;
use crate::recording::chunked_reader::FileBeginning;
use crate::recording::row_parser::Layout;
use crate::recording::text_header::Head;
use crate::recording::text_source::{self, Source};
use crate::recording::time_unit::TimeUnit;
#[cfg(not(all(feature = "mcap", feature = "parquet")))]
use crate::text::decoding::without;
use crate::text::decoding::{Checked, refuse};
use calibrant_core::diagnostic::reader::{RowsSorted, ValuesMissing};
use calibrant_core::diagnostic::{Check, Diagnostic};
use calibrant_core::error::{Error, InputError, Refusal, Result};
use calibrant_core::sensor::SensorKind;
use std::path::Path;

/// Reads a recording of an IMU in any known format.
///
/// # Errors
/// [`Error::Recording`] with file, line and column. The file cannot be read. No column is of a sensor, or
/// only one without gravity, or only orientation. An axis is missing or there twice. The file does not state
/// a unit or the sample rate; the message then shows what the values suggest. Or these contradict the
/// options. A row has the wrong number of columns, or a field that is not a number. A time goes backwards.
/// There are fewer than two samples.
pub fn read_imu_recording(path: &Path, options: &ImuReadOptions) -> Result<ImuFile> {
    read(path, options, None)
}

/// Reads a recording that holds this sensor, as [`read_imu_recording`] does, with the other sensor where the
/// file has it. It also reads a text of this sensor alone whose columns do not name it: `t x y z` of imu_tk,
/// `t_s,x,y,z`, or `t_s,ax,ay,az` of a gyroscope.
///
/// # Errors
/// As [`read_imu_recording`]. A file with only the other sensor is no error here.
pub fn read_imu_sensor(path: &Path, sensor_kind: SensorKind, options: &ImuReadOptions) -> Result<ImuFile> {
    read(path, options, Some(sensor_kind))
}

fn read(path: &Path, options: &ImuReadOptions, asked: Option<SensorKind>) -> Result<ImuFile> {
    let in_file = |input_error: Box<InputError>| Error::recording(input_error.in_file(path));
    let beginning = beginning(path).map_err(in_file)?;
    if FileFormat::of_magic(&beginning.bytes).is_some() {
        return parse(&beginning.bytes, options).map_err(in_file);
    }
    let read = text_source::of_file(beginning, |source| parse_text(source, options, asked));
    read.map(with_checksum).map_err(in_file)
}

/// The beginning of a file; all of it where that is of a binary format.
pub(super) fn beginning(path: &Path) -> Checked<FileBeginning> {
    FileBeginning::read(path, |bytes| FileFormat::of_magic(bytes).is_some())
}

pub(super) fn with_checksum((file, sha256): (ImuFile, String)) -> ImuFile {
    ImuFile { sha256: vec![sha256], ..file }
}

/// Reads the bytes of a recording of an IMU.
///
/// # Errors
/// As [`read_imu_recording`], without the name of the file.
///
/// # Examples
/// ```
/// use calibrant_core::sensor::SensorKind;
/// use calibrant_recording::{FileFormat, ImuReadOptions, parse_imu_recording};
///
/// let text = "// Update Rate: 100.0Hz\nPacketCounter\tAcc_X\tAcc_Y\tAcc_Z\tGyr_X\tGyr_Y\tGyr_Z\n\
///             65534\t0.1\t0.2\t9.81\t0.0\t0.1\t0.0\n65535\t0.2\t0.1\t9.80\t0.1\t0.0\t0.1\n00001\t0.1\t0.1\t9.82\t0.0\t0.0\t0.0\n";
/// let file = parse_imu_recording(text.as_bytes(), &ImuReadOptions::default())?;
/// assert_eq!(file.format, FileFormat::MtManager);
/// let gyroscope = file.recording.sensor(SensorKind::Gyroscope).expect("there");
/// assert_eq!(gyroscope.times_s(), [0.0, 0.01, 0.03], "the counter began anew, and one sample was lost");
/// # Ok::<(), calibrant_core::Error>(())
/// ```
pub fn parse_imu_recording(bytes: &[u8], options: &ImuReadOptions) -> Result<ImuFile> {
    parse(bytes, options).map_err(Error::Recording)
}

pub(super) fn parse(bytes: &[u8], options: &ImuReadOptions) -> Checked<ImuFile> {
    if let Some(format) = FileFormat::of_magic(bytes) {
        if let Some(given) = options.format.filter(|given| *given != format) {
            let message =
                format!("the format was given as {}, but this is {}", given.name(), format.description());
            return refuse(Refusal::FormatContradicted, message, LEAVE_AWAY);
        }
        let (file, sha256) = rayon::join(|| binary(format, bytes, options), || hex_sha256(bytes));
        return Ok(ImuFile { sha256: vec![sha256], ..file? });
    }
    text_source::of_bytes(bytes, |source| parse_text(source, options, None)).map(with_checksum)
}

/// Reads a text; `asked` is the sensor that the user names.
fn parse_text(source: Source<'_>, options: &ImuReadOptions, asked: Option<SensorKind>) -> Checked<ImuFile> {
    let head = Head::find(source.text)?;
    let format = match options.format {
        Some(format) => format,
        None => sniffed(&head, options)?,
    };
    let asked = asked.or(options.accelerometer_only.map(|_| SensorKind::Accelerometer));
    let plain = if options.rows_are_holds { None } else { plain(&head, format, options)? };
    if let Some(draft) = plain {
        return rows(draft, head, source, options);
    }
    let is_unnamed = head.names.is_empty() && options.columns.is_empty();
    let draft = match format {
        FileFormat::MtManager => mt_manager::draft(&head),
        FileFormat::MovellaDot => movella_dot::draft(&head),
        FileFormat::Euroc => euroc::draft(&head),
        FileFormat::Imucal => imucal::draft(&head)?,
        FileFormat::Csv if is_unnamed && options.rows_are_holds && head.fields() == 3 => imu_tk::means(),
        FileFormat::ImuTk | FileFormat::Csv if is_unnamed && options.rows_are_holds => {
            return Err(headerless_text::question(&head).into());
        }
        FileFormat::ImuTk => imu_tk::draft(&head, asked, options)?,
        FileFormat::Csv if is_unnamed => {
            return Err(headerless_text::question(&head).into());
        }
        FileFormat::Csv => csv::draft(&head, asked),
        _ => return Err(not_binary(format).into()),
    };
    rows(draft, head, source, options)
}

/// Columns and values of messages, and what there is to say of their file.
type OfMessages = (Draft, Samples, Vec<Diagnostic>);

/// Reads a bag or a log, whose messages say what they hold.
fn read_messages(read: impl FnOnce() -> Checked<OfMessages>, options: &ImuReadOptions) -> Checked<ImuFile> {
    if !options.columns.is_empty() {
        return refuse(
            Refusal::OptionsContradict,
            "[columns] names columns, but the messages of a bag or a log say what they hold",
            "take time, accelerometer, gyroscope and temperature out of [columns]; topic and instance may stay",
        );
    }
    let (mut draft, samples, findings) = read()?;
    draft.slots()?;
    let mut file = finish(draft, samples, options).map_err(|mut input_error| {
        for lost in findings.iter().filter(|found| found.code() != RowsSorted::CODE) {
            input_error.help = format!("{}; {lost}", input_error.help);
        }
        input_error
    })?;
    file.findings.extend(findings);
    Ok(file)
}

#[cfg(feature = "mcap")]
fn read_bag(format: FileFormat, bytes: &[u8], options: &ImuReadOptions) -> Checked<OfMessages> {
    bag::read(format, bytes, options)
}

#[cfg(not(feature = "mcap"))]
fn read_bag(_: FileFormat, _: &[u8], _: &ImuReadOptions) -> Checked<OfMessages> {
    without("mcap")
}

#[cfg(feature = "parquet")]
fn read_parquet(bytes: &[u8], options: &ImuReadOptions) -> Checked<ImuFile> {
    let mut file = parquet::open(bytes)?;
    file.draft.map(options)?;
    file.draft.set_time_unit(options)?;
    let slots = file.draft.slots().map_err(|input_error| file.with_lists(input_error))?;
    file.find_midnight();
    let samples = parquet::samples(&file, &slots, options.budget.unwrap_or_default())?;
    finish(file.draft, samples, options)
}

#[cfg(not(feature = "parquet"))]
fn read_parquet(_: &[u8], _: &ImuReadOptions) -> Checked<ImuFile> {
    without("parquet")
}

fn binary(format: FileFormat, bytes: &[u8], options: &ImuReadOptions) -> Checked<ImuFile> {
    match format {
        FileFormat::Parquet => read_parquet(bytes, options),
        FileFormat::Mcap | FileFormat::Db3 | FileFormat::Rosbag => {
            read_messages(|| read_bag(format, bytes, options), options)
        }
        _ => {
            let mut file = read_messages(|| autopilot::read(format, bytes, options), options)?;
            // every sensor has rows of its own
            file.findings.retain(|found| found.code() != ValuesMissing::CODE);
            Ok(file)
        }
    }
}

/// The format of a text. Where the user names the columns, four of them need not be imu_tk's.
fn sniffed(head: &Head<'_>, options: &ImuReadOptions) -> Checked<FileFormat> {
    match FileFormat::of_text(head) {
        Ok(FileFormat::ImuTk) | Err(_) if !options.columns.is_empty() => Ok(FileFormat::Csv),
        format => format,
    }
}

/// Reads the rows of a text whose columns are known.
pub(super) fn rows(
    mut draft: Draft,
    head: Head<'_>,
    source: Source<'_>,
    options: &ImuReadOptions,
) -> Checked<ImuFile> {
    let line = head.line();
    draft.line = Some(line);
    let at_header = |input_error: Box<InputError>| Box::new(input_error.at_line(line));
    let first_rows = FirstRows::of(&head);
    if draft.format == FileFormat::Csv {
        first_rows.find_clocks(&mut draft);
        first_rows.find_split_clock(&mut draft);
    }
    if let Some(name) = &options.columns.rest_of_second {
        let place = draft.columns.iter().position(|column| column.name == *name);
        draft.rest_unit = place.map(|column| first_rows.unit_of_rest(column));
    }
    let sensor_column = sensor_rows::find(&mut draft, &first_rows, options);
    let of_rows = sensor_column.map(|_| {
        // both sensors' axes are known
        let columns = ColumnMapping { accelerometer: None, gyroscope: None, ..options.columns.clone() };
        ImuReadOptions { columns, ..options.clone() }
    });
    let options = of_rows.as_ref().unwrap_or(options);
    draft.map(options).map_err(at_header)?;
    draft.set_time_unit(options).map_err(at_header)?;
    let only = match sensor_column {
        Some(_) => None,
        None => instances::chosen(&mut draft, &first_rows, options).map_err(at_header)?,
    };
    let slots = draft.slots().map_err(at_header)?;
    let layout = Layout {
        delimiter: head.delimiter,
        slots,
        names: head.names.iter().map(|name| (*name).to_owned()).collect(),
        has_header: !head.names.is_empty(),
        ticks: draft.time_unit() != Some(TimeUnit::Second),
        text_times: draft.has_text_times(),
        only,
        may_be_invalid: READINGS,
        decimal_comma: first_rows.have_decimal_commas(head.delimiter),
    };
    let per_second = draft.time_unit().and_then(TimeUnit::per_second).unwrap_or(1.0);
    let mut reader = SampleReader::new(&layout, (per_second, sensor_column), source.estimated_rows(&head));
    source.read_rows(head, &mut reader)?;
    let mut samples = reader.finish()?;
    samples.last_line = samples.last_line.or(Some(line));
    finish(draft, samples, options)
}

/// Makes a recording of the values of a file.
pub(super) fn finish(mut draft: Draft, mut samples: Samples, options: &ImuReadOptions) -> Checked<ImuFile> {
    let assembled = assemble(&mut draft, &mut samples, options)?;
    let file = ImuFile {
        recording: assembled.recording,
        format: draft.format,
        columns: std::mem::take(&mut draft.columns),
        findings: assembled.findings,
        rows: samples.rows,
        sha256: Vec::new(),
        second: None,
        counted_from_ns: samples.counted_from_ns,
        rate_sd_ppm: samples.rate_sd_ppm,
    };
    only(file, &draft, options)
}

fn not_binary(format: FileFormat) -> InputError {
    InputError::new(
        Refusal::FormatContradicted,
        format!("the format was given as {}, but this is text", format.name()),
        LEAVE_AWAY,
    )
}
