//! Records as columns: one entry for each calibration.

use crate::database::KeptRecord;
use calibrant_io::{ColumnValues, HashedFile, Table, TableColumn, unit_ending};
use std::borrow::Cow;
use std::collections::HashMap;

/// The columns of a table. A calibration has an entry in each.
#[derive(Default)]
pub(super) struct Columns {
    ids: Vec<i64>,
    /// Name and texts.
    texts: Vec<(&'static str, Vec<Option<Cow<'static, str>>>)>,
    /// Name with its unit, and numbers; one that is missing is not a number.
    numbers: Vec<(String, Vec<f64>)>,
    /// The place of a parameter's column, by its name and unit. That of the standard deviation follows.
    places: HashMap<(String, &'static str), usize>,
}

impl Columns {
    /// The number of calibrations.
    pub(super) fn rows(&self) -> usize {
        self.ids.len()
    }

    /// The columns in their order: the number of the record, texts, numbers.
    pub(super) fn into_table(self) -> Table {
        let mut columns = vec![TableColumn { name: "id".to_owned(), values: ColumnValues::Whole(self.ids) }];
        columns.extend(self.texts.into_iter().map(|(name, texts)| TableColumn::texts(name, texts)));
        columns.extend(self.numbers.into_iter().map(|(name, numbers)| TableColumn::numbers(name, numbers)));
        Table { name: "calibrations", columns }
    }

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
            column.push(text.map(Cow::Owned));
        }
        let imu = &record.imu;
        for (k, quantity) in imu.quantities.iter().enumerate() {
            let readings = imu.unit(quantity.sensor_kind()).unwrap_or(quantity.sensor_kind().stimulus_unit());
            let place = self.place(quantity.name(), quantity.unit(readings), before);
            let variance =
                imu.covariance.as_ref().map(|sigma| sigma[(k, k)]).filter(|variance| *variance > 0.0);
            self.numbers[place].1.push(quantity.value(&imu.parameters));
            self.numbers[place + 1].1.push(variance.map_or(f64::NAN, f64::sqrt));
        }
        for (_, column) in &mut self.numbers {
            column.resize(before + 1, f64::NAN);
        }
    }

    /// The place of a parameter's column, which is made where it is new, with this number of empty entries.
    fn place(&mut self, name: String, unit: &'static str, before: usize) -> usize {
        let numbers = &mut self.numbers;
        *self.places.entry((name, unit)).or_insert_with_key(|(name, unit)| {
            let ending = unit_ending(unit);
            numbers.push((format!("{name}{ending}"), vec![f64::NAN; before]));
            numbers.push((format!("{name}_sd{ending}"), vec![f64::NAN; before]));
            numbers.len() - 2
        })
    }
}
