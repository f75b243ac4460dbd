//! The readings of one sensor in the messages of one topic.

use super::layout::{Field, Layout};
use calibrant_core::sensor::SensorKind;
use nalgebra::Vector3;

/// What messages of a topic have of a sensor, by the names of their fields.
pub(crate) struct Topic {
    /// Its name: `sensor_accel`.
    pub(crate) name: &'static str,
    pub(super) sensor_kind: SensorKind,
    /// Clocks, the best one first. The factor makes microseconds of it.
    pub(super) clocks: &'static [(&'static str, f64)],
    pub(super) axes: [&'static str; 3],
    pub(super) temperature: Option<&'static str>,
    /// Microseconds by which the sample was taken later than the clock says.
    pub(super) later_us: Option<&'static str>,
    /// Does a message have several samples, as the sensor's FIFO had them? These are its step in µs, the unit of a count, and the number of samples.
    pub(super) fifo: Option<[&'static str; 3]>,
}

impl Topic {
    pub(super) const fn new(
        name: &'static str,
        sensor_kind: SensorKind,
        clocks: &'static [(&'static str, f64)],
        axes: [&'static str; 3],
    ) -> Self {
        Self { name, sensor_kind, clocks, axes, temperature: None, later_us: None, fifo: None }
    }
}

/// The readings of a sensor.
pub(crate) struct Stream {
    pub(crate) topic: &'static str,
    /// Which of several sensors.
    pub(crate) instance: u8,
    pub(crate) sensor_kind: SensorKind,
    /// Name of its clock.
    pub(crate) clock: &'static str,
    /// Names of the fields of the axes.
    pub(crate) axes: [&'static str; 3],
    /// Sample times, µs.
    pub(crate) times_us: Vec<f64>,
    pub(crate) readings: Vec<Vector3<f64>>,
    /// °C; empty where the messages have none.
    pub(crate) temperatures_c: Vec<f64>,
}

impl Stream {
    /// Adds the readings of another stream behind its own.
    pub(crate) fn append(&mut self, mut other: Self) {
        self.times_us.append(&mut other.times_us);
        self.readings.append(&mut other.readings);
        self.temperatures_c.append(&mut other.temperatures_c);
    }

    /// Mean rate of its samples, Hz; 0 for fewer than two.
    pub(crate) fn rate_hz(&self) -> f64 {
        match self.times_us.as_slice() {
            [first, .., last] if last > first => 1e6 * (self.times_us.len() - 1) as f64 / (last - first),
            _ => 0.0,
        }
    }
}

/// Fills a stream from messages.
pub(super) struct Collector {
    pub(super) stream: Stream,
    clock: (Field, f64),
    axes: [Field; 3],
    temperature: Option<Field>,
    later_us: Option<Field>,
    fifo: Option<[Field; 3]>,
}

/// Stands for no time in a field of a difference of times.
const NO_TIME: f64 = i32::MAX as f64;

impl Collector {
    /// `None` where the messages lack a field.
    pub(super) fn new(topic: &'static Topic, layout: &Layout, instance: u8) -> Option<Self> {
        let field = |name: &str| layout.field(name);
        let (clock, time, factor) =
            topic.clocks.iter().find_map(|(name, factor)| Some((*name, field(name)?, *factor)))?;
        let [x, y, z] = topic.axes.map(field);
        let fifo = match topic.fifo.map(|names| names.map(field)) {
            Some([step, unit, number]) => Some([step?, unit?, number?]),
            None => None,
        };
        let stream = Stream {
            topic: topic.name,
            instance,
            sensor_kind: topic.sensor_kind,
            clock,
            axes: topic.axes,
            times_us: Vec::new(),
            readings: Vec::new(),
            temperatures_c: Vec::new(),
        };
        Some(Self {
            stream,
            clock: (time, factor),
            axes: [x?, y?, z?],
            temperature: topic.temperature.and_then(field),
            later_us: topic.later_us.and_then(field),
            fifo,
        })
    }

    /// Takes the reading of a message; nothing of one that is too short.
    pub(super) fn take(&mut self, message: &[u8]) -> Option<()> {
        let time_us = self.clock.0.value(message)? * self.clock.1;
        if let Some([step, unit, number]) = self.fifo {
            let number = number.value(message)? as usize;
            return self.take_samples(message, time_us, (step.value(message)?, unit.value(message)?, number));
        }
        let later_us = self.later_us.map_or(Some(0.0), |field| field.value(message))?;
        let [x, y, z] = self.axes.map(|field| field.value(message));
        if later_us == NO_TIME {
            return None;
        }
        self.stream.readings.push(Vector3::new(x?, y?, z?));
        self.stream.times_us.push(time_us + later_us);
        if let Some(field) = self.temperature {
            self.stream.temperatures_c.push(field.value(message).unwrap_or(f64::NAN));
        }
        Some(())
    }

    /// Takes the samples of a message, the last of which was taken at its time.
    fn take_samples(
        &mut self,
        message: &[u8],
        time_us: f64,
        (step_us, unit, number): (f64, f64, usize),
    ) -> Option<()> {
        let number = number.min(self.axes.map(|field| field.count).into_iter().min()?);
        // a sensor that is faster than its step says was not faster than its messages
        let since_us = self.stream.times_us.last().map_or(f64::INFINITY, |last| time_us - last);
        let step_us = step_us.min(since_us / number as f64);
        for k in 0..number {
            let [x, y, z] = self.axes.map(|field| field.value_at(message, k));
            self.stream.readings.push(Vector3::new(x?, y?, z?) * unit);
            self.stream.times_us.push(time_us - (number - 1 - k) as f64 * step_us);
        }
        Some(())
    }
}
