//! The drift of all sensors: which of them changed most.

use super::history::{aging, change, has_converged};
use super::sensor_aging::QuantityAging;
use crate::database::{KeptRecord, RecordFilter, Records};
use calibrant_core::error::Result;
use calibrant_core::estimate::{OverallDifference, tells_its_place};
use calibrant_io::UtcTime;
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

/// The drift of one sensor in short.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct SensorDrift {
    /// The sensor.
    pub sensor: String,
    /// Number of its recordings; at least two.
    pub calibrations: usize,
    /// The earliest date, UTC, where two are known.
    pub first: Option<UtcTime>,
    /// The latest.
    pub last: Option<UtcTime>,
    /// The last change of all parameters together; `None` where it cannot be computed.
    pub last_change: Option<OverallDifference>,
    /// The quantity whose aging is the most significant.
    pub largest_aging: Option<QuantityAging>,
    /// Probability of so significant an aging of one of the quantities, if none ages: that of the largest, times their number (Bonferroni).
    pub aging_p_value: Option<f64>,
    /// The smaller of the probabilities of the last change and of the aging, if all was done at one place; `None` where it is known where it was done, or
    /// where no error of a place is shared.
    pub p_value_at_one_place: Option<f64>,
}

impl Records {
    /// The drift of each sensor with at least two recordings; the most significant stands first.
    ///
    /// # Errors
    /// [`Error::Experiment`](calibrant_core::Error::Experiment) where the records are damaged.
    pub fn drifts(&self) -> Result<Vec<SensorDrift>> {
        let (mut drifts, mut pending) = (Vec::new(), Pending::default());
        self.each(&RecordFilter { latest: true, ..RecordFilter::default() }, |kept| {
            if pending.is_full_before(&kept) {
                drifts.extend(std::mem::take(&mut pending).drifts());
            }
            pending.add(kept);
        })?;
        drifts.extend(pending.drifts());
        let least = |drift: &SensorDrift| least([drift.p_value(), drift.p_value_at_one_place]).unwrap_or(1.0);
        drifts.sort_by(|one, other| {
            least(one).total_cmp(&least(other)).then_with(|| one.sensor.cmp(&other.sensor))
        });
        Ok(drifts)
    }
}

/// Sensors that wait to be worked on together, so that not all records are in memory.
#[derive(Default)]
struct Pending {
    sensors: Vec<Vec<KeptRecord>>,
    records: usize,
}

impl Pending {
    /// Does this record begin a sensor, with many records before it?
    fn is_full_before(&self, kept: &KeptRecord) -> bool {
        /// Largest number of records in memory.
        const MOST: usize = 4096;
        self.records >= MOST && !self.continues(kept)
    }

    fn continues(&self, kept: &KeptRecord) -> bool {
        let last = self.sensors.last().and_then(|sensor| sensor.last());
        last.is_some_and(|last| last.record.sensor == kept.record.sensor)
    }

    fn add(&mut self, kept: KeptRecord) {
        self.records += 1;
        let continues = self.continues(&kept);
        match self.sensors.last_mut().filter(|_| continues) {
            Some(sensor) => sensor.push(kept),
            None => self.sensors.push(vec![kept]),
        }
    }

    fn drifts(self) -> Vec<SensorDrift> {
        self.sensors
            .par_iter()
            .filter(|sensor| sensor.len() > 1)
            .map(|sensor| SensorDrift::of(sensor))
            .collect()
    }
}

impl SensorDrift {
    fn of(calibrations: &[KeptRecord]) -> Self {
        let mut converged = calibrations.iter().rev().filter(|kept| has_converged(kept));
        let last_two = converged.next().zip(converged.next());
        let last_change = last_two.map(|(last, before)| change(before, last));
        let (of_quantities, _) = aging(calibrations, None);
        let largest = largest(&of_quantities);
        let is_somewhere = |kept: &KeptRecord| {
            let mut sources = kept.record.imu.shared.iter().flat_map(|shared| &shared.sources);
            kept.record.station.is_none() && sources.any(|source| !tells_its_place(source))
        };
        let p_value_at_one_place = calibrations.iter().any(is_somewhere).then(|| {
            let (of_quantities, _) = aging(calibrations, Some(""));
            let aging = largest_p_value(&of_quantities);
            let change =
                last_change.as_ref().and_then(|change| change.overall_at_one_place.or(change.overall));
            least([aging, change.map(|change| change.p_value)])
        });
        let mut dates = calibrations.iter().filter_map(|kept| kept.record.recorded);
        let dates = dates.next().zip(dates.next_back()).filter(|(first, last)| first != last);
        Self {
            sensor: calibrations[0].record.sensor.clone(),
            calibrations: calibrations.len(),
            first: dates.map(|(first, _)| first),
            last: dates.map(|(_, last)| last),
            last_change: last_change.and_then(|change| change.overall),
            largest_aging: largest.copied(),
            aging_p_value: largest_p_value(&of_quantities),
            p_value_at_one_place: p_value_at_one_place.flatten(),
        }
    }

    /// The smaller of the probabilities of the last change and of the aging, if nothing changed.
    #[must_use]
    pub fn p_value(&self) -> Option<f64> {
        least([self.last_change.map(|change| change.p_value), self.aging_p_value])
    }
}

fn least(of: [Option<f64>; 2]) -> Option<f64> {
    of.into_iter().flatten().min_by(f64::total_cmp)
}

/// The most significant.
fn largest(of_quantities: &[QuantityAging]) -> Option<&QuantityAging> {
    of_quantities.iter().min_by(|one, other| one.aging.p_value.total_cmp(&other.aging.p_value))
}

/// The probability of the most significant, by Bonferroni.
fn largest_p_value(of_quantities: &[QuantityAging]) -> Option<f64> {
    largest(of_quantities).map(|of| (of.aging.p_value * of_quantities.len() as f64).min(1.0))
}
