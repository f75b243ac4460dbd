//! Which readings of an autopilot's log are taken.

use super::options::ImuReadOptions;
use crate::recording::autopilot::stream::Stream;
use crate::text::decoding::Checked;
use calibrant_core::error::{Answer, InputError, Refusal, TaskOption};
use calibrant_core::sensor::SensorKind;

/// Topics that are read together.
pub(super) struct Source {
    pub(super) topics: &'static [&'static str],
    /// What the autopilot does to the readings; `None` of raw ones.
    pub(super) corrected: Option<&'static str>,
}

pub(super) const PX4: &[Source] = &[
    Source { topics: &["sensor_accel_fifo", "sensor_gyro_fifo"], corrected: None },
    Source { topics: &["sensor_accel", "sensor_gyro"], corrected: None },
    Source { topics: &["sensor_combined"], corrected: Some(PX4_CORRECTS) },
];
pub(super) const PX4_CORRECTS: &str = "PX4 has corrected them by its parameters CAL_ACC… and CAL_GYRO…, and by the biases that its filter estimates";
pub(super) const ARDUPILOT: &[Source] = &[
    Source { topics: &["ACC", "GYR"], corrected: Some(ARDUPILOT_CORRECTS) },
    Source { topics: &["IMU"], corrected: Some(ARDUPILOT_FILTERS) },
];
const ARDUPILOT_CORRECTS: &str = "ArduPilot has corrected them by its parameters INS_ACC…OFFS, INS_ACC…SCAL and INS_GYR…OFFS, unless these are 0, 1 and 0";
const ARDUPILOT_FILTERS: &str = "ArduPilot has corrected them by its parameters INS_ACC…OFFS, INS_ACC…SCAL and INS_GYR…OFFS, unless these are 0, 1 and 0, and has filtered them";

/// Fewer samples in a second are no recording of a motion, Hz.
const LEAST_HZ: f64 = 10.0;

/// What is read of a log.
pub(super) struct Chosen {
    pub(super) source: &'static Source,
    /// Its streams of one IMU.
    pub(super) streams: Vec<Stream>,
    pub(super) others: Vec<Stream>,
}

impl Source {
    fn has(&self, stream: &Stream) -> bool {
        self.topics.contains(&stream.topic)
    }
}

/// What the options choose of the streams of a log; a question where they leave several IMUs.
pub(super) fn chosen(
    sources: &'static [Source],
    streams: Vec<Stream>,
    options: &ImuReadOptions,
) -> Checked<Chosen> {
    let asked = options.topic.as_deref();
    let of_topic = |source: &&Source| asked.is_none_or(|topic| source.topics.contains(&topic));
    let is_there = |source: &&Source| streams.iter().any(|stream| source.has(stream));
    let candidates: Vec<&Source> = sources.iter().filter(of_topic).filter(is_there).collect();
    let instances = distinct(streams.iter().map(|stream| stream.instance.to_string()));
    if let Some(given) = options.instance.as_ref().filter(|given| !instances.contains(given)) {
        return Err(which_imu(format!("the log has no IMU {given}"), &instances).into());
    }
    let is_asked =
        |stream: &Stream| options.instance.as_ref().is_none_or(|given| *given == stream.instance.to_string());
    // complete at a usable rate before incomplete; the first of the best
    let needed = if options.accelerometer_only.is_some() { 1 } else { 2 };
    let worth = |source: &&Source| {
        let sensors = |least_hz: f64| {
            let own =
                |stream: &&Stream| source.has(stream) && is_asked(stream) && stream.rate_hz() >= least_hz;
            let has =
                |kind: &SensorKind| streams.iter().filter(own).any(|stream| stream.sensor_kind == *kind);
            SensorKind::ALL.iter().filter(|kind| has(kind)).count().min(needed)
        };
        (sensors(LEAST_HZ), sensors(0.0))
    };
    let Some(source) = candidates.into_iter().rev().max_by_key(worth) else {
        return Err(nothing_in(sources, &streams, asked).into());
    };
    let (own, others): (Vec<Stream>, Vec<Stream>) =
        streams.into_iter().partition(|stream| source.has(stream) && is_asked(stream));
    let instances = distinct(own.iter().map(|stream| stream.instance.to_string()));
    if let [_, _, ..] = instances.as_slice() {
        let topics = source.topics.join(" and ");
        let message = format!("the log has {} IMUs in {topics}: {}", instances.len(), instances.join(", "));
        return Err(which_imu(message, &instances).into());
    }
    // a subscription that was renewed goes on
    let mut streams: Vec<Stream> = Vec::new();
    for stream in own {
        match streams.iter_mut().find(|known| known.sensor_kind == stream.sensor_kind) {
            Some(known) => known.append(stream),
            None => streams.push(stream),
        }
    }
    Ok(Chosen { source, streams, others })
}

fn which_imu(message: String, instances: &[String]) -> InputError {
    let answer = Answer::new(TaskOption::Instance, instances.iter().map(String::as_str));
    InputError::question(Refusal::SensorUnnamed, message, vec![answer.and(", or instance in [columns]")])
}

/// The error where no source has anything, or the topic that is asked for.
fn nothing_in(sources: &[Source], streams: &[Stream], asked: Option<&str>) -> InputError {
    let topics = distinct(streams.iter().map(|stream| stream.topic));
    match asked {
        Some(asked) if !topics.is_empty() => {
            let message = format!("there are no readings of an IMU in `{asked}`");
            InputError::question(Refusal::TopicUnknown, message, vec![Answer::new(TaskOption::Topic, topics)])
        }
        _ => {
            let all: Vec<&str> = sources.iter().flat_map(|source| source.topics).copied().collect();
            let message = format!("the log has no readings of an IMU: it has no messages {}", all.join(", "));
            InputError::new(
                Refusal::SensorMissing,
                message,
                "log them: parameters of the autopilot say what it logs",
            )
        }
    }
}

pub(super) fn distinct<T: PartialEq>(all: impl Iterator<Item = T>) -> Vec<T> {
    let mut distinct = Vec::new();
    all.for_each(|one| {
        if !distinct.contains(&one) {
            distinct.push(one);
        }
    });
    distinct
}
