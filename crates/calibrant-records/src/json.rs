//! What the commands print as JSON: a record with its parameters, the history of a sensor, the fleet.

use super::aging::SensorHistory;
use super::database::KeptRecord;
use super::fleet::Fleet;
use calibrant_core::json::flat;
use calibrant_core::json_object;
use calibrant_core::sensor::{Gauge, ImuFields};
use calibrant_io::{Heading, JsonFile, Kind, RECORD_KIND, SCHEMA};
use schemars::JsonSchema;
use serde::Serialize;

/// A record with its parameters as calibrant JSON, which [`read_calibrated_imu`](calibrant_io::read_calibrated_imu) reads.
#[derive(Serialize, JsonSchema)]
pub struct RecordFile<'a> {
    /// The version of all JSON files.
    schema: u32,
    /// What the file is.
    kind: Kind<Self>,
    #[serde(flatten)]
    record: &'a KeptRecord,
    #[serde(flatten)]
    imu: ImuFields,
}

impl JsonFile for RecordFile<'_> {
    const KIND: &'static str = RECORD_KIND;
}

impl<'a> RecordFile<'a> {
    /// Of this record.
    #[must_use]
    pub fn of(record: &'a KeptRecord) -> Self {
        let imu = ImuFields::of(record.record.imu.clone());
        Self { schema: SCHEMA, kind: Kind::of(), record, imu }
    }
}

json_object! {
    /// The history of a sensor. Angles are in rad.
    SensorHistory as history {
        heading: flat(Heading::<Self>::of()),
        sensor: &history.sensor,
        /// In the order of their dates, one for each recording.
        calibrations: &history.calibrations,
        /// From each calibration to the next. One that did not converge is left out.
        changes: &history.changes,
        /// Number of calibrations behind the aging.
        aging_from: history.aging_from,
        aging: &history.aging,
    }
}

impl JsonFile for SensorHistory {
    const KIND: &'static str = "history";
}

json_object! {
    /// The parameters over all sensors.
    Fleet as fleet {
        heading: flat(Heading::<Self>::of()),
        /// The gauge of all; none where all have one frame of another kind.
        gauge: fleet.gauge.map(Gauge::name),
        /// The reference temperature of those that follow temperature, °C.
        reference_c: fleet.reference_c,
        /// Number of sensors that do not follow temperature, where others do.
        without_temperature: fleet.without_temperature,
        parameters: &fleet.parameters,
        /// Sensors that could not be brought into this frame or to this temperature.
        left_out: &fleet.left_out,
    }
}

impl JsonFile for Fleet {
    const KIND: &'static str = "fleet";
}
