//! `calibrant records list`: the calibrations, a line for each.

use super::selection::Selection;
use crate::console;
use crate::exit::Exit;
use calibrant::io::to_json;
use calibrant::records::{KeptRecord, Records};
use std::path::PathBuf;

/// List calibrations: by sensor, and by date.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The records.
    records: PathBuf,
    #[command(flatten)]
    selection: Selection,
    /// Print JSON instead of the table.
    #[arg(long)]
    json: bool,
}

impl Arguments {
    pub(super) fn run(&self) -> calibrant::Result<Exit> {
        let records = Records::open_existing(&self.records)?.list(&self.selection.filter())?;
        let header = [
            "id",
            "sensor",
            "recorded",
            "station",
            "verdict",
            "decided by",
            "recording",
            "experiment",
            "program",
        ];
        let table = || console::table(&header, &records.iter().map(row).collect::<Vec<_>>());
        console::json_or(self.json, || to_json(&records), table);
        Ok(Exit::DONE)
    }
}

fn row(kept: &KeptRecord) -> Vec<String> {
    let record = &kept.record;
    let or_dash = |text: Option<String>| text.unwrap_or_else(|| "–".to_owned());
    vec![
        kept.id.to_string(),
        record.sensor.clone(),
        or_dash(record.recorded.map(|time| time.to_string())),
        or_dash(record.station.clone()),
        record.verdict.name().to_owned(),
        or_dash(Some(record.codes.join(" ")).filter(|codes| !codes.is_empty())),
        record.recording(),
        or_dash(record.experiment.as_ref().map(|file| file.file.clone())),
        record.program.clone(),
    ]
}
