//! Reads the calibration of a soak: what a campaign over temperature is fitted to.

use super::calibrant_json::Header;
use super::words::invalid;
use crate::results::input::Input;
use calibrant_campaign::fit::SoakCalibration;
use calibrant_core::diagnostic::Check;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::convention::VerdictBad;
use calibrant_core::estimate::SoakTemperature;
use calibrant_recording::files::utc_time::UtcTime;
use calibrant_recording::text::decoding::Checked;
use serde::Deserialize;

/// A soak as its `calibration.json` has it.
#[derive(Debug, Clone)]
pub struct ReadSoak {
    /// Its calibration.
    pub calibration: SoakCalibration,
    /// The files of its recording.
    pub inputs: Vec<Input>,
    /// When it was recorded.
    pub recorded: Option<UtcTime>,
    /// The sensor, as the file names it.
    pub sensor: Option<String>,
    /// The verdict, where it is bad.
    pub bad: Option<Diagnostic>,
}

#[derive(Deserialize)]
struct SoakFields {
    soak: Option<SoakCore>,
    recorded: Option<String>,
    sensor: Option<String>,
}

#[derive(Deserialize)]
struct SoakCore {
    mean_c: f64,
    rate_k_per_min: f64,
    range_c: [f64; 2],
}

/// The soak of the text of a `calibration.json`; `name` says which it is.
///
/// # Errors
/// The text is no calibration of calibrant that converged, or its recording had no temperature.
pub fn parse_soak(text: &str, name: &str) -> Checked<ReadSoak> {
    let header = Header::of(text)?;
    if header.is_of_several_soaks() {
        let message = "this is the calibration of several soaks already";
        return Err(invalid(message, "give the calibration.json of each soak, or its recording"));
    }
    let (imu, inputs) = header.core(text)?.into_imu()?;
    let fields: SoakFields =
        serde_json::from_str(text).map_err(|error| super::calibrant_json::broken(&error))?;
    let SoakCore { mean_c, rate_k_per_min, range_c } = fields.soak.ok_or_else(|| {
        invalid(
            "this calibration has no `soak`: its recording had no temperature",
            "name the column with temperature = \"\u{2026}\" in [columns], and calibrate the recording again",
        )
    })?;
    let temperature = SoakTemperature { mean_c, rate_k_per_min, range_c };
    let bad = header.findings().into_iter().find(|found| found.code() == VerdictBad::CODE);
    let calibration = SoakCalibration { name: name.to_owned(), imu, temperature };
    let recorded = fields.recorded.as_deref().and_then(UtcTime::parse);
    Ok(ReadSoak { calibration, inputs, recorded, sensor: fields.sensor, bad })
}
