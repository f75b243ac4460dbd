//! `[campaign]`: a campaign over temperature, in a chamber or a freezer.

use super::Plan;
use super::campaign_block::CampaignPoses;
use super::campaign_cycles::Cycles;
use super::number::Within;
use super::ranges::{
    BlockSd, Celsius, Duration, HoldSd, LagScatter, Minutes, PriorSd, Ramp, Spacing, TimeConstant, Wait,
};
use super::refused_key::{missing, refused};
use super::temperature::TemperatureSection;
use calibrant_core::error::Result;
use calibrant_core::sensor::{HIGHEST_ORDER, SensorKind};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// In which directions temperatures are reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CampaignDirections {
    /// From below and from above.
    Both,
    /// From below: a heater alone.
    Up,
}

/// What a campaign minimises.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum CampaignLetter {
    /// The mean variance over the range, over the goals squared.
    I,
    /// `−ln det` of the information.
    D,
    /// The variance at one temperature; written `c`.
    #[serde(rename = "c")]
    C,
}

/// One number for each quantity that follows temperature.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GoalsSection {
    /// Of the accelerometer's bias, m/s².
    #[serde(rename = "accelerometer.bias")]
    pub accelerometer_bias: Option<Within<PriorSd>>,
    /// Of its gains, relative.
    #[serde(rename = "accelerometer.scale")]
    pub accelerometer_scale: Option<Within<PriorSd>>,
    /// Of the gyroscope's bias, rad/s.
    #[serde(rename = "gyroscope.bias")]
    pub gyroscope_bias: Option<Within<PriorSd>>,
    /// Of its gains, relative.
    #[serde(rename = "gyroscope.scale")]
    pub gyroscope_scale: Option<Within<PriorSd>>,
}

/// What is known beforehand of a quantity that follows temperature; what is not there is that of consumer MEMS sensors.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChannelSection {
    /// Standard deviations over sensors of the type of the coefficients from order 1 on.
    pub spread: Option<Vec<Within<PriorSd>>>,
    /// Those of the coefficients above the order that is reported.
    pub beyond_sd: Option<Vec<Within<PriorSd>>>,
    /// Standard deviation from one block of holds.
    pub block_sd: Option<Within<BlockSd>>,
    /// Standard deviation of what does not average within a soak.
    pub soak_sd: Option<Within<HoldSd>>,
    /// Standard deviations of half the difference of the branches.
    pub hysteresis_sd: Option<Vec<Within<PriorSd>>>,
    /// Standard deviations of the error at the end of a ramp.
    pub lag_sd: Option<Vec<Within<PriorSd>>>,
    /// Share of that error that differs from soak to soak.
    pub lag_scatter: Option<Within<LagScatter>>,
}

/// `[campaign]`: chamber, time, and what is known of the sensor beforehand.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CampaignSection {
    /// The temperatures of use.
    pub range_c: Vec<Within<Celsius>>,
    /// Time of the whole campaign.
    pub budget_min: Within<Minutes>,
    /// Rate of the chamber.
    pub ramp_k_per_min: Within<Ramp>,
    /// Time constant between chamber and sense element; 10 min without it.
    pub time_constant_min: Option<Within<TimeConstant>>,
    /// Duration of a hold; 10 s without it.
    pub hold_s: Option<Within<Duration>>,
    /// Duration of the move to the next hold; 5 s without it.
    pub move_s: Option<Within<Duration>>,
    /// The poses of a block of holds, of a cube or of a file; six faces without it.
    pub poses: Option<CampaignPoses>,
    /// Soaks of one pass are at least this far apart; 5 K without it.
    pub spacing_c: Option<Within<Spacing>>,
    /// Closed cycles over the range; 1 without it.
    pub cycles: Option<Cycles>,
    /// Directions in which temperatures are reached; both without it.
    pub directions: Option<CampaignDirections>,
    /// The shortest wait; 0 without it.
    pub shortest_wait_min: Option<Within<Wait>>,
    /// What is minimised; I without it.
    pub criterion: Option<CampaignLetter>,
    /// The temperature of criterion c.
    pub at_c: Option<Within<Celsius>>,
    /// The wanted standard deviations, on average over the range.
    pub goals: Option<GoalsSection>,
    /// The accelerometer's bias, m/s².
    #[serde(rename = "accelerometer.bias")]
    pub accelerometer_bias: Option<ChannelSection>,
    /// Its gains, relative.
    #[serde(rename = "accelerometer.scale")]
    pub accelerometer_scale: Option<ChannelSection>,
    /// The gyroscope's bias, rad/s.
    #[serde(rename = "gyroscope.bias")]
    pub gyroscope_bias: Option<ChannelSection>,
    /// Its gains, relative.
    #[serde(rename = "gyroscope.scale")]
    pub gyroscope_scale: Option<ChannelSection>,
    /// What `[temperature]` states.
    #[serde(skip)]
    pub(super) temperature: TemperatureSection,
}

/// What consumer MEMS sensors do: spread of the coefficients over 32 published calibrations of autopilots' IMUs.
pub(super) struct Usual {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) sensor_kind: SensorKind,
    pub(super) spread: &'static [f64],
    pub(super) beyond_sd: &'static [f64],
    pub(super) hysteresis_sd: &'static [f64],
    pub(super) lag_sd: &'static [f64],
    pub(super) soak_sd: f64,
    /// Of a block of six faces of 10 s.
    pub(super) block_sd: f64,
    pub(super) goal_sd: f64,
}

pub(super) const USUAL: [Usual; 4] = [
    Usual {
        name: "accelerometer.bias",
        unit: "m/s²",
        sensor_kind: SensorKind::Accelerometer,
        spread: &[0.07, 0.03, 0.02],
        beyond_sd: &[0.008, 0.004],
        hysteresis_sd: &[4e-3, 2e-3],
        lag_sd: &[1.5e-2, 5e-3],
        soak_sd: 1.5e-3,
        block_sd: 7e-4,
        goal_sd: 2e-3,
    },
    Usual {
        name: "accelerometer.scale",
        unit: "1",
        sensor_kind: SensorKind::Accelerometer,
        spread: &[8e-3, 1e-3],
        beyond_sd: &[5e-4],
        hysteresis_sd: &[2e-4],
        lag_sd: &[5e-4],
        soak_sd: 1e-4,
        block_sd: 7e-5,
        goal_sd: 2e-4,
    },
    Usual {
        name: "gyroscope.bias",
        unit: "rad/s",
        sensor_kind: SensorKind::Gyroscope,
        spread: &[6e-3, 2e-3, 1.5e-3],
        beyond_sd: &[6e-4, 3e-4],
        hysteresis_sd: &[3e-4, 1e-4],
        lag_sd: &[1e-3, 3e-4],
        soak_sd: 1e-4,
        block_sd: 3e-5,
        goal_sd: 2e-4,
    },
    Usual {
        name: "gyroscope.scale",
        unit: "1",
        sensor_kind: SensorKind::Gyroscope,
        spread: &[8e-3, 1e-3],
        beyond_sd: &[5e-4],
        hysteresis_sd: &[],
        lag_sd: &[5e-4],
        soak_sd: 2e-4,
        block_sd: 2e-4,
        goal_sd: 5e-4,
    },
];

/// Most terms of hysteresis or lag.
const MOST_TERMS: usize = 2;

impl CampaignSection {
    /// The same with what `[temperature]` states.
    pub(super) fn with_temperature(self, temperature: Option<&TemperatureSection>) -> Self {
        Self { temperature: temperature.cloned().unwrap_or_default(), ..self }
    }

    /// The same with its poses in the directory of the file.
    pub(super) fn beside(self, directory: Option<&Path>) -> Self {
        Self { poses: self.poses.map(|poses| poses.beside(directory)), ..self }
    }

    /// The file of its poses.
    #[must_use]
    pub fn poses_file(&self) -> Option<&Path> {
        match &self.poses {
            Some(CampaignPoses::File(path)) => Some(path),
            _ => None,
        }
    }

    /// Checks what no type says.
    pub(super) fn check(&self, plan: &Plan) -> Result<()> {
        if !matches!(plan, Plan::Holds(_)) {
            let help = "a campaign calibrates at each temperature from holds: see `calibrant init campaign`";
            return Err(refused("campaign", "a campaign needs [holds]", help));
        }
        let [low, high] = self.range_c()?;
        let spacing_c = self.spacing_c();
        if spacing_c > high - low {
            let message = format!("spacing_c is {spacing_c} K, and the range {} K", high - low);
            return Err(refused("campaign.spacing_c", message, "give a smaller spacing"));
        }
        match (self.criterion, self.at_c) {
            (Some(CampaignLetter::C), None) => {
                return Err(missing("campaign.at_c", "the temperature of criterion c, °C: at_c = 25.0"));
            }
            (Some(CampaignLetter::I | CampaignLetter::D), Some(_)) => {
                let help = "leave the one or the other away";
                return Err(refused("campaign.at_c", "at_c is of criterion c, and another is given", help));
            }
            (_, Some(at_c)) if !(low..=high).contains(&at_c.get()) => {
                return Err(refused(
                    "campaign.at_c",
                    "at_c is outside range_c",
                    "give a temperature within range_c",
                ));
            }
            _ => {}
        }
        for (of, section) in self.channels() {
            let Some(section) = section else { continue };
            let key = |part: &str| format!("campaign.{}.{part}", of.name);
            let count = |of: &Option<Vec<_>>, usual: &[f64]| of.as_ref().map_or(usual.len(), Vec::len);
            let orders = count(&section.spread, of.spread) + count(&section.beyond_sd, of.beyond_sd);
            if !(1..=HIGHEST_ORDER).contains(&orders) {
                let message =
                    format!("spread and beyond_sd have {orders} numbers together, one for each order");
                return Err(refused(key("spread"), message, "give 1 to 5 in all: orders 1 to 5"));
            }
            for (part, list) in [("hysteresis_sd", &section.hysteresis_sd), ("lag_sd", &section.lag_sd)] {
                if list.as_ref().is_some_and(|list| list.len() > MOST_TERMS) {
                    return Err(refused(key(part), "there are more than two numbers", "give up to two"));
                }
            }
        }
        Ok(())
    }

    pub(super) fn range_c(&self) -> Result<[f64; 2]> {
        match self.range_c.as_slice() {
            [low, high] if low.get() < high.get() => Ok([low.get(), high.get()]),
            _ => Err(refused(
                "campaign.range_c",
                "the range is not two temperatures, the lower first",
                "range_c = [-20.0, 60.0]",
            )),
        }
    }

    pub(super) fn spacing_c(&self) -> f64 {
        self.spacing_c.map_or(5.0, f64::from)
    }

    pub(super) fn channels(&self) -> [(&'static Usual, Option<&ChannelSection>); 4] {
        let [ab, ak, gb, gk] = &USUAL;
        [
            (ab, self.accelerometer_bias.as_ref()),
            (ak, self.accelerometer_scale.as_ref()),
            (gb, self.gyroscope_bias.as_ref()),
            (gk, self.gyroscope_scale.as_ref()),
        ]
    }

    pub(super) fn goal(&self, of: &Usual) -> f64 {
        let goals = self.goals.clone().unwrap_or_default();
        let given = match of.name {
            "accelerometer.bias" => goals.accelerometer_bias,
            "accelerometer.scale" => goals.accelerometer_scale,
            "gyroscope.bias" => goals.gyroscope_bias,
            _ => goals.gyroscope_scale,
        };
        given.map_or(of.goal_sd, f64::from)
    }
}
