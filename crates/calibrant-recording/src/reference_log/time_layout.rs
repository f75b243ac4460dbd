//! Which column holds the times: as the user says, or by the names.

use super::column_faults::{named, repeated};
use super::log_columns::{LogColumns, TimeColumns};
use crate::recording::split_clock::SplitClock;
use crate::recording::{ColumnMeaning, ColumnUnit, TimeUnit, imu_column};
use crate::text::decoding::{Checked, refuse};
use calibrant_core::error::Refusal;

/// The column of times; of two, that of whole seconds.
pub(super) struct TimeLayout {
    pub(super) column: usize,
    /// Its unit where the name states it; of two, that of the second.
    pub(super) unit: Option<TimeUnit>,
    /// The column of the rest of the second.
    pub(super) rest: Option<usize>,
}

impl TimeLayout {
    /// The column of times. `times` has the first numbers of a column.
    pub(super) fn find(
        names: &[String],
        said: &LogColumns,
        times: impl Fn(usize) -> Vec<f64>,
    ) -> Checked<Self> {
        match said.time.as_ref().map(|TimeColumns(of)| of.as_slice()) {
            Some([one]) => {
                let column = named(names, one)?;
                Ok(Self { column, unit: unit(one).flatten(), rest: None })
            }
            Some([seconds, rest, ..]) => {
                let unit = said.time_unit.unwrap_or(TimeUnit::Nanosecond);
                Ok(Self { column: named(names, seconds)?, unit: Some(unit), rest: Some(named(names, rest)?) })
            }
            _ => Self::by_names(names, times),
        }
    }

    fn by_names(names: &[String], times: impl Fn(usize) -> Vec<f64>) -> Checked<Self> {
        if let Some(SplitClock { seconds, rest, unit }) = SplitClock::find(names, times) {
            return Ok(Self { column: seconds, unit: Some(unit), rest: Some(rest) });
        }
        let all = || names.iter().enumerate().filter_map(|(column, name)| Some((column, unit(name)?)));
        let known: Vec<_> = all().filter(|(_, unit)| unit.is_some()).collect();
        match (known.as_slice(), all().collect::<Vec<_>>().as_slice()) {
            // of several, the one whose unit is known
            (&[(column, unit)], _) | ([], &[(column, unit)]) => Ok(Self { column, unit, rest: None }),
            (_, []) => {
                let help = "name it t_s (or t_ms, t_us, t_ns), or say time = \"…\" in [machine.log.columns]";
                refuse(Refusal::ColumnMissing, "there is no column of times", help)
            }
            (_, times @ [(one, _), ..]) => {
                let (other, _) = times[times.len() - 1];
                Err(repeated("time", &names[*one], &names[other]).into())
            }
        }
    }
}

/// The unit of a column of times, where its name states it; `None` where it is of no time.
fn unit(name: &str) -> Option<Option<TimeUnit>> {
    let column = imu_column(name);
    let unit = match column.unit {
        Some(ColumnUnit::Time(unit)) => Some(unit),
        _ => None,
    };
    (column.meaning == ColumnMeaning::Time).then_some(unit)
}
