//! Reads the calibration of a soak: what a campaign over temperature is fitted to.

use super::calibrant_json::Header;
use super::words::invalid;
use crate::results::input::Input;
use calibrant_campaign::fit::SoakCalibration;
use calibrant_core::diagnostic::Check;
use calibrant_core::diagnostic::Diagnostic;
use calibrant_core::diagnostic::convention::VerdictBad;
use calibrant_core::estimate::{HoldScatter, KnownTerm, SoakTemperature};
use calibrant_recording::files::utc_time::UtcTime;
use calibrant_recording::text::decoding::Checked;
use nalgebra::Vector3;
use serde::Deserialize;

/// A soak as its `calibration.json` has it.
#[derive(Debug, Clone)]
pub struct ReadSoak {
    /// Its calibration.
    pub calibration: SoakCalibration,
    /// How its holds scatter.
    pub scatter: HoldScatter,
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
    #[serde(default)]
    soak_prior: Vec<PriorCore>,
    recorded: Option<String>,
    sensor: Option<String>,
    holds: Option<HoldsCore>,
    still_gyroscope: Option<StillCore>,
    rotations: Option<RotationsCore>,
}

#[derive(Deserialize)]
struct HoldsCore {
    between_holds_sd_mps2: f64,
    degrees_of_freedom: f64,
}

#[derive(Deserialize)]
struct StillCore {
    #[serde(alias = "between_holds_sd_radps", alias = "between_holds_sd_counts")]
    between_holds_sd: Option<[f64; 3]>,
}

#[derive(Deserialize)]
struct RotationsCore {
    excess_sd_rad: f64,
}

#[derive(Deserialize)]
struct PriorCore {
    name: String,
    value: f64,
    sd: Option<f64>,
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
            "this calibration has no `soak`: its recording had no temperature, or one that jumps by more than 5 K between two samples",
            "name the column with temperature = \"\u{2026}\" in [columns], take out what is no temperature, and calibrate the recording again",
        )
    })?;
    let temperature = SoakTemperature { mean_c, rate_k_per_min, range_c };
    let bad = header.findings().into_iter().find(|found| found.code() == VerdictBad::CODE);
    let scatter = HoldScatter {
        between_holds_sd_mps2: fields.holds.as_ref().map_or(0.0, |holds| holds.between_holds_sd_mps2),
        gyroscope_between_holds_sd: fields
            .still_gyroscope
            .and_then(|still| still.between_holds_sd)
            .map_or_else(Vector3::zeros, Vector3::from),
        between_rotations_sd_rad: fields.rotations.map_or(0.0, |rotations| rotations.excess_sd_rad),
        degrees: fields.holds.map_or(0.0, |holds| holds.degrees_of_freedom),
    };
    let known = |PriorCore { name, value, sd }: PriorCore| {
        let quantity = imu.quantities.iter().copied().find(|quantity| quantity.name() == name);
        let quantity = quantity.ok_or_else(|| {
            invalid(format!("`soak_prior` has {name}, which is no parameter"), "give what `calibrate` wrote")
        })?;
        Ok(KnownTerm { quantity, value, sd })
    };
    let prior = fields.soak_prior.into_iter().map(known).collect::<Checked<Vec<_>>>()?;
    let calibration = SoakCalibration { name: name.to_owned(), imu, temperature, prior };
    let recorded = fields.recorded.as_deref().and_then(UtcTime::parse);
    Ok(ReadSoak { calibration, scatter, inputs, recorded, sensor: fields.sensor, bad })
}
