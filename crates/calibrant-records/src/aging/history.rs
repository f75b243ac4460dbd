//! The history of a sensor: what changed from each calibration to the next, and how it ages.

use super::sensor_aging::{DatedCalibration, QuantityAging, aging_of};
use crate::database::{KeptRecord, RecordFilter, Records};
use calibrant_core::diagnostic::Usability;
use calibrant_core::error::Result;
use calibrant_core::estimate::{CalibrationStatus, Comparison, Place};
use schemars::JsonSchema;
use serde::Serialize;

/// Seconds of a year of 365.25 days.
const YEAR_S: f64 = 365.25 * 86_400.0;

/// The calibrations of one sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorHistory {
    /// The sensor.
    pub sensor: String,
    /// Its calibrations in the order of their dates, one for each recording.
    pub calibrations: Vec<KeptRecord>,
    /// Its changes from each calibration to the next. One that did not converge is left out.
    pub changes: Vec<SensorChange>,
    /// Its aging by the calibrations that have a date and are not bad.
    pub aging: Vec<QuantityAging>,
    /// Number of those calibrations.
    pub aging_from: usize,
}

/// What changed between two calibrations.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SensorChange {
    /// The number of the earlier.
    pub from: i64,
    /// The number of the later.
    pub to: i64,
    /// The later beside the earlier.
    #[serde(flatten)]
    pub comparison: Comparison,
}

impl Records {
    /// The history of a sensor; without calibrations where there is none of it.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) where the records are damaged.
    pub fn history(&self, sensor: &str) -> Result<SensorHistory> {
        let filter =
            RecordFilter { sensor: Some(sensor.to_owned()), latest: true, ..RecordFilter::default() };
        Ok(SensorHistory::of(self.list(&filter)?))
    }
}

impl SensorHistory {
    /// The history of calibrations of one sensor that stand in the order of their dates.
    pub(super) fn of(calibrations: Vec<KeptRecord>) -> Self {
        let usable: Vec<&KeptRecord> = calibrations.iter().filter(|kept| has_converged(kept)).collect();
        let of_pair = |pair: &[&KeptRecord]| SensorChange {
            from: pair[0].id,
            to: pair[1].id,
            comparison: change(pair[0], pair[1]),
        };
        let changes = usable.windows(2).map(of_pair).collect();
        let (aging, aging_from) = aging(&calibrations, None);
        let sensor = calibrations.first().map_or_else(String::new, |kept| kept.record.sensor.clone());
        Self { sensor, changes, aging, aging_from, calibrations }
    }
}

/// Has its estimation converged?
pub(super) fn has_converged(kept: &KeptRecord) -> bool {
    kept.record.status == CalibrationStatus::Converged.name()
}

/// The change from one calibration to another.
pub(super) fn change(earlier: &KeptRecord, later: &KeptRecord) -> Comparison {
    let [one, other] = [earlier, later].map(|kept| kept.record.station.as_deref());
    Comparison::at(Place::of_stations(one, other), &earlier.record.imu, &later.record.imu)
}

/// The aging by calibrations of one sensor that have a date and are not bad, and their number. Those without a station count as of `station`.
pub(super) fn aging(calibrations: &[KeptRecord], station: Option<&str>) -> (Vec<QuantityAging>, usize) {
    let counts = |kept: &&KeptRecord| kept.record.verdict.usability != Usability::Bad && has_converged(kept);
    let seconds = |kept: &KeptRecord| Some(kept.record.recorded?.seconds() as f64);
    let from_s = calibrations.iter().find_map(seconds).unwrap_or_default();
    let mut dated = Vec::new();
    for kept in calibrations.iter().filter(counts) {
        let Some(seconds) = seconds(kept) else { continue };
        let time_years = (seconds - from_s) / YEAR_S;
        let station = kept.record.station.as_deref().or(station);
        dated.push(DatedCalibration { time_years, imu: &kept.record.imu, station });
    }
    (aging_of(&dated), dated.len())
}
