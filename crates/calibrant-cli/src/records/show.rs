//! `calibrant records show`: one calibration with its parameters.

use crate::console;
use crate::exit::Exit;
use calibrant::Error;
use calibrant::error::{InputError, Refusal};
use calibrant::io::to_json;
use calibrant::records::{KeptRecord, RecordFile, Records};
use calibrant::report::number_format;
use std::path::PathBuf;

/// Show one calibration: where it comes from, its verdict and its parameters.
///
/// With --json, it is a calibration that `convert`, `compare` and `apply` read.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The records.
    records: PathBuf,
    /// The number of the calibration, as `list` shows it.
    id: i64,
    /// Print JSON instead of the table: parameters and covariance, as in calibration.json.
    #[arg(long)]
    json: bool,
}

impl Arguments {
    pub(super) fn run(&self) -> calibrant::Result<Exit> {
        let Some(kept) = Records::open_existing(&self.records)?.get(self.id)? else {
            let message = format!("there is no calibration {}", self.id);
            let help = "`calibrant records list` shows the numbers";
            let error = InputError::new(Refusal::ValueInvalid, message, help).in_file(&self.records);
            return Err(Error::experiment(error));
        };
        console::json_or(self.json, || to_json(&RecordFile(&kept)), || in_words(&kept));
        Ok(Exit::DONE)
    }
}

fn in_words(kept: &KeptRecord) -> String {
    let record = &kept.record;
    let mut text = format!("calibration {} of sensor {}: {}", kept.id, record.sensor, record.verdict.name());
    if !record.codes.is_empty() {
        text.push_str(&format!(" ({})", record.codes.join(", ")));
    }
    text.push('\n');
    let file = |what: &str, name: &str, sha256: &str| Some(format!("{what}: {name}, SHA-256 {sha256}"));
    let mut facts = vec![
        record.recorded.map(|time| format!("recorded: {time}")),
        record.station.as_ref().map(|station| format!("station: {station}")),
        Some(format!(
            "by: {}, {}, {}; inserted {}",
            record.program, record.plan, record.status, kept.inserted
        )),
        record.experiment.as_ref().and_then(|of| file("experiment", &of.file, &of.sha256)),
        record.motion_file.as_ref().and_then(|of| file("motion", &of.file, &of.sha256)),
    ];
    facts.extend(record.recordings.iter().map(|of| file("recording", &of.file, &of.sha256)));
    facts.iter().flatten().for_each(|fact| text.push_str(&format!("  {fact}\n")));
    text.push('\n');
    let imu = &record.imu;
    let rows = imu.quantities.iter().enumerate().map(|(k, quantity)| {
        let variance = imu.covariance.as_ref().map_or(0.0, |sigma| sigma[(k, k)]);
        let readings = imu.unit(quantity.sensor_kind()).unwrap_or(quantity.sensor_kind().stimulus_unit());
        let value =
            number_format::with_sd_or_exact(quantity.value(&imu.parameters), variance.max(0.0).sqrt());
        vec![quantity.name(), value, quantity.unit(readings).to_owned()]
    });
    text + &console::table(&["parameter", "value", "unit"], &rows.collect::<Vec<_>>())
}
