//! The layout of a file before its rows are read: its columns, their meaning, and the source of the times.

use super::column::{ColumnMeaning, ImuColumn};
use super::column_names::is_of_sample;
use super::column_values::{READINGS, slot_of};
use super::format::FileFormat;
use super::options::{AccelerometerOnly, ImuReadOptions};
use super::unit::ColumnUnit;
use crate::recording::time_unit::TimeUnit;
use crate::text::decoding::{Checked, refuse};
use calibrant_core::diagnostic::reader::quoted;
use calibrant_core::error::{InputError, Refusal};
use calibrant_core::sensor::{Axis, SensorKind};

/// The layout of a file before its rows are read.
pub(super) struct Draft {
    pub(super) format: FileFormat,
    pub(super) columns: Vec<ImuColumn>,
    /// The time column restarts at this number of ticks.
    pub(super) time_wraps_at: Option<f64>,
    /// The counter restarts at this number.
    pub(super) counter_wraps_at: Option<f64>,
    /// Sample rate that the file states, Hz, and its place.
    pub(super) rate_hz: Option<(f64, &'static str)>,
    /// Columns whose times are text, and the ticks (ns) after which they begin anew.
    pub(super) texts: Vec<(usize, Option<f64>)>,
    /// Unit of the column of ticks within the second that the user names, by its values.
    pub(super) rest_unit: Option<TimeUnit>,
    /// Columns of numbers that only go up.
    pub(super) may_be_clocks: Vec<String>,
    /// Of a plain text of one accelerometer: what its experiment expects. Such a recording need not show
    /// gravity, and its clock may have coarse steps.
    pub(super) plain: Option<AccelerometerOnly>,
    /// Line of the header, in a text.
    pub(super) line: Option<usize>,
}

impl Draft {
    pub(super) fn new(format: FileFormat, columns: Vec<ImuColumn>) -> Self {
        Self {
            format,
            columns,
            time_wraps_at: None,
            counter_wraps_at: None,
            rate_hz: None,
            texts: Vec::new(),
            rest_unit: None,
            may_be_clocks: Vec::new(),
            plain: None,
            line: None,
        }
    }

    /// Marks the other sensor's columns as unused.
    pub(super) fn keep_only(&mut self, sensor_kind: SensorKind) {
        for column in &mut self.columns {
            if matches!(column.meaning, ColumnMeaning::Reading(other, _) if other != sensor_kind) {
                column.unused = Some(format!("the file was given for its {sensor_kind}"));
            }
        }
    }

    /// Applies the user's mapping of the columns.
    pub(super) fn map(&mut self, options: &ImuReadOptions) -> Checked<()> {
        let mapping = &options.columns;
        if let Some((name, rest)) = mapping.time.as_ref().zip(mapping.rest_of_second.as_ref()) {
            if !self.format.is_text() {
                let message = "[columns] names two columns for the time, which is read of text only";
                return refuse(Refusal::OptionsContradict, message, "add them to one column of times");
            }
            self.unuse(
                &[ColumnMeaning::Time, ColumnMeaning::RestOfSecond, ColumnMeaning::Counter],
                "other columns are named in [columns]",
            );
            let unit = ColumnUnit::Time(options.time_unit.or(self.rest_unit).unwrap_or(TimeUnit::Nanosecond));
            self.assign(name, ColumnMeaning::Time, Some(unit))?;
            self.assign(rest, ColumnMeaning::RestOfSecond, Some(unit))?;
            (self.time_wraps_at, self.counter_wraps_at) = (None, None);
        } else if let Some(name) = &mapping.time {
            self.unuse(
                &[ColumnMeaning::Time, ColumnMeaning::RestOfSecond, ColumnMeaning::Counter],
                "another column is named in [columns]",
            );
            let unit = options.time_unit.map(ColumnUnit::Time);
            let meaning = match options.time_unit {
                Some(TimeUnit::Sample) => ColumnMeaning::Counter,
                _ => ColumnMeaning::Time,
            };
            self.assign(name, meaning, unit)?;
            (self.time_wraps_at, self.counter_wraps_at) = (None, None);
        }
        for sensor_kind in SensorKind::ALL {
            let Some(names) = mapping.sensor(sensor_kind) else { continue };
            let meanings = Axis::ALL.map(|axis| ColumnMeaning::Reading(sensor_kind, axis));
            self.unuse(&meanings, "other columns are named in [columns]");
            for (name, meaning) in names.iter().zip(meanings) {
                self.assign(name, meaning, options.unit(sensor_kind).map(ColumnUnit::Reading))?;
            }
        }
        if let Some(name) = &mapping.temperature {
            self.unuse(&[ColumnMeaning::Temperature], "another column is named in [columns]");
            self.assign(name, ColumnMeaning::Temperature, Some(ColumnUnit::Celsius))?;
        }
        self.choose_clock(options.time_unit.map(ColumnUnit::Time));
        Ok(())
    }

    /// Takes another clock where no column of sample times says its unit: one of numbers before one of texts, one of a known unit before others. None in another unit than the
    /// given one.
    fn choose_clock(&mut self, given: Option<ColumnUnit>) {
        let is_text = |k: usize| self.texts.iter().any(|(column, _)| *column == k);
        let rank = |k: usize| {
            let column = &self.columns[k];
            match column.meaning {
                _ if is_text(k) => 1,
                ColumnMeaning::Time | ColumnMeaning::Clock if column.unit.is_some() => 0,
                ColumnMeaning::Time => 2,
                _ => 3,
            }
        };
        let is_used_time = |column: &ImuColumn| column.meaning == ColumnMeaning::Time && column.is_used();
        let of_times = (0..self.columns.len()).filter(|&k| is_used_time(&self.columns[k])).map(rank).min();
        let is_in = |unit: Option<ColumnUnit>| unit.is_none() || given.is_none() || unit == given;
        let is_clock = |column: &ImuColumn| column.meaning == ColumnMeaning::Clock && is_in(column.unit);
        let clocks = (0..self.columns.len()).filter(|&k| is_clock(&self.columns[k]));
        if let Some(best) = clocks
            .min_by_key(|&k| (rank(k), !is_of_sample(&self.columns[k].name)))
            .filter(|&k| of_times.is_none_or(|least| rank(k) < least))
        {
            self.unuse(&[ColumnMeaning::Time], "another clock says its unit");
            (self.columns[best].meaning, self.columns[best].unused) = (ColumnMeaning::Time, None);
        }
        for (k, wraps_at) in &self.texts {
            let column = &mut self.columns[*k];
            if column.meaning == ColumnMeaning::Time && column.is_used() {
                column.unit = Some(ColumnUnit::Time(TimeUnit::Nanosecond));
                self.time_wraps_at = *wraps_at;
            }
        }
    }

    /// Is the used column of times one of texts?
    pub(super) fn has_text_times(&self) -> bool {
        self.texts
            .iter()
            .any(|(k, _)| self.columns[*k].meaning == ColumnMeaning::Time && self.columns[*k].is_used())
    }

    fn unuse(&mut self, meanings: &[ColumnMeaning], why: &str) {
        for column in self.columns.iter_mut().filter(|column| meanings.contains(&column.meaning)) {
            (column.meaning, column.unused) = (ColumnMeaning::Other, Some(why.to_owned()));
        }
    }

    fn assign(&mut self, name: &str, meaning: ColumnMeaning, unit: Option<ColumnUnit>) -> Checked<()> {
        let mut found = self.columns.iter_mut().filter(|column| column.name == name);
        let (Some(column), other) = (found.next(), found.next()) else {
            let names: Vec<String> = self.columns.iter().map(|column| column.name.clone()).collect();
            let message = format!(
                "[columns] names `{name}`, which the file does not have; it has {}",
                quoted(&names, 20)
            );
            return refuse(Refusal::ColumnMissing, message, "names count letter by letter, capitals too");
        };
        if other.is_some() {
            let message = format!("[columns] names `{name}`, which the file has twice");
            return refuse(Refusal::ColumnRepeated, message, "rename one of them in the file");
        }
        // what the user gives takes precedence over the name
        let unit = unit
            .or(super::column_names::column(name).unit.filter(|_| column.meaning == meaning))
            .or(column.unit);
        (column.meaning, column.unit, column.unused) = (meaning, unit, None);
        Ok(())
    }

    /// Sets the unit of the time where neither the name nor the mapping gives it.
    pub(super) fn set_time_unit(&mut self, options: &ImuReadOptions) -> Checked<()> {
        let Some(given) = options.time_unit.filter(|_| options.columns.time.is_none()) else { return Ok(()) };
        for column in self.columns.iter_mut().filter(|column| column.meaning == ColumnMeaning::Time) {
            match column.unit {
                Some(ColumnUnit::Time(stated)) if stated != given => {
                    let message = format!(
                        "column `{}` is in {}, but the time's unit was given as {}",
                        column.name,
                        stated.symbol(),
                        given.symbol()
                    );
                    return refuse(Refusal::UnitContradicted, message, "leave option `time_unit` away");
                }
                Some(_) => (),
                None if given == TimeUnit::Sample => {
                    (column.meaning, column.unit) = (ColumnMeaning::Counter, Some(ColumnUnit::Time(given)));
                }
                None => column.unit = Some(ColumnUnit::Time(given)),
            }
        }
        Ok(())
    }

    /// The slot of each column's values, `None` where it is not used. An error where a sensor has no columns,
    /// lacks an axis or has one twice.
    pub(super) fn slots(&mut self) -> Checked<Vec<Option<usize>>> {
        self.one_time();
        let mut slots: Vec<Option<usize>> = vec![None; self.columns.len()];
        for (k, column) in self.columns.iter().enumerate().filter(|(_, column)| column.is_used()) {
            let Some(slot) = slot_of(column.meaning) else { continue };
            if let Some(other) = slots.iter().position(|taken| *taken == Some(slot)) {
                let message = format!(
                    "two columns hold the {}: `{}` and `{}`",
                    column.meaning, self.columns[other].name, column.name
                );
                let help = match self.columns[other].name == column.name {
                    true => "rename one of them in the file",
                    false => "say which in [columns] of an experiment file",
                };
                return refuse(Refusal::ColumnRepeated, message, help);
            }
            slots[k] = Some(slot);
        }
        let has = |slot| slots.contains(&Some(slot));
        for sensor_kind in SensorKind::ALL {
            let needed = self.plain.map_or(3, |only| only.axes);
            let missing: Vec<String> = Axis::ALL
                .into_iter()
                .take(needed)
                .filter(|&axis| !slot_of(ColumnMeaning::Reading(sensor_kind, axis)).is_some_and(has))
                .map(|axis| axis.to_string())
                .collect();
            if !missing.is_empty() && missing.len() < needed {
                let message = format!("the {sensor_kind} has no column for axis {}", missing.join(", "));
                let help = match self.plain {
                    Some(_) => "a recording of an accelerometer has the columns t_s,ax,ay,az",
                    None => "three axes are needed; or leave its columns out altogether",
                };
                return refuse(Refusal::ColumnMissing, message, help);
            }
        }
        let readings = slots.iter().flatten().any(|slot| READINGS.contains(slot));
        let of = |meaning| self.columns.iter().find(|column| column.meaning == meaning);
        let accelerometer =
            slot_of(ColumnMeaning::Reading(SensorKind::Accelerometer, Axis::X)).is_some_and(has);
        if let Some(column) = of(ColumnMeaning::GravityRemoved).filter(|_| !accelerometer) {
            return refuse(
                Refusal::GravityRemoved,
                format!(
                    "gravity has been removed from the acceleration (column `{}`): what the sensor read cannot be got back, and gravity is what calibrates it",
                    column.name
                ),
                "export the accelerometer's own readings (Acc_X, Acc_Y, Acc_Z)",
            );
        }
        if !readings {
            return Err(self.nothing_to_read().into());
        }
        Ok(slots)
    }

    fn nothing_to_read(&self) -> InputError {
        let names = |meaning| {
            let named: Vec<String> = self
                .columns
                .iter()
                .filter(|column| column.meaning == meaning)
                .map(|column| column.name.clone())
                .collect();
            named
        };
        let orientation = names(ColumnMeaning::Orientation);
        if !orientation.is_empty() {
            return InputError::new(
                Refusal::ColumnMissing,
                format!(
                    "the file holds orientation only ({}): no reading of a sensor",
                    quoted(&orientation, 3)
                ),
                "export accelerometer and gyroscope (Acc_X, …, Gyr_X, …): orientation is computed from them, and they do not follow from it",
            );
        }
        let increments = names(ColumnMeaning::Increment);
        if !increments.is_empty() {
            return InputError::new(
                Refusal::ColumnMissing,
                format!("the file holds increments only ({}), not readings", quoted(&increments, 3)),
                "export accelerometer and gyroscope (Acc_X, …, Gyr_X, …)",
            );
        }
        let all: Vec<String> = self.columns.iter().map(|column| column.name.clone()).collect();
        let message = format!(
            "no column is known to be an accelerometer's or a gyroscope's; the columns are {}",
            quoted(&all, 20)
        );
        if ["x", "y", "z"].iter().all(|axis| all.iter().any(|name| name.eq_ignore_ascii_case(axis))) {
            let help = "x, y and z do not say whose they are. Give two files: the accelerometer's, and with option \
                        `gyroscope` the gyroscope's. Of one alone, say in [columns] of an experiment file whose they are";
            return InputError::new(Refusal::ColumnMissing, message, help);
        }
        InputError::new(
            Refusal::ColumnMissing,
            message,
            "name them like t_s,ax_mps2,ay_mps2,az_mps2,gx_radps,gy_radps,gz_radps, or say which is which in [columns] of an experiment file",
        )
    }

    /// Keeps one time column: of several, that of the samples, or the one whose unit is known. A time and a counter both stay.
    fn one_time(&mut self) {
        let is_time = |column: &ImuColumn| column.meaning == ColumnMeaning::Time && column.is_used();
        if self.columns.iter().any(|column| is_time(column) && is_of_sample(&column.name)) {
            let others = self.columns.iter_mut().filter(|column| !is_of_sample(&column.name));
            for column in others.filter(|column| is_time(column)) {
                column.unused = Some("the times of the samples are in another column".into());
            }
        }
        let times = self.columns.iter().filter(|column| is_time(column)).count();
        let known = self.columns.iter().filter(|column| is_time(column) && column.unit.is_some()).count();
        if times > 1 && known == 1 {
            for column in self.columns.iter_mut().filter(|column| is_time(column) && column.unit.is_none()) {
                column.unused = Some("another time column says its unit".into());
            }
        }
    }

    /// The used column of this meaning.
    pub(super) fn column(&self, meaning: ColumnMeaning) -> Option<&ImuColumn> {
        self.columns.iter().find(|column| column.meaning == meaning && column.is_used())
    }

    /// Records why columns of this meaning are not used after all.
    pub(super) fn leave_aside(&mut self, meaning: ColumnMeaning, why: &str) {
        for column in self.columns.iter_mut().filter(|column| column.meaning == meaning && column.is_used()) {
            column.unused = Some(why.to_owned());
        }
    }

    /// Sets the unit of the columns of this meaning.
    pub(super) fn set_unit(&mut self, meaning: ColumnMeaning, unit: ColumnUnit) {
        for column in self.columns.iter_mut().filter(|column| column.meaning == meaning && column.is_used()) {
            column.unit = Some(unit);
        }
    }

    /// Unit of the time column, where there is one and it is known.
    pub(super) fn time_unit(&self) -> Option<TimeUnit> {
        match self.column(ColumnMeaning::Time)?.unit {
            Some(ColumnUnit::Time(unit)) => Some(unit),
            _ => None,
        }
    }
}
