//! The values of a file's used columns, in the units of the file, whatever its format.

use super::column::ColumnMeaning;
use super::column_names::sensor_named;
use crate::recording::line_map::LineMap;
use crate::recording::row_parser::{Layout, RowReader};
use crate::recording::text_source::RowTaker;
use crate::text::decoding::Checked;
use crate::text::delimited::Line;
use calibrant_core::sensor::{Axis, SensorKind};
use nalgebra::Vector3;
use std::ops::Range;

/// Number of slots: time, three axes of each sensor, temperature, counter, ticks within the second.
pub(super) const SLOTS: usize = 10;
/// Slot of the time.
pub(super) const TIME: usize = 0;
/// Slot of the temperature.
pub(super) const TEMPERATURE: usize = 7;
/// Slot of the sample counter.
pub(super) const COUNTER: usize = 8;

/// Slot of the ticks since the whole second that the time is then in.
pub(super) const REST: usize = 9;

/// The slot of the values of a column of this meaning.
pub(super) fn slot_of(meaning: ColumnMeaning) -> Option<usize> {
    match meaning {
        ColumnMeaning::Time => Some(TIME),
        ColumnMeaning::Reading(sensor_kind, axis) => Some(slots_of(sensor_kind)[axis.index()]),
        ColumnMeaning::Temperature => Some(TEMPERATURE),
        ColumnMeaning::Counter => Some(COUNTER),
        ColumnMeaning::RestOfSecond => Some(REST),
        _ => None,
    }
}

/// Slots of readings in every layout.
pub(super) const READINGS: Range<usize> = 1..7;

/// The slots of a sensor's axes.
pub(super) fn slots_of(sensor_kind: SensorKind) -> [usize; 3] {
    let first = match sensor_kind {
        SensorKind::Accelerometer => 1,
        SensorKind::Gyroscope => 4,
    };
    Axis::ALL.map(|axis| first + axis.index())
}

/// The values of a file. Lists are empty where there is no column, and values NaN where they are missing.
#[derive(Default)]
pub(super) struct Samples {
    /// The times, in the ticks of the file's clock.
    pub(super) times: Vec<f64>,
    pub(super) counts: Vec<f64>,
    pub(super) temperatures: Vec<f64>,
    /// The readings of each sensor.
    pub(super) sensor_kinds: [Vec<Vector3<f64>>; 2],
    /// Number of rows.
    pub(super) rows: usize,
    /// Lines of the rows; empty for a file that has none.
    pub(super) lines: LineMap,
    /// The number that was subtracted from each time, in its ticks, so that they are exact.
    pub(super) origin: i64,
    /// The time from which the times count, ns.
    pub(super) counted_from_ns: Option<i128>,
    /// Standard deviation of the rate, ppm, where the times follow from one.
    pub(super) rate_sd_ppm: Option<f64>,
    /// Line that was cut off, where the last one was.
    pub(super) truncated: Option<usize>,
    /// Last line of the text.
    pub(super) last_line: Option<usize>,
}

impl Samples {
    /// The readings of a sensor.
    pub(super) fn sensor(&self, sensor_kind: SensorKind) -> &[Vector3<f64>] {
        &self.sensor_kinds[sensor_kind as usize]
    }

    /// Moves the readings of a sensor out.
    pub(super) fn take_sensor(&mut self, sensor_kind: SensorKind) -> Vec<Vector3<f64>> {
        std::mem::take(&mut self.sensor_kinds[sensor_kind as usize])
    }

    /// Has a row a value of this sensor?
    pub(super) fn holds(&self, sensor_kind: SensorKind, row: usize) -> bool {
        self.sensor(sensor_kind).get(row).is_some_and(|reading| reading.iter().any(|value| !value.is_nan()))
    }

    /// Puts the rows in another order.
    pub(super) fn reorder(&mut self, rows: &[usize]) {
        for values in [&mut self.times, &mut self.counts, &mut self.temperatures] {
            if !values.is_empty() {
                *values = rows.iter().map(|&row| values[row]).collect();
            }
        }
        for readings in self.sensor_kinds.iter_mut().filter(|readings| !readings.is_empty()) {
            *readings = rows.iter().map(|&row| readings[row]).collect();
        }
        self.lines = self.lines.of(rows);
    }

    /// Has a row the values of another, the time apart?
    pub(super) fn repeats(&self, row: usize, other: usize) -> bool {
        let same = |one: f64, other: f64| one == other || (one.is_nan() && other.is_nan());
        let scalars = [&self.counts, &self.temperatures];
        scalars.iter().all(|values| values.is_empty() || same(values[row], values[other]))
            && self.sensor_kinds.iter().filter(|sensor_kind| !sensor_kind.is_empty()).all(|readings| {
                readings[row].iter().zip(&readings[other]).all(|(&one, &other)| same(one, other))
            })
    }
}

/// Reads the rows of a text.
pub(super) struct SampleReader<'l> {
    reader: RowReader<'l>,
    samples: Samples,
    /// Has the layout a column for this slot?
    has: [bool; SLOTS],
    sensor_kinds: [bool; 2],
    /// Ticks in a second, and the first second, of a clock whose whole seconds have a column of their own.
    per_second: f64,
    first_second: Option<f64>,
    /// The column that names the sensor of each row.
    sensor_column: Option<usize>,
}

impl<'l> SampleReader<'l> {
    /// No rows yet; `capacity` is a guess of how many there will be.
    pub(super) fn new(
        layout: &'l Layout,
        (per_second, sensor_column): (f64, Option<usize>),
        capacity: usize,
    ) -> Self {
        let is_read = |slot: usize| {
            layout.slots.contains(&Some(slot)) || sensor_column.is_some() && READINGS.contains(&slot)
        };
        let has = std::array::from_fn(is_read);
        let sensor_kinds =
            SensorKind::ALL.map(|sensor_kind| slots_of(sensor_kind).iter().any(|&slot| has[slot]));
        let mut samples = Samples::default();
        let room = |is_used: bool| if is_used { capacity } else { 0 };
        samples.times.reserve(room(has[TIME]));
        samples
            .sensor_kinds
            .iter_mut()
            .zip(sensor_kinds)
            .for_each(|(sensor_kind, is_used)| sensor_kind.reserve(room(is_used)));
        Self {
            reader: RowReader::new(layout),
            samples,
            has,
            sensor_kinds,
            per_second,
            first_second: None,
            sensor_column,
        }
    }

    /// The values of all rows; an error where too many rows have invalid ones.
    pub(super) fn finish(mut self) -> Checked<Samples> {
        self.reader.check_invalid()?;
        let of_seconds = self.first_second.map(|first| (first * self.per_second) as i64);
        self.samples.origin = of_seconds.or(self.reader.origin).unwrap_or(0);
        self.samples.truncated = self.reader.truncated;
        Ok(self.samples)
    }
}

/// Moves a reading that stands in the slots of the accelerometer to those of its sensor; the other has none.
fn move_to(sensor_kind: SensorKind, values: &mut [f64; SLOTS]) {
    let reading = slots_of(SensorKind::Accelerometer).map(|slot| values[slot]);
    values[READINGS].fill(f64::NAN);
    slots_of(sensor_kind).into_iter().zip(reading).for_each(|(slot, value)| values[slot] = value);
}

impl RowTaker for SampleReader<'_> {
    fn take<'t>(&mut self, lines: impl Iterator<Item = Line<'t>>, text: &str) -> Checked<()> {
        self.reader.look_at_the_end(text);
        let samples = &mut self.samples;
        let mut values = [f64::NAN; SLOTS];
        for line in lines {
            samples.last_line = Some(line.number);
            if !self.reader.read(line, &mut values)? {
                continue;
            }
            if let Some(column) = self.sensor_column {
                let name = line.fields(self.reader.delimiter()).nth(column).map_or("", |(_, field)| field);
                let Some(sensor_kind) = sensor_named(name) else { continue };
                move_to(sensor_kind, &mut values);
            }
            samples.lines.push(samples.rows, line.number);
            samples.rows += 1;
            if self.has[REST] {
                self.first_second = self.first_second.or(Some(values[TIME]).filter(|t| t.is_finite()));
                let seconds = values[TIME] - self.first_second.unwrap_or(0.0);
                samples.times.push(seconds * self.per_second + values[REST]);
            } else if self.has[TIME] {
                samples.times.push(values[TIME]);
            }
            for sensor_kind in
                SensorKind::ALL.into_iter().filter(|&sensor_kind| self.sensor_kinds[sensor_kind as usize])
            {
                // a sensor with fewer axes reads nothing along the others
                let [x, y, z] =
                    slots_of(sensor_kind).map(|slot| if self.has[slot] { values[slot] } else { 0.0 });
                samples.sensor_kinds[sensor_kind as usize].push(Vector3::new(x, y, z));
            }
            if self.has[TEMPERATURE] {
                samples.temperatures.push(values[TEMPERATURE]);
            }
            if self.has[COUNTER] {
                samples.counts.push(values[COUNTER]);
            }
        }
        Ok(())
    }

    fn last_line(&self) -> Option<usize> {
        self.samples.last_line
    }
}
