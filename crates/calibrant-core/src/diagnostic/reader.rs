//! Checks of a reader: what it notices in a recording that can be used nevertheless.

use super::check::checks;
use super::parts::Phrase;
pub use super::reader_fields::{
    ClockSourceKind, FileTimes, MissingValue, Span, TemperatureDoubt, Ticks, quoted,
};
use super::reader_fields::{first_here, moment, temperature_missing};
use crate::number_format::{counted, plain};
use crate::sensor::{Axis, ReadingUnit, SensorKind, Temperatures};

checks! {
    /// Columns of a recording are not used.
    ColumnsIgnored "columns-ignored" Note {
        /// Their names.
        columns: Vec<String>,
        /// The sensor that they are of, where another file has it.
        other: Option<SensorKind>,
    }
    decided "They hold nothing that is needed, or they are those of the other file's sensor."
    remedy "Nothing. Name them in [columns] where they are needed."
    says match other {
        None => {
            let ending = if columns.len() == 1 { "" } else { "s" };
            format!("ignored column{ending} {}", quoted(columns, 8))
        }
        Some(other) => format!(
            "its own columns of the {other}, {}, are left aside: the {other} is that of the other file",
            columns.join(", ")
        ),
    };

    /// The recording states another unit than the experiment.
    UnitUnexpected "unit-unexpected" Note {
        /// The header's unit.
        stated: ReadingUnit,
        /// The experiment's.
        expected: ReadingUnit,
    }
    decided "The header's unit is compared with that of the experiment."
    remedy "Correct sensor.unit, where the header is right."
    says format!(
        "readings are in {} by their header, the experiment says {}",
        stated.symbol(),
        expected.symbol()
    );

    /// The user gives another unit than the file states.
    UnitOverruled "unit-overruled" Note {
        /// The sensor.
        sensor_kind: SensorKind,
        /// The file's unit.
        stated: &'static str,
        /// The user's, which counts.
        given: &'static str,
    }
    decided "The unit that the file states, by its format or a column's name, is compared with the given one."
    remedy "Leave the option away, where the file is right."
    says format!("the {sensor_kind} is in {stated} by the file, but read in {given}, as was said");

    /// Rows without a time or a reading were dropped.
    ValuesMissing "values-missing" Note {
        /// What is missing.
        missing: MissingValue,
        /// How often.
        count: usize,
    }
    decided "A field is empty or NaN."
    remedy "Look for what loses values."
    says format!(
        "{}{}",
        match missing {
            MissingValue::Time => format!("{} without a time dropped", counted(*count, "row")),
            MissingValue::Reading => format!("{} without a reading", counted(*count, "row")),
            MissingValue::Part => format!("{} with a missing or NaN value dropped", counted(*count, "sample")),
        },
        first_here(*count)
    );

    /// Rows that repeat the one before were dropped.
    RowsRepeated "rows-repeated" Note {
        /// Their number.
        rows: usize,
    }
    decided "All values are the same."
    remedy "Look at what writes the file."
    says format!(
        "{} equal to the one before dropped{}",
        counted(*rows, "row"),
        first_here(*rows)
    );

    /// Rows with the time of the one before were dropped.
    TimesRepeated "times-repeated" Note {
        /// Their number.
        count: usize,
        /// Is the row kept for the other sensor?
        is_of_one_sensor: bool,
    }
    decided "The time is the same, the readings are not."
    remedy "Write times with more digits."
    says match is_of_one_sensor {
        true => {
            format!("{} with the time of the one before dropped{}", counted(*count, "sample"), first_here(*count))
        }
        false => format!(
            "{} with the time of the one before but another reading dropped{}",
            counted(*count, "row"),
            first_here(*count)
        ),
    };

    /// The last line was cut off and was dropped.
    LineTruncated "line-truncated" Note {}
    decided "It has no line end, and too few fields or digits."
    says "truncated last line dropped";

    /// A bag has no end. The later part of the recording may be missing.
    FileUnfinished "file-unfinished" Warning {
        /// Where it was cut off.
        cut: Phrase,
        /// Is everything there but the index?
        is_after_data: bool,
        /// Messages that were read.
        messages: usize,
        /// Their duration, s.
        duration_s: f64,
    }
    decided "The container lacks its footer."
    remedy "Copy it again, or use `mcap recover`."
    says format!(
        "{}: {} were read, the last one {} s after the first; {}; `mcap recover` makes a whole file of it",
        cut.0,
        counted(*messages, "message"),
        plain(*duration_s, 6),
        match is_after_data {
            true => "no message is missing, only the index is",
            false => "what was recorded after them is not in the file",
        }
    );

    /// Bytes follow the end of a bag. They are not read.
    BytesUnread "bytes-unread" Note {
        /// Their number.
        bytes: usize,
        /// Do they begin as a bag does?
        is_bag: bool,
    }
    decided "The container ends before the file does."
    remedy "Split the file where the first bag ends; `mcap merge` makes one bag of several."
    says match is_bag {
        true => format!("a second bag follows the first in this file: its {bytes} bytes are not read"),
        false => format!("{bytes} bytes follow the end of the bag: they are not read"),
    };

    /// A log has the readings of an IMU more than once, or in a topic of several.
    MessagesChosen "messages-chosen" Note {
        /// What was read.
        taken: String,
        /// What else there is.
        others: Vec<String>,
    }
    decided "Raw readings of 10 Hz at least come before corrected ones, and these before slower ones."
    remedy "Say option `topic` or option `instance` for another."
    says format!(
        "the readings are those of {taken}{}",
        match others.is_empty() {
            true => String::new(),
            false => format!("; option `topic` or option `instance` reads another: {}", others.join(", ")),
        }
    );

    /// The readings of a log were corrected before they were logged.
    CorrectedOnBoard "corrected-on-board" Warning {
        /// Their topics.
        topics: String,
        /// What was done to them.
        how: Phrase,
    }
    decided "The topic and the version of the autopilot say so."
    remedy "Log raw readings, or use the result for readings that are corrected alike."
    says format!(
        "the readings of {topics} are not raw: {}; a calibration of them has the errors that are left, and is for readings corrected alike",
        how.0
    );

    /// A part of a log cannot be read.
    LogPassedOver "log-passed-over" Warning {
        /// Number of bytes.
        bytes: usize,
        /// Number of places.
        places: usize,
    }
    decided "Bytes are no message. Reading goes on where one begins again."
    remedy "Copy the log again, or look for gaps."
    says format!(
        "{} at {} of the log are no messages, and were passed over",
        counted(*bytes, "byte"),
        counted(*places, "place")
    );

    /// Rows or messages were not in the order of their times. They were sorted.
    RowsSorted "rows-sorted" Note {
        /// How many come after a later one.
        rows: usize,
        /// Of how many.
        of: usize,
        /// The times by which they were sorted.
        by: String,
    }
    decided "The times are those of one clock, and each has one place among the others."
    says format!(
        "{rows} of {} come after a later one: they were sorted by {by}",
        counted(*of, "row")
    );

    /// Samples are missing: the time makes a jump.
    SamplingGap "sampling-gap" Note {
        /// Length of the gap, s.
        length_s: f64,
        /// Time of the sample before it, s.
        after_s: f64,
        /// About how many samples are missing.
        samples: f64,
        /// How many gaps there are beside those that are told of. This one is then the longest of all.
        more: Option<usize>,
    }
    decided "A step of time is longer than five usual ones."
    remedy "Look for what loses samples."
    says match more {
        None => format!(
            "gap of {} s after t = {} s: about {samples:.0} samples are missing",
            plain(*length_s, 6),
            moment(*after_s)
        ),
        Some(gaps) => format!(
            "and {}; the longest is {} s after t = {} s",
            counted(*gaps, "more gap"),
            plain(*length_s, 6),
            moment(*after_s)
        ),
    };

    /// The time steps vary.
    SamplingIrregular "sampling-irregular" Note {
        /// The shortest step, s.
        least_s: f64,
        /// The longest that is no gap, s.
        most_s: f64,
        /// Rate of most samples, Hz.
        rate_hz: f64,
        /// Share of the samples that are missing.
        missing_share: f64,
    }
    decided "A step is off the usual one by more than a hundredth."
    remedy "Take the times from the sensor's clock."
    says format!(
        "sampling is irregular: time steps from {} to {} ms, usually {} ms ({} Hz){}",
        plain(least_s * 1e3, 6),
        plain(most_s * 1e3, 6),
        plain(1.0 / rate_hz * 1e3, 6),
        plain(*rate_hz, 6),
        match *missing_share > 0.0 {
            true => format!("; {:.1} % of the samples are missing", 100.0 * missing_share),
            false => String::new(),
        }
    );

    /// An axis never changes.
    AxisStuck "axis-stuck" Note {
        axis: Axis,
        /// Its reading.
        value: f64,
        /// When, where it is not so throughout.
        times: Option<Span>,
    }
    decided "All its readings are the same."
    remedy "Check its connection."
    says match times {
        None => format!("axis {axis} never changes: {} throughout; is it connected?", plain(*value, 6)),
        Some(times) => format!(
            "axis {axis} stays at {} {times} while the others move: is it connected?",
            plain(*value, 6)
        ),
    };

    /// Two axes have the same reading in every sample.
    AxesEqual "axes-equal" Note {
        /// The one.
        one: Axis,
        /// The other.
        other: Axis,
        /// When, where it is not so throughout.
        times: Option<Span>,
    }
    decided "All readings are compared."
    remedy "Look for a column that was written twice."
    says match times {
        None => format!("axes {one} and {other} are the same in every sample: is one column there twice?"),
        Some(times) => format!("axes {one} and {other} are the same {times}: is one wired to the other?"),
    };

    /// Readings may be saturated.
    ReadingsClipped "readings-clipped" Note {
        axis: Axis,
        /// Samples in a row.
        samples: usize,
        /// Is it the largest value, not the smallest?
        is_largest: bool,
        /// The value.
        value: f64,
        /// Its unit.
        unit: ReadingUnit,
    }
    decided "Several in a row have the largest or the smallest value."
    remedy "Record with a larger range."
    says format!(
        "axis {axis} may be saturated: {samples} samples in a row at its {} value {} {}",
        if *is_largest { "largest" } else { "smallest" },
        plain(*value, 6),
        unit.symbol()
    );

    /// The sample times are not simply those of a column of seconds.
    ClockSource "clock-source" Note {
        /// Whence they come.
        clock: ClockSourceKind,
    }
    decided "They follow from a counter, a rate or a large time stamp."
    remedy "Check the rate that the message names."
    says clock.to_string();

    /// A sample rate was given that is not that of the sample times.
    RateUnlikeTimes "rate-unlike-times" Warning {
        /// The rate that was given, Hz.
        given_hz: f64,
        /// That of the sample times, Hz.
        found_hz: f64,
    }
    decided "They differ by more than a hundredth. The sample times are used."
    remedy "Leave option `rate_hz` away, or find out which of them is wrong."
    says format!(
        "the rate was given as {} Hz, but the sample times show {} Hz: the times are used",
        plain(*given_hz, 6),
        plain(*found_hz, 6)
    );

    /// The times count from the first sample.
    TimesFromFirst "times-from-first" Note {
        /// Column of the times.
        column: String,
        /// The first, as the column has it.
        first: Ticks,
        /// Unit of it.
        unit: &'static str,
    }
    decided "The first is so large a number that the clock counts from an epoch of its own."
    says format!(
        "times are counted from the first sample, where `{column}` is {} {unit}",
        first.0
    );

    /// The times are most likely in another unit.
    ClockDoubtful "clock-doubtful" Warning {
        /// The steps of the times, s.
        step_s: f64,
        /// Symbol of the likely unit.
        unit: &'static str,
        /// The rate in that unit, Hz.
        rate_hz: f64,
    }
    decided "The sample rate would be below 2.5 Hz."
    remedy "Give option `time_unit`, or correct the name of the column."
    says format!(
        "the samples are {} s apart: are the times in {unit}? at {} Hz the name of their column ends in _{}",
        plain(*step_s, 6),
        plain(*rate_hz, 6),
        unit.replace('µ', "u")
    );

    /// A sensor of a pair of files was recorded for a part of the other's time only.
    FileShorter "file-shorter" Note {
        /// Their times.
        files: FileTimes,
    }
    decided "Both cover less than 0.9 of the longer recording."
    remedy "Give the files of one recording."
    says files.to_string();

    /// The sensors of a pair of files were never recorded at the same time.
    FilesApart "files-apart" Warning {
        /// Their times.
        files: FileTimes,
    }
    decided "Their times have nothing in common."
    remedy "Give the files of one recording, with times of one clock."
    says files.to_string();

    /// The temperature is missing in some rows. It is interpolated.
    TemperatureGaps "temperature-gaps" Note {
        /// Rows without a temperature.
        missing: usize,
        /// Number of rows.
        rows: usize,
        /// The longest time without one, s.
        longest_s: f64,
    }
    decided "It is missing for 30 s at most."
    says temperature_missing(*missing, *rows, *longest_s);

    /// The temperature is missing for long, or implausible.
    TemperatureDoubtful "temperature-doubtful" Warning {
        /// Why.
        doubt: TemperatureDoubt,
    }
    decided "It is missing for more than 30 s, or no sensor works at it."
    remedy "Check the column of the temperature and its unit."
    says match doubt {
        TemperatureDoubt::Missing { missing, rows, longest_s } => temperature_missing(*missing, *rows, *longest_s),
        TemperatureDoubt::Implausible(value_c) => {
            format!("the temperature is {}: {}", plain(*value_c, 6), Temperatures::question(*value_c))
        }
    };
}
