//! `[gyroscope]` and `[known]`: the second sensor of an IMU, its turns, and known quantities.

use super::HoldsPlan;
use super::direction::Direction;
use super::noise_density::{RADPS_PER_MDPS, of_sample};
use super::number::{Either, PerAxis, Within};
use super::ranges::{
    GyroscopeGain, NoiseBandwidth, NoiseCounts, NoiseMdps, NoiseRadps, PriorSd, RangeDegps, RangeRadps, Time,
    TurnAngle, TurnSd, Value,
};
use super::refused_key::refused;
use super::remedies::remedy;
use super::sensor::per_axis;
use super::temperature::TemperatureSection;
use crate::ImuUnit;
use calibrant_core::error::Result;
use calibrant_core::estimate::{Gyroscope, ImuSetup, KnownTerm, ThermalModel, ThermometerLag, Turn};
use calibrant_core::sensor::{ImuQuantity, ReadingUnit, SensorModel, ThermalPart};
use calibrant_recording::text::similar_word::nearest;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// `[gyroscope]`: the datasheet of an IMU's gyroscope, and its turns.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GyroscopeSection {
    /// Unit of the readings, where the file does not state it.
    pub unit: Option<GyroscopeUnit>,
    /// Which errors the model has; all without it.
    pub model: Option<SensorModel>,
    /// Nominal gain.
    pub gain_counts_per_radps: Option<PerAxis<GyroscopeGain>>,
    /// Noise of one sample, rad/s.
    pub noise_radps: Option<PerAxis<NoiseRadps>>,
    /// Noise of one sample, counts.
    pub noise_counts: Option<PerAxis<NoiseCounts>>,
    /// Noise density of the datasheet, mdps/√Hz: the noise of one sample by its bandwidth.
    pub noise_mdps_per_rthz: Option<PerAxis<NoiseMdps>>,
    /// Bandwidth of that noise.
    pub noise_bandwidth_hz: Option<Within<NoiseBandwidth>>,
    /// Largest rate that the sensor can report.
    pub range_radps: Option<PerAxis<RangeRadps>>,
    /// The same in deg/s.
    pub range_degps: Option<PerAxis<RangeDegps>>,
    /// Is the g-sensitivity estimated? Not without it.
    pub g_sensitivity: Option<bool>,
    /// Turns of known angle.
    pub turns: Option<Vec<TurnSection>>,
    /// Angle of the turns of a list of sections.
    pub turn_angle_deg: Option<Within<TurnAngle>>,
    /// Standard uncertainty of that angle and of its axis.
    pub turn_sd_deg: Option<Within<TurnSd>>,
}

/// The unit of a gyroscope's readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum GyroscopeUnit {
    /// rad/s.
    Radps,
    /// deg/s.
    Degps,
    /// mdeg/s.
    Mdps,
    /// Counts.
    Counts,
}

impl From<GyroscopeUnit> for ImuUnit {
    fn from(unit: GyroscopeUnit) -> Self {
        match unit {
            GyroscopeUnit::Radps => Self::RadianPerSecond,
            GyroscopeUnit::Degps => Self::DegreePerSecond,
            GyroscopeUnit::Mdps => Self::MilliDegreePerSecond,
            GyroscopeUnit::Counts => Self::Counts,
        }
    }
}

/// A turn of known angle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TurnSection {
    /// Its start.
    pub start_s: Within<Time>,
    /// Its end.
    pub end_s: Within<Time>,
    /// Its axis.
    pub axis: Direction,
    /// Its angle, right-handed about the axis.
    pub angle_deg: Within<TurnAngle>,
    /// Standard uncertainty of the angle.
    pub angle_sd_deg: Option<Within<TurnSd>>,
    /// Standard uncertainty of the axis' direction; without it, that of the angle.
    pub axis_sd_deg: Option<Within<TurnSd>>,
}

/// `[known]`: quantities by their names; a number fixes a quantity, a table is a prior.
pub type KnownSection = BTreeMap<String, Either<Within<Value>, KnownPrior>>;

/// A prior of a quantity; fixed without a standard deviation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KnownPrior {
    /// Its value.
    pub value: Within<Value>,
    /// Its standard deviation.
    pub sd: Option<Within<PriorSd>>,
}

/// Usual standard uncertainty of the angle of a turn by hand, degrees.
const TURN_SD_DEG: f64 = 0.5;

/// The second sensor of an IMU and what both sensors share, as `[gyroscope]`, `[known]` and `[temperature]`
/// describe it.
#[derive(Debug, Clone, PartialEq)]
pub struct ImuPlan {
    /// The datasheet.
    pub gyroscope: Gyroscope,
    /// Largest rate that the gyroscope can report on each axis, rad/s.
    pub gyroscope_range_radps: Option<Vector3<f64>>,
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
    /// Priors of usual sensors.
    pub usual: Vec<KnownTerm>,
    /// The part of the model that follows temperature.
    pub thermal: ThermalModel,
    /// The lag of the thermometer.
    pub thermometer: ThermometerLag,
}

impl ImuPlan {
    /// The setup of such a recording: the holds, the turns, the known quantities and the temperature model.
    ///
    /// # Errors
    /// As [`HoldsPlan::gravity`].
    pub fn setup(&self, holds: &HoldsPlan) -> Result<ImuSetup> {
        Ok(ImuSetup {
            holds: holds.setup()?,
            latitude_deg: holds.latitude_deg.map(f64::from),
            directions: holds.directions(),
            face_sd_rad: holds.face_sd_rad(),
            turns: self.turns.clone(),
            known: self.known.clone(),
            usual: self.usual.clone(),
            thermal: self.thermal,
            thermometer: self.thermometer,
            ..ImuSetup::default()
        })
    }
}

impl GyroscopeSection {
    /// The plan of such an IMU.
    pub(super) fn plan(
        &self,
        known: Option<&KnownSection>,
        temperature: Option<&TemperatureSection>,
    ) -> Result<ImuPlan> {
        let thermal = temperature.map(TemperatureSection::model).unwrap_or_default();
        let file_unit = self.unit.map(ImuUnit::from);
        let is_counts = file_unit == Some(ImuUnit::Counts);
        let of_counts = [
            ("gyroscope.gain_counts_per_radps", self.gain_counts_per_radps.is_some()),
            ("gyroscope.noise_counts", self.noise_counts.is_some()),
        ];
        if let Some((key, _)) = of_counts.iter().find(|(_, is_there)| *is_there && !is_counts) {
            let help = "write unit = \"counts\" in [gyroscope], or leave this key away";
            return Err(refused(*key, "readings in rad/s or deg/s have no counts", help));
        }
        let density = per_axis("gyroscope.noise_mdps_per_rthz", self.noise_mdps_per_rthz.as_ref(), 3)?;
        let physical = [
            ("gyroscope.noise_radps", self.noise_radps.is_some()),
            ("gyroscope.noise_mdps_per_rthz", density.is_some()),
        ];
        if let Some((key, _)) = physical.iter().find(|(_, is_there)| is_counts && *is_there) {
            return Err(refused(*key, "the readings are counts", "noise_counts = …"));
        }
        let by_density = of_sample(
            ("gyroscope.noise_mdps_per_rthz", density),
            ("gyroscope.noise_bandwidth_hz", self.noise_bandwidth_hz.map(f64::from)),
            RADPS_PER_MDPS,
            &physical[..1],
        )?;
        let noise = match is_counts {
            true => per_axis("gyroscope.noise_counts", self.noise_counts.as_ref(), 3)?,
            false => per_axis("gyroscope.noise_radps", self.noise_radps.as_ref(), 3)?.or(by_density),
        };
        let angle = self.turn_angle_deg.map(|angle| turned_by("gyroscope.turn_angle_deg", angle));
        Ok(ImuPlan {
            gyroscope: Gyroscope {
                unit: if is_counts { ReadingUnit::Counts } else { ReadingUnit::RadianPerSecond },
                model: self.model.unwrap_or(SensorModel::Full),
                gain: per_axis("gyroscope.gain_counts_per_radps", self.gain_counts_per_radps.as_ref(), 3)?,
                noise,
                g_sensitivity: self.g_sensitivity.unwrap_or(false),
            },
            gyroscope_range_radps: self.range_radps()?,
            file_unit,
            turns: self.turns()?,
            section_angle_rad: angle.transpose()?.unwrap_or_else(|| (-360.0_f64).to_radians()),
            section_angle_sd_rad: self.turn_sd_deg.map_or(TURN_SD_DEG, f64::from).to_radians(),
            known: known.map_or(Ok(Vec::new()), |section| known_terms(section, &thermal))?,
            usual: Vec::new(),
            thermal,
            thermometer: temperature.map(TemperatureSection::thermometer).unwrap_or_default(),
        })
    }

    /// The range in rad/s, whichever unit it is given in.
    fn range_radps(&self) -> Result<Option<Vector3<f64>>> {
        let in_radps = per_axis("gyroscope.range_radps", self.range_radps.as_ref(), 3)?;
        let in_degps = per_axis("gyroscope.range_degps", self.range_degps.as_ref(), 3)?;
        if in_radps.is_some() && in_degps.is_some() {
            return Err(refused("gyroscope.range_degps", "the range is given twice", "keep one of the two"));
        }
        Ok(in_radps.or(in_degps.map(|range| range.map(f64::to_radians))))
    }

    /// The keys about turns by hand, and which are there.
    pub(super) fn turn_keys(&self) -> [(&'static str, bool); 3] {
        [
            ("gyroscope.turns", self.turns.is_some()),
            ("gyroscope.turn_angle_deg", self.turn_angle_deg.is_some()),
            ("gyroscope.turn_sd_deg", self.turn_sd_deg.is_some()),
        ]
    }

    fn turns(&self) -> Result<Vec<Turn>> {
        let mut turns: Vec<Turn> = Vec::new();
        for (number, of) in self.turns.iter().flatten().enumerate() {
            let key = format!("gyroscope.turns[{number}]");
            let turn = of.turn(&key)?;
            if let Some(before) = turns.iter().position(|before| turn.repeats(before)) {
                let [one, other] =
                    [&turns[before], &turn].map(|turn| format!("{} to {} s", turn.start_s, turn.end_s));
                let message =
                    format!("turn {} ({other}) is turn {} ({one}) once more", number + 1, before + 1);
                return Err(refused(key, message, "give each turn once: it would count twice"));
            }
            turns.push(turn);
        }
        Ok(turns)
    }
}

impl TurnSection {
    fn turn(&self, key: &str) -> Result<Turn> {
        let (start_s, end_s) = (self.start_s.get(), self.end_s.get());
        if end_s <= start_s {
            let message = format!("the turn ends at {end_s} s, not after its start at {start_s} s");
            return Err(refused(key, message, remedy(key)));
        }
        Ok(Turn {
            name: None,
            start_s,
            end_s,
            angle_rad: turned_by(&format!("{key}.angle_deg"), self.angle_deg)?,
            axis: self.axis.unit(),
            angle_sd_rad: self.angle_sd_deg.map_or(TURN_SD_DEG, f64::from).to_radians(),
            axis_sd_rad: self.axis_sd_deg.map(|sd| sd.get().to_radians()),
        })
    }
}

/// The angle of a turn, rad.
fn turned_by(key: &str, angle: Within<TurnAngle>) -> Result<f64> {
    match angle.get().to_radians() {
        0.0 => Err(refused(key, "a turn by nothing", "its angle in degrees, right-handed about its axis")),
        angle_rad => Ok(angle_rad),
    }
}

fn known_terms(section: &KnownSection, thermal: &ThermalModel) -> Result<Vec<KnownTerm>> {
    let mut all = ImuQuantity::full_list(true, true, true);
    all.extend(ImuQuantity::all_thermal(true, true));
    section
        .iter()
        .map(|(name, value)| {
            let key = format!("known.{name}");
            let Some(&quantity) = all.iter().find(|quantity| quantity.name() == *name) else {
                let names: Vec<String> = all.iter().map(|quantity| quantity.name()).collect();
                let near = nearest(name, names.iter().map(String::as_str));
                let help = near.map_or_else(
                    || "names are gyroscope.bias.x, accelerometer.scale.y, gyroscope.matrix.xy, …".into(),
                    |near| format!("did you mean \"{near}\"?"),
                );
                return Err(refused(key, format!("no quantity is named \"{name}\""), help));
            };
            if let ImuQuantity::Thermal(of, term) = quantity
                && !thermal.quantities().contains(&quantity)
            {
                let message = format!("\"{name}\" is known, and no such term is asked for");
                let part = if term.part == ThermalPart::Bias { "bias" } else { "scale" };
                let help = format!("raise its order in [temperature]: {of}_{part} = {}", term.order);
                return Err(refused(key, message, help));
            }
            let (value, sd) = match value {
                Either::Single(value) => (value.get(), None),
                Either::Compound(prior) => (prior.value.get(), prior.sd.map(f64::from)),
            };
            Ok(KnownTerm { quantity, value, sd })
        })
        .collect()
}
