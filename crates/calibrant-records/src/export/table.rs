//! Records as columns: one entry for each calibration.

use crate::database::KeptRecord;
use calibrant_io::{HashedFile, unit_ending};
use std::collections::HashMap;

/// The columns of a table. A calibration has an entry in each.
#[derive(Default)]
pub(super) struct Table {
    pub(super) ids: Vec<i64>,
    /// Name and texts.
    pub(super) texts: Vec<(&'static str, Vec<Option<String>>)>,
    /// Name with its unit, and numbers.
    pub(super) numbers: Vec<(String, Vec<Option<f64>>)>,
    /// The place of a parameter's column, by its name and unit. That of the standard deviation follows.
    places: HashMap<(String, &'static str), usize>,
}

impl Table {
    /// Adds a calibration as a row.
    pub(super) fn add(&mut self, kept: &KeptRecord) {
        let (record, before) = (&kept.record, self.ids.len());
        self.ids.push(kept.id);
        let text = |text: &str| Some(text.to_owned());
        let name = |file: &Option<HashedFile>| file.as_ref().map(|file| file.file.clone());
        let sha256 = |file: &Option<HashedFile>| file.as_ref().map(|file| file.sha256.clone());
        let texts = [
            ("sensor", text(&record.sensor)),
            ("recorded", record.recorded.map(|time| time.to_string())),
            ("station", record.station.clone()),
            ("verdict", text(record.verdict.usability.name())),
            ("codes", text(&record.verdict.codes.join(" "))),
            ("status", text(&record.status)),
            ("plan", text(&record.plan)),
            ("program", text(&record.program)),
            ("experiment", name(&record.experiment)),
            ("experiment_sha256", sha256(&record.experiment)),
            ("motion", name(&record.motion_file)),
            ("motion_sha256", sha256(&record.motion_file)),
            ("recording", text(&record.recording())),
            ("recording_sha256", text(&record.recording_sha256())),
            ("inserted", text(&kept.inserted.to_string())),
        ];
        if self.texts.is_empty() {
            self.texts = texts.iter().map(|(name, _)| (*name, Vec::new())).collect();
        }
        for ((_, column), (_, text)) in self.texts.iter_mut().zip(texts) {
            column.push(text);
        }
        let imu = &record.imu;
        for (k, quantity) in imu.quantities.iter().enumerate() {
            let readings = imu.unit(quantity.sensor_kind()).unwrap_or(quantity.sensor_kind().stimulus_unit());
            let place = self.place(quantity.name(), quantity.unit(readings), before);
            let variance =
                imu.covariance.as_ref().map(|sigma| sigma[(k, k)]).filter(|variance| *variance > 0.0);
            self.numbers[place].1.push(Some(quantity.value(&imu.parameters)));
            self.numbers[place + 1].1.push(variance.map(f64::sqrt));
        }
        for (_, column) in &mut self.numbers {
            column.resize(before + 1, None);
        }
    }

    /// The place of a parameter's column, which is made where it is new, with this number of empty entries.
    fn place(&mut self, name: String, unit: &'static str, before: usize) -> usize {
        let numbers = &mut self.numbers;
        *self.places.entry((name, unit)).or_insert_with_key(|(name, unit)| {
            let ending = unit_ending(unit);
            numbers.push((format!("{name}{ending}"), vec![None; before]));
            numbers.push((format!("{name}_sd{ending}"), vec![None; before]));
            numbers.len() - 2
        })
    }
}
