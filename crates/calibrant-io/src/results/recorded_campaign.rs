//! Reads the soaks of an earlier `calibration.json` over temperature: what they tell, for a design of what to add.

use super::campaign_calibration::CampaignCalibrationFile;
use super::heading::JsonFile;
use calibrant_campaign::Campaign;
use calibrant_core::error::{Error, InputError, Refusal, Result};
use nalgebra::DMatrix;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// The least scatter that is planned with, over the stated one.
const LEAST: f64 = 0.5;

#[derive(Deserialize)]
struct Recorded {
    kind: Option<String>,
    #[serde(default)]
    channels: Vec<RecordedChannel>,
    #[serde(default)]
    soaks: Vec<RecordedSoak>,
}

#[derive(Deserialize)]
struct RecordedChannel {
    name: String,
    soak_sd: f64,
    lag_scatter: f64,
}

#[derive(Deserialize)]
struct RecordedSoak {
    temperature_c: f64,
    direction: f64,
    lag_left: f64,
    sds: BTreeMap<String, Vec<f64>>,
}

/// A campaign with what the soaks of this `calibration.json` tell, and with the scatter between soaks that they show.
///
/// # Errors
/// As [`with_soaks_of`], with the file.
pub fn with_recorded_soaks(campaign: &Campaign, path: &Path) -> Result<Campaign> {
    let text = std::fs::read_to_string(path).map_err(|error| refused(error.to_string()));
    let found = text.and_then(|text| with_soaks_of(campaign, &text));
    found.map_err(|error| match error {
        Error::Experiment(input_error) => Error::experiment(input_error.in_file(path)),
        other => other,
    })
}

fn refused(message: String) -> Error {
    let help = "give the calibration.json that `calibrate` wrote from several soaks";
    Error::experiment(InputError::new(Refusal::CalibrationInvalid, message, help))
}

/// The same, of the text of a `calibration.json`.
///
/// # Errors
/// [`Error::Experiment`] where it is no calibration over temperature.
pub fn with_soaks_of(campaign: &Campaign, text: &str) -> Result<Campaign> {
    let recorded: Recorded = serde_json::from_str(text).map_err(|error| refused(error.to_string()))?;
    if recorded.kind.as_deref() != Some(CampaignCalibrationFile::KIND) || recorded.soaks.is_empty() {
        return Err(refused("this is no calibration over temperature from several soaks".to_owned()));
    }
    let mut campaign = campaign.clone();
    for channel in &mut campaign.channels {
        if let Some(found) = recorded.channels.iter().find(|found| found.name == channel.name) {
            // none that is seen in few soaks is not none
            channel.soak_sd = found.soak_sd.max(LEAST * channel.soak_sd);
            channel.lag_scatter = found.lag_scatter;
        }
    }
    let known = campaign.recorded.clone();
    let information = |(k, channel): (usize, &calibrant_campaign::Channel)| {
        let size = channel.coefficients();
        let mut information = known.get(k).cloned().unwrap_or_else(|| DMatrix::zeros(size, size));
        for soak in &recorded.soaks {
            let Some(sds) = soak.sds.get(&channel.name).filter(|sds| !sds.is_empty()) else { continue };
            let own = sds.iter().map(|sd| sd * sd).sum::<f64>() / sds.len() as f64;
            let row = channel.row(campaign.x(soak.temperature_c), soak.direction, soak.lag_left);
            let beside = channel.variance(1, soak.lag_left) - channel.block_sd.powi(2);
            information.ger((own + beside).recip(), &row, &row, 1.0);
        }
        information
    };
    let recorded = campaign.channels.iter().enumerate().map(information).collect();
    Ok(Campaign { recorded, ..campaign })
}
