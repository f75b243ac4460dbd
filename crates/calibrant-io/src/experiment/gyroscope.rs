//! Reads `[gyroscope]` and `[known]`: the second sensor of an IMU, its turns, and known quantities.

use super::HoldsPlan;
use super::direction::direction;
use super::number_range::Bounds;
use super::toml_document::{Entry, Section};
use crate::ImuUnit;
use calibrant_core::error::Result;
use calibrant_core::estimate::{Gyroscope, ImuSetup, KnownTerm, ThermalModel, Turn};
use calibrant_core::sensor::{ImuQuantity, ReadingUnit, SensorModel};
use nalgebra::Vector3;

/// Range of the nominal gain.
const GAIN: Bounds = Bounds::above(0.0, 1e12, "counts/(rad/s)");
/// Range of the noise of a sample in rad/s.
const NOISE_RADPS: Bounds = Bounds::from(1e-9, 1e3, "rad/s");
/// Range of the noise of a sample in counts.
const NOISE_COUNTS: Bounds = Bounds::from(1e-9, 1e9, "counts");
/// Range of a time.
const TIME: Bounds = Bounds::from(-1e12, 1e12, "s");
/// Range of the angle of a turn.
const ANGLE: Bounds = Bounds::from(-1e6, 1e6, "degrees");
/// Range of the standard uncertainty of a turn's angle. It is above 0: no turn is exact, and nothing in the
/// recording shows its error.
const ANGLE_SD: Bounds = Bounds::above(0.0, 360.0, "degrees");
/// Range of a known value.
const NUMBER: Bounds = Bounds::from(-1e12, 1e12, "");
/// Range of the standard deviation of a prior. A smaller one leaves the other data no digits.
const PRIOR_SD: Bounds = Bounds::from(1e-12, 1e12, "");
/// The second sensor of an IMU and what both sensors share, as `[gyroscope]`, `[known]` and `[temperature]`
/// describe it.
#[derive(Debug, Clone, PartialEq)]
pub struct ImuPlan {
    /// The datasheet.
    pub gyroscope: Gyroscope,
    /// Unit of the readings in the file, where the file does not state it.
    pub file_unit: Option<ImuUnit>,
    /// Turns of known angle.
    pub turns: Vec<Turn>,
    /// Angle of the turns of a list of sections, rad.
    pub section_angle_rad: f64,
    /// Standard uncertainty of that angle and of its axis, rad.
    pub section_angle_sd_rad: f64,
    /// Known quantities: fixed values and priors.
    pub known: Vec<KnownTerm>,
    /// The part of the model that follows temperature.
    pub thermal: ThermalModel,
}

impl ImuPlan {
    /// The setup of such a recording: the holds, the turns, the known quantities and the temperature model.
    #[must_use]
    pub fn setup(&self, holds: &HoldsPlan) -> ImuSetup {
        ImuSetup {
            holds: holds.setup(),
            latitude_deg: holds.latitude_deg,
            directions: holds.directions.clone(),
            face_sd_rad: holds.face_sd_rad,
            turns: self.turns.clone(),
            known: self.known.clone(),
            thermal: self.thermal,
            ..ImuSetup::default()
        }
    }
}

/// Reads `[gyroscope]`, `[known]` and `[temperature]`.
pub(super) fn read(
    section: &Section<'_>,
    known: Option<&Section<'_>>,
    temperature: Option<&Section<'_>>,
) -> Result<ImuPlan> {
    let thermal = temperature.map_or(Ok(ThermalModel::default()), super::temperature::read)?;
    let file_unit = match section.get("unit") {
        None => None,
        Some(entry) => Some(entry.word(&[
            ("radps", ImuUnit::RadianPerSecond),
            ("degps", ImuUnit::DegreePerSecond),
            ("mdps", ImuUnit::MilliDegreePerSecond),
            ("counts", ImuUnit::Counts),
        ])?),
    };
    let unit =
        if file_unit == Some(ImuUnit::Counts) { ReadingUnit::Counts } else { ReadingUnit::RadianPerSecond };
    let model = section.get("model").map_or(Ok(SensorModel::Full), |entry| {
        entry.word(&[("scale-bias", SensorModel::ScaleBias), ("full", SensorModel::Full)])
    })?;
    let counts = ["gain_counts_per_radps", "noise_counts"];
    if unit != ReadingUnit::Counts
        && let Some(entry) = counts.iter().find_map(|key| section.get(key))
    {
        return Err(entry.reject(
            "readings in rad/s or deg/s have no counts",
            "write unit = \"counts\" in [gyroscope], or leave this key away",
        ));
    }
    if let (ReadingUnit::Counts, Some(entry)) = (unit, section.get("noise_radps")) {
        return Err(entry.reject("the readings are counts", "noise_counts = …"));
    }
    let per_axis = |key: &str, bounds: &Bounds| -> Result<Option<Vector3<f64>>> {
        section.get(key).map(|entry| entry.per_axis(3, bounds)).transpose()
    };
    let noise = match unit {
        ReadingUnit::Counts => per_axis("noise_counts", &NOISE_COUNTS)?,
        _ => per_axis("noise_radps", &NOISE_RADPS)?,
    };
    Ok(ImuPlan {
        gyroscope: Gyroscope {
            unit,
            model,
            gain: per_axis("gain_counts_per_radps", &GAIN)?,
            noise,
            g_sensitivity: section.get("g_sensitivity").map_or(Ok(false), |entry| entry.flag())?,
        },
        file_unit,
        turns: section.get("turns").map_or(Ok(Vec::new()), |entry| turns(&entry))?,
        section_angle_rad: section
            .get("turn_angle_deg")
            .map_or(Ok((-360.0_f64).to_radians()), |entry| turned_by(&entry))?,
        section_angle_sd_rad: section
            .get("turn_sd_deg")
            .map_or(Ok(0.5), |entry| entry.number(&ANGLE_SD))?
            .to_radians(),
        known: known.map_or(Ok(Vec::new()), |section| read_known(section, &thermal))?,
        thermal,
    })
}

/// Reads `[gyroscope]` of an IMU on a machine, which has no turns by hand.
pub(super) fn read_without_turns(section: &Section<'_>) -> Result<ImuPlan> {
    match ["turns", "turn_angle_deg", "turn_sd_deg"].iter().find_map(|key| section.get(key)) {
        Some(entry) => Err(entry.reject("turns are not read with [machine]", "take this key out")),
        None => read(section, None, None),
    }
}

/// The angle of a turn, rad.
fn turned_by(entry: &Entry<'_>) -> Result<f64> {
    match entry.number(&ANGLE)?.to_radians() {
        0.0 => Err(entry.reject("a turn by nothing", "its angle in degrees, right-handed about its axis")),
        angle_rad => Ok(angle_rad),
    }
}

fn turns(entry: &Entry<'_>) -> Result<Vec<Turn>> {
    /// The remedy for a wrong turn.
    const HELP: &str = "turns = [{ start_s = 10.0, end_s = 14.0, axis = \"x\", angle_deg = 360.0 }]";
    let mut turns: Vec<Turn> = Vec::new();
    for item in &entry.items(HELP)? {
        let turn = Section::item(item, "gyroscope.turns")?;
        let number = |key: &str, bounds: &Bounds| turn.need(key, HELP)?.number(bounds);
        let (start_s, end_s) = (number("start_s", &TIME)?, number("end_s", &TIME)?);
        if end_s <= start_s {
            let message = format!("the turn ends at {end_s} s, not after its start at {start_s} s");
            return Err(item.reject(message, HELP));
        }
        let angle = turn.need("angle_deg", HELP)?;
        let angle_rad = turned_by(&angle)?;
        let sd = turn.get("angle_sd_deg").map_or(Ok(0.5), |entry| entry.number(&ANGLE_SD))?;
        let axis = direction(&turn.need("axis", HELP)?)?;
        let turn = Turn { name: None, start_s, end_s, axis, angle_rad, angle_sd_rad: sd.to_radians() };
        if let Some(before) = turns.iter().position(|before| turn.repeats(before)) {
            let [one, other] =
                [&turns[before], &turn].map(|turn| format!("{} to {} s", turn.start_s, turn.end_s));
            let message =
                format!("turn {} ({other}) is turn {} ({one}) once more", turns.len() + 1, before + 1);
            return Err(item.reject(message, "give each turn once: it would count twice"));
        }
        turns.push(turn);
    }
    Ok(turns)
}

fn read_known(section: &Section<'_>, thermal: &ThermalModel) -> Result<Vec<KnownTerm>> {
    let mut all = ImuQuantity::full_list(true, true, true);
    all.extend(ImuQuantity::all_thermal(true, true));
    section
        .entries()
        .map(|(name, entry)| {
            /// The remedy for a wrong known value.
            const HELP: &str = "a number fixes it; { value = 0.0, sd = 0.01 } is a prior";
            let Some(&quantity) = all.iter().find(|quantity| quantity.name() == name) else {
                let names: Vec<String> = all.iter().map(|quantity| quantity.name()).collect();
                let near = super::known_keys::nearest(name, names.iter().map(String::as_str));
                let help = near.map_or_else(
                    || "names are gyroscope.bias.x, accelerometer.scale.y, gyroscope.matrix.xy, …".into(),
                    |near| format!("did you mean \"{near}\"?"),
                );
                return Err(entry.reject(format!("no quantity is named \"{name}\""), help));
            };
            if matches!(quantity, ImuQuantity::Thermal(..)) && !thermal.quantities().contains(&quantity) {
                return Err(entry.reject(
                    format!("\"{name}\" is known, and no such term is asked for"),
                    "raise its order in [temperature]: gyroscope_bias = 1, for example",
                ));
            }
            if !entry.is_table() {
                return Ok(KnownTerm { quantity, value: entry.number(&NUMBER)?, sd: None });
            }
            let term = Section::item(&entry, "known.term")?;
            let value = term.need("value", HELP)?.number(&NUMBER)?;
            let sd = term.get("sd").map(|entry| entry.number(&PRIOR_SD)).transpose()?;
            Ok(KnownTerm { quantity, value, sd })
        })
        .collect()
}
