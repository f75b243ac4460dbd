//! Which columns hold what, and in which unit, as the reader of recordings says.

use calibrant::io::{ColumnMeaning, ColumnUnit, ImuFile, ImuUnit};
use calibrant_core::sensor::{Axis, ReadingUnit, Recording, SensorKind};

/// A sample in the units of the reader.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sample {
    pub(crate) t_s: f64,
    /// Accelerometer, gyroscope.
    pub(crate) readings: [Option<[f64; 3]>; 2],
    pub(crate) temperature_c: Option<f64>,
}

/// What the columns are.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    /// The column of times, and its ticks in a second.
    pub(crate) time: Option<(usize, f64)>,
    /// Column and factor of each axis of each sensor.
    pub(crate) axes: [Option<[(usize, f64); 3]>; 2],
    /// Largest readings of each sensor, where they are counts of 16 bits whose sensitivity is stated.
    pub(crate) largest: [Option<f64>; 2],
    /// Of the readings after the factor.
    pub(crate) units: [Option<ReadingUnit>; 2],
    temperature: Option<usize>,
}

impl Layout {
    pub(crate) fn of(file: &ImuFile) -> Self {
        let used = || file.columns.iter().enumerate().filter(|(_, column)| column.is_used());
        let place = |meaning: ColumnMeaning| used().find(|(_, column)| column.meaning == meaning);
        let axis = |kind: SensorKind, axis: Axis| {
            let (column, of) = place(ColumnMeaning::Reading(kind, axis))?;
            match of.unit {
                Some(ColumnUnit::Reading(unit)) => Some((column, unit.reading().1)),
                _ => Some((column, 1.0)),
            }
        };
        let sensor = |kind: SensorKind| {
            let [x, y, z] = Axis::ALL.map(|of| axis(kind, of));
            Some([x?, y?, z?])
        };
        let per_second = |unit: Option<ColumnUnit>| match unit {
            Some(ColumnUnit::Time(unit)) => unit.per_second().unwrap_or(1.0),
            _ => 1.0,
        };
        Self {
            time: place(ColumnMeaning::Time).map(|(column, of)| (column, per_second(of.unit))).or_else(
                || {
                    // a counter goes with the rate of the samples
                    let (column, _) = place(ColumnMeaning::Counter)?;
                    let (_, recording) = file.recording.sensors().next()?;
                    Some((column, recording.rate_hz()))
                },
            ),
            largest: SensorKind::ALL.map(|kind| {
                match place(ColumnMeaning::Reading(kind, Axis::X))?.1.unit? {
                    ColumnUnit::Reading(unit @ ImuUnit::CountsOf(_)) => {
                        Some(f64::from(i16::MAX) * unit.reading().1)
                    }
                    _ => None,
                }
            }),
            axes: SensorKind::ALL.map(sensor),
            units: SensorKind::ALL.map(|kind| file.recording.sensor(kind).map(Recording::unit)),
            temperature: place(ColumnMeaning::Temperature).map(|(column, _)| column),
        }
    }

    /// Has each row its time?
    pub(crate) fn has_clock(&self) -> bool {
        self.time.is_some()
    }

    /// The sample of a row; `None` where a number is none.
    pub(crate) fn sample(&self, row: &[String]) -> Option<Sample> {
        let number = |column: usize| row.get(column)?.parse::<f64>().ok().filter(|value| value.is_finite());
        let t_s = match self.time {
            Some((column, per_second)) => number(column)? / per_second,
            None => return None,
        };
        let mut readings = [None; 2];
        for (reading, axes) in readings.iter_mut().zip(&self.axes) {
            let Some(axes) = axes else { continue };
            // an axis without a value is no sample of its sensor
            let values = axes.map(|(column, factor)| Some(number(column)? * factor));
            *reading = match values {
                [Some(x), Some(y), Some(z)] => Some([x, y, z]),
                _ if axes
                    .iter()
                    .all(|(column, _)| row.get(*column).is_some_and(|field| field.is_empty())) =>
                {
                    None
                }
                _ => return None,
            };
        }
        Some(Sample { t_s, readings, temperature_c: self.temperature.and_then(number) })
    }
}
